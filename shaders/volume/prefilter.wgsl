// Level 0 of the pyramid: the volume blurred once with [1/12, 10/12, 1/12]³, so that one trilinear
// fetch has the variance of the cubic B-spline (1/6 from the blur, 1/6 from the fetch; 1/3 in all).
//
// [a, 1 − 2a, a] along an axis is the mean of two linear fetches at ± 2a from the voxel.
#import "volume/resample.wgsl"

const OFFSET = 1.0 / 6.0;

@group(0) @binding(2) var level: texture_storage_3d<STORAGE_FORMAT, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = texel_of(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    // The pyramid has four voxels of padding, the density texture one.
    let centre = vec3f(texel) - 4.0 + 1.0 + 0.5;
    textureStore(level, texel, vec4f(mean_around(centre, OFFSET).r));
}
