// Prefiltered density, level 0 of the pyramid: the volume blurred once with [1/12, 10/12, 1/12]³, so that one trilinear
// fetch has the variance of the cubic B-spline (1/6 from the blur, 1/6 from the fetch; 1/3 in all).
//
// [a, 1 − 2a, a] along an axis is the mean of two linear fetches at ± 2a from the voxel.
#import "volume/resample.wgsl"

@group(0) @binding(2) var level: texture_storage_3d<TARGET_FORMAT, write>;

const OFFSET = 1.0 / 6.0;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    // From the density texture, which is bound as the source. The pyramid has a padding of four voxels, the density
    // texture one.
    let prefiltered = mean_around(vec3f(texel) - 4.0 + 1.0 + 0.5, OFFSET).r;
    textureStore(level, texel, vec4f(prefiltered));
}
