// The light that blocks receive that has been scattered: what the last bounce brings.
#import "bounces/bounce.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(10) var bounced: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    bounce = bound_bounce;
    if (any(id >= bounce.dims)) {
        return;
    }
    let sum = sums[number_of(id)] * bounce.share;
#if ONE_COLOR
    let light = sum.r * bounce.color;
#else
    let light = sum.rgb;
#endif
    textureStore(bounced, id, vec4f(min(light, vec3f(MOST_LIGHT)), 1.0));
}
