// The next level of the pyramid, at half the resolution.
//
// A level must have the B-spline's variance at its own scale: 4^l/3 in voxels², of which the
// trilinear fetch brings 4^l/6. From 4^l/6 to 4^(l+1)/6 lacks 4^l/2, half a texel² of level l: the
// kernel [1, 7, 7, 1]/16 has just that, and is the mean of two linear fetches at ± 0.625 texel.
#import "volume/resample.wgsl"

const OFFSET = 0.625;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = texel_of(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    textureStore(level, texel, vec4f(mean_around(vec3f(texel) * 2.0 + 1.0, OFFSET)));
}
