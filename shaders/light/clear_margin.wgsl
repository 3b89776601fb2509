// Clearing of the margin around the filled cells of a light volume, which only previews look up: fully lit. One
// thread per voxel.
#import "common/listed_bricks.wgsl"

@group(0) @binding(0) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(1) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let listed = listed_brick(group);
    if (listed < arrayLength(&bricks)) {
        let voxel = voxel_in(bricks[listed].x, group, local);
        if (is_listed(bricks[listed], group, local) && all(voxel < textureDimensions(attenuation))) {
            textureStore(attenuation, voxel, vec4f(1.0));
        }
    }
}
