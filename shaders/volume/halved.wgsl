// The next level of a pyramid, at half the resolution.
//
// A level must have the B-spline's variance at its own scale: 4^l/3 in voxels², of which the
// trilinear fetch brings 4^l/6. From 4^l/6 to 4^(l+1)/6 lacks 4^l/2, half a texel² of level l: the
// kernel [1, 7, 7, 1]/16 has just that, and is the mean of two linear fetches at ± 0.625 texel.
#import "volume/resample.wgsl"

const OFFSET = 0.625;

// What a texel holds of the level before, which is bound as the source.
fn halved(texel: vec3u) -> vec4f {
    return mean_around(vec3f(texel) * 2.0 + 1.0, OFFSET);
}
