// Sweep of the sky's light along parallel rays: one thread per ray walks through slices of blocks, and stores the
// transmittance that it deposits in each, like the light pass does (sheets/march.wgsl).
#import "sky/swept_ray.wgsl"
#import "common/slab_mean.wgsl"

@group(0) @binding(1) var extinction: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var sheets: texture_storage_3d<STORAGE_FORMAT, write>;

// Transmittance below which a ray counts as dark: the smallest normal number of 16 bits.
const DARKNESS = 6.1e-5;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sweep = bound_sweep;
    // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
    let rays = bound_sweep.rays[id.z];
    if (any(id.xy >= rays.size)) {
        return;
    }
    let ray = swept_ray(rays, id.xy, 1.0 + MAX_DISTANCE_OUTSIDE);
    var t = 1.0;
    var n = ray.span.x;
    for (; n <= ray.span.y && t > DARKNESS; n += 1.0) {
        // Negative in front of surfaces (sky/sharpened_blocks.wgsl).
        let depth = textureSampleLevel(extinction, clamped, place_in_blocks(rays, ray, n), 0.0).r;
        let tau = max(depth, 0.0) * rays.step;
        textureStore(sheets, vec3u(id.xy, rays.layer + u32(n)), vec4f(t * slab_mean_transmittance(tau)));
        t *= exp(-tau);
    }
    for (; n <= ray.span.y; n += 1.0) {
        textureStore(sheets, vec3u(id.xy, rays.layer + u32(n)), vec4f(0.0));
    }
}
