// Medium of the sweeps: emission of blocks per shortest edge of a voxel, and their extinction; in rgb and a, or in r and
// g.

#import "common/most_light.wgsl"

#option ONE_COLOR: all light has the same colour, and only its amount is followed, a third of the numbers

#if ONE_COLOR
fn medium_texel(emission: vec3f, extinction: f32) -> vec4f {
    return rounded_to_half(vec4f(emission.r, extinction, 0.0, 0.0));
}

fn extinction_in(found: vec4f) -> f32 {
    return found.g;
}
#else
fn medium_texel(emission: vec3f, extinction: f32) -> vec4f {
    return rounded_to_half(vec4f(emission, extinction));
}

fn extinction_in(found: vec4f) -> f32 {
    return found.a;
}
#endif
