// Clearing of the margin around the filled cells of a light volume, which only previews look up: fully lit. One
// thread per voxel.
#import "common/listed_voxels.wgsl"

@group(0) @binding(0) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(1) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let voxel = voxel_of_listed_brick(group, local, arrayLength(&bricks));
    if (all(voxel < textureDimensions(attenuation))) {
        textureStore(attenuation, voxel, vec4f(1.0));
    }
}
