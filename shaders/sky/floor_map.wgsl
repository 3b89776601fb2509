// Sky visibility on the floor, for the texels of a map: irradiance of a surface that faces up, as moments over the
// directions above, C₀ = 4 ⟨T max(n·ω, 0)⟩ and C₁ = 4 ⟨T max(n·ω, 0) ω⟩: E/π = l₀ C₀ + l₁ · C₁. Texels also lie
// beside and under the grid, where rays end that have missed it or passed through it. The cosine is in the density of
// directions, which are denser towards the zenith.
#import "sky/rays.wgsl"
#import "sky/floor_place.wgsl"

// Transmittance of each ray where it meets the floor, a layer for each direction (sky/floor_sweep.wgsl).
@group(0) @binding(1) var transmittance: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var<storage, read_write> sums: array<vec4f>;
// C₁ in rgb, C₀ in a.
@group(0) @binding(4) var moments: texture_storage_3d<rgba16float, write>;

// Number of directions in a batch. A constant rather than a uniform, because drivers unroll loops with a known end.
override DIRECTIONS: u32 = 4u;
// Set for the last batch, which stores the mean.
override IS_LAST: bool = true;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sweep = bound_sweep;
    map = bound_map;
    if (any(id.xy >= vec2u(map.size))) {
        return;
    }
    let block = map.origin + map.along_x * f32(id.x) + map.along_y * f32(id.y);
    let at = id.y * map.size + id.x;
    var sum = sums[at] * sweep.has_sums;
    for (var i = 0u; i < DIRECTIONS; i += 1u) {
        let rays = bound_sweep.rays[i];
        // Beyond the first and the last rays there is no occlusion.
        let ray = clamp(ray_coordinates(rays, block).xy, vec2f(-1.0), vec2f(rays.size) - 1.0);
        let place = vec3f(ray + 1.5, f32(i) + 0.5) * sweep.sheet_scale;
        let passed = textureSampleLevel(transmittance, clamped, place, 0.0).r;
        sum += rays.weight * passed * vec4f(rays.direction_to_light, 1.0);
    }
    if (IS_LAST) {
        textureStore(moments, vec3u(id.xy, 0u), sum * map.share);
    } else {
        sums[at] = sum;
    }
}
