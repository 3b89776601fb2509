// Downsampling of pre-classified voxels to the next level of their pyramid.
#import "volume/halved.wgsl"

@group(0) @binding(2) var level: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    textureStore(level, texel, downsampled(texel));
}
