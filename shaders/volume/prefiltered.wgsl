// Prefilter: the volume blurred once with [1/12, 10/12, 1/12]³, so that one trilinear fetch has the variance of the
// cubic B-spline (1/6 from the blur, 1/6 from the fetch; 1/3 in all).
//
// [a, 1 − 2a, a] along an axis is the mean of two linear fetches at ± 2a from the voxel.
#import "volume/resample.wgsl"

const OFFSET = 1.0 / 6.0;

// Value of a texel of level 0, from the density texture, which is bound as the source.
fn prefiltered(texel: vec3u) -> f32 {
    // The pyramid has a padding of four voxels, the density texture one.
    return mean_around(vec3f(texel) - 4.0 + 1.0 + 0.5, OFFSET).r;
}
