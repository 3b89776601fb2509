// Prefiltered density and presence, level 0 of the pyramid of a volume with missing voxels: the blurred volume
// (volume/prefilter.wgsl), and the fraction of the blur on existing voxels, both available in one fetch.
#import "volume/prefiltered.wgsl"
#import "density/stored_presence.wgsl"

@group(0) @binding(2) var level: texture_storage_3d<PAIR_FORMAT, write>;
@group(0) @binding(4) var presence_level: texture_3d<f32>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(level))) {
        return;
    }
    let share = decode_presence(textureLoad(presence_level, texel, 0));
    textureStore(level, texel, vec4f(prefiltered(texel), share, 0.0, 0.0));
}
