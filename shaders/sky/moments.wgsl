// Moments of sky visibility at listed blocks: mean transmittance over directions, V₀, and mean of transmittance times
// direction, V₁, gathered from the rays of a batch around each block's centre and added to the sums of earlier
// batches.
//
// Blocks near a surface store the light of that surface instead. With the cosine c of a direction to its normal n, it
// is E/π = 4 ⟨T c⟩ over the hemisphere above. The formula of the eye, A₀ + 2 n · A₁, yields that from
//   V₀ = ⟨T 12 c (1 − c)⟩ and V₁ = ⟨T 4 c (ω − c n)⟩ + ½ (⟨T 4 c⟩ − V₀) n.
// The means ⟨12 c (1 − c)⟩ and ⟨4 c⟩ over few directions are not quite 1, and both sums are divided by them. An open
// surface has V₀ = 1 and V₁ = 0, so that it is equally bright for all normals: edges and noise of convex bodies show
// no error. What only sees a narrow cone has V₀ near 0, so that its light falls with the cosine.
#import "sky/rays.wgsl"
#import "sky/surface_block.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(1) var sheets: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
// Sums of the moments, one for each listed block.
@group(0) @binding(3) var<storage, read_write> sums: array<vec4f>;
// V₁ in rgb, V₀ in a.
@group(0) @binding(4) var moments: texture_storage_3d<rgba16float, write>;
@group(0) @binding(5) var<storage, read> cells: array<u32>;
// Packed surface of each listed block (sky/surfaces.wgsl).
@group(0) @binding(6) var<storage, read> surfaces: array<vec4u>;

// Number of directions in a batch. A constant rather than a uniform, because drivers unroll loops with a known end.
override DIRECTIONS: u32 = 4u;
// Set for the last batch, which stores the mean.
override IS_LAST: bool = true;

// Maximum number of slices between a surface and the start of a ray. Low directions would need more; their rays start
// above the surface instead.
const MAX_START_SLICES = 2.0;

// Maximum distance from a block, in blocks along an axis, at which its rays start; crates/render/src/sky/surfaces.rs
// provides sheets a block farther around. Only blocks well inside material would need more, which nothing looks up.
const MAX_START_DISTANCE = 2.5;

// Distance in rays and layers that texture coordinates keep from those of other directions: rounding of coordinates in
// a texture of 2048 layers moves them by up to 2.5e-4 of a layer.
const ROUNDING_MARGIN = 5e-4;

// Start of a ray in front of a surface, relative to the point at that height on the normal: on the ray from the
// surface itself, so that nothing shifts against the surroundings, unless that is too far away.
fn ray_start(rays: SweepRaysUniform, normal: vec3f, height: f32) -> vec3f {
    let slice = from_sweep_axes(rays, vec3f(select(1.0, -1.0, rays.is_ascending == 1u), -rays.drift));
    let rise = max(dot(normal, slice), 1e-6);
    return (slice - normal * rise) * min(height / rise, MAX_START_SLICES);
}

// Transmittance of the ray from a position in blocks to the sky; 1 outside the grid.
fn transmittance_from(rays: SweepRaysUniform, start: vec3f) -> f32 {
    // Rays and layers beyond these belong to other directions.
    let ends = vec3f(vec2f(rays.size), to_sweep_axes(rays, vec3f(sweep.dims)).x) - 1.0;
    let ray = clamp(ray_coordinates(rays, start), vec3f(ROUNDING_MARGIN), ends - ROUNDING_MARGIN);
    let passed = textureSampleLevel(sheets, clamped, place_of_ray(rays, ray), 0.0).r;
    let outside = max(-start, start + 1.0 - vec3f(sweep.dims));
    let most = max(outside.x, max(outside.y, outside.z));
    // From the faces of the outermost blocks on.
    return mix(passed, 1.0, saturate((most - 0.5) / (MAX_DISTANCE_OUTSIDE - 0.5)));
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    sweep = bound_sweep;
    geometry = bound_geometry;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= sweep.dims)) {
        return;
    }
    let at = listed_voxel(listed_cell(group, lane), lane);
    let surface = unpack_surface(surfaces[at]);
    let normal = scene_normal(surface);
    let height = clearance(surface.normal);
    let above = surface.normal * (height - surface.height);
    var sum = sums[at] * sweep.has_sums;
    let light_reaches = select(1.0, 0.0, surface.is_buried);
    for (var i = 0u; i < DIRECTIONS; i += 1u) {
        let rays = bound_sweep.rays[i];
        let to_light = rays.direction_to_light;
        let cosine = max(dot(normal, to_light), 0.0);
        // Rays from below are inside the material, where fog is looked up as ever.
        let share = select(0.0, surface.share, cosine > 0.0);
        let mean = surface.scale.x * 12.0 * cosine * (1.0 - cosine);
        let light = surface.scale.y * 4.0 * cosine;
        let of_surface = vec4f(light * (to_light - cosine * normal) + 0.5 * (light - mean) * normal, mean);
        let of_direction = rays.weight * light_reaches * mix(vec4f(to_light, 1.0), of_surface, surface.share);
        // Half of all directions are below a surface.
        if (any(of_direction != vec4f(0.0))) {
            let way = above + ray_start(rays, surface.normal, height);
            let start = vec3f(id) + share * clamp(way, vec3f(-MAX_START_DISTANCE), vec3f(MAX_START_DISTANCE));
            sum += transmittance_from(rays, start) * of_direction;
        }
    }
    if (IS_LAST) {
        textureStore(moments, id, sum * sweep.share);
    } else {
        sums[at] = sum;
    }
}
