// Downsampling by two, to the next level of a pyramid: density or pre-classified voxels. The
// target takes as many channels as it has.
//
// A level must have the B-spline's variance at its own scale: 4^l/3 in voxels², of which the trilinear fetch
// contributes 4^l/6. From 4^l/6 to 4^(l+1)/6 is a difference of 4^l/2, half a texel² of level l: the kernel [1, 7, 7,
// 1]/16 has exactly that, and is the mean of two linear fetches at ± 0.625 texel.
#import "volume/resample.wgsl"

@group(0) @binding(2) var level: texture_storage_3d<TARGET_FORMAT, write>;

const OFFSET = 0.625;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    // From the finer level, which is bound as the source.
    textureStore(level, texel, mean_around(vec3f(texel) * 2.0 + 1.0, OFFSET));
}
