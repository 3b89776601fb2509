// Sweep of the sky's light down to the floor: one thread per ray follows it to the slice in which it meets the floor,
// and stores the transmittance there, one texel per ray. A row and a column of rays that miss the grid precede them.
#import "sky/swept_ray.wgsl"
#import "sky/floor_place.wgsl"
#import "common/slab_mean.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var transmittance: texture_storage_3d<STORAGE_FORMAT, write>;

// Slice in which a ray meets the floor; fractional, and possibly before the first or behind the last.
fn slice_of_floor(rays: SweepRaysUniform, ray: SweptRay) -> f32 {
    let begin = from_sweep_axes(rays, vec3f(select(ray.last, 0.0, rays.is_ascending == 1u), ray.start));
    let step = from_sweep_axes(rays, vec3f(select(-1.0, 1.0, rays.is_ascending == 1u), rays.drift));
    return (map.plane.w - dot(map.plane.xyz, begin)) / dot(map.plane.xyz, step);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sweep = bound_sweep;
    map = bound_map;
    // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
    let rays = bound_sweep.rays[id.z];
    if (any(id.xy > rays.size)) {
        return;
    }
    let ray = swept_ray(rays, max(id.xy, vec2u(1u)) - 1u, 1.0);
    let end = floor(slice_of_floor(rays, ray) + 0.5);
    let is_beside = any(id.xy == vec2u(0u));
    var t = 1.0;
    for (var n = ray.span.x; n <= select(min(ray.span.y, end), -1.0, is_beside); n += 1.0) {
        let depth = textureSampleLevel(extinction, clamped, place_in_blocks(rays, ray, n), 0.0).r;
        let tau = max(depth, 0.0) * rays.step;
        t *= select(exp(-tau), slab_mean_transmittance(tau), n == end);
    }
    textureStore(transmittance, vec3u(id.xy, id.z), vec4f(t));
}
