// What a floor sees of the sky: for places on a map of it the light that falls on a surface which faces up, as moments over
// the directions above, C₀ = 4 ⟨T max(n·ω, 0)⟩ and C₁ = 4 ⟨T max(n·ω, 0) ω⟩: E/π = l₀ C₀ + l₁ · C₁. Places lie beside and
// under the grid, too: light that has passed it has the transmittance of the ray where that left it. The cosine is in the
// directions, which are denser above.
#import "sky/rays.wgsl"
#import "sky/near.wgsl"

struct FloorMap {
    // In blocks: the middle of texel (0, 0), and how far it is to the next along both edges.
    origin: vec3f,
    // What makes an open floor's C₀ be 1.
    share: f32,
    along_x: vec3f,
    size: u32,
    along_y: vec3f,
    pad0: f32,
}

@group(0) @binding(1) var<uniform> bound_map: FloorMap;
var<private> map: FloorMap;
@group(0) @binding(2) var sheets: texture_3d<f32>;
@group(0) @binding(3) var<storage, read_write> sums: array<vec4f>;
// C₁ in rgb, C₀ in a.
@group(0) @binding(4) var moments: texture_storage_3d<rgba16float, write>;

// The transmittance of one ray where it has come as far as slice n.
fn passed_by(rays: SkyRays, ray: vec2f, n: f32, size: vec3f) -> f32 {
    let span = slices_of_ray(rays, ray + rays.first, size);
    let at = clamp(floor(n + 0.5), span.x, max(span.y, span.x));
    let place = vec3i(vec3f(ray, f32(rays.layer) + at));
    let is_ray = all(ray >= vec2f(0.0)) && all(ray < vec2f(rays.size)) && span.x <= span.y && n >= span.x;
    let stored = textureLoad(sheets, select(vec3i(0), place, is_ray), 0).r;
    return select(1.0, stored, is_ray);
}

// Rays of a batch. Not a number of the uniform's: drivers lay out a loop whose end they know.
override DIRECTIONS: u32 = 4u;
// Whether it is the last, and the mean is known.
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
        let size = turned_to(rays, vec3f(sweep.dims));
        let place = place_among(rays, block);
        let n = place.z;
        let low = floor(place.xy);
        let f = place.xy - low;
        let near = mix(passed_by(rays, low, n, size), passed_by(rays, low + vec2f(1.0, 0.0), n, size), f.x);
        let far = mix(
            passed_by(rays, low + vec2f(0.0, 1.0), n, size),
            passed_by(rays, low + vec2f(1.0, 1.0), n, size),
            f.x,
        );
        sum += rays.weight * mix(near, far, f.y) * vec4f(rays.towards, 1.0);
    }
    if (IS_LAST) {
        textureStore(moments, vec3u(id.xy, 0u), sum * map.share);
    } else {
        sums[at] = sum;
    }
}
