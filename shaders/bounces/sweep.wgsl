// The march of scattered light along parallel rays: one thread per ray walks slices of blocks, and stores for each the
// mean light there: what is left of that from behind, L, and of what the slice gives off, S. Of a slab of optical depth τ
// with m = (1 − e^−τ)/τ that is L m + S (1 − m), and L e^−τ + S (1 − e^−τ) leaves it.
#import "sky/rays.wgsl"
#import "sky/near.wgsl"
#import "common/slab_source.wgsl"
#import "common/most_light.wgsl"

// In rgb what blocks give off per shortest edge, S times extinction; extinction in a.
@group(0) @binding(1) var medium: texture_3d<f32>;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var sheets: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sweep = bound_sweep;
    // Not from the copy: an index that varies would keep that as an array in memory.
    let rays = bound_sweep.rays[id.z];
    if (any(id.xy >= rays.size)) {
        return;
    }
    let size = turned_to(rays, vec3f(sweep.dims));
    let last = size.x - 1.0;
    let start = vec2f(id.xy) + rays.first;
    let span = slices_of_ray(rays, start, size);
    var light = rays.arriving;
    for (var n = span.x; n <= span.y; n += 1.0) {
        let slice = select(last - n, n, rays.rises == 1u);
        let block = turned_from(rays, vec3f(slice, start + rays.drift * n));
        let found = textureSampleLevel(medium, clamped, (block + 1.5) * sweep.block_scale, 0.0) * rays.step;
        let share = slab_source(found.a);
        let mean = 1.0 - found.a * share;
        textureStore(sheets, vec3u(id.xy, rays.layer + u32(n)), vec4f(min(light * mean + found.rgb * share, vec3f(MOST_LIGHT)), 0.0));
        light = light * exp(-found.a) + found.rgb * mean;
    }
}
