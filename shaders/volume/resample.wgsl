// Separable filtering for pyramid levels: eight linear fetches around a texel.
#import "volume/field.wgsl"
#import "volume/levels.wgsl"

// Mean of the fetches at the corners of a cube of half width `offset`, in texels of the source: a separable kernel,
// derived where it is used.
fn mean_around(centre: vec3f, offset: f32) -> vec4f {
    let scale = 1.0 / vec3f(source_size());
    var sum = vec4f(0.0);
    for (var corner = 0u; corner < 8u; corner += 1u) {
        let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
        sum += source_at((centre + side * offset) * scale);
    }
    return sum / 8.0;
}
