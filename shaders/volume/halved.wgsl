// Downsampling by two, to the next level of a pyramid.
//
// A level must have the B-spline's variance at its own scale: 4^l/3 in voxels², of which the trilinear fetch
// contributes 4^l/6. From 4^l/6 to 4^(l+1)/6 is a difference of 4^l/2, half a texel² of level l: the kernel [1, 7, 7,
// 1]/16 has exactly that, and is the mean of two linear fetches at ± 0.625 texel.
#import "volume/resample.wgsl"

const OFFSET = 0.625;

// Value of a texel, from the finer level, which is bound as the source.
fn downsampled(texel: vec3u) -> vec4f {
    return mean_around(vec3f(texel) * 2.0 + 1.0, OFFSET);
}
