// Merging of the attenuation volumes of red, green and blue light into one. One thread per voxel.
#import "common/listed_voxels.wgsl"

@group(0) @binding(0) var<storage, read> bricks: array<vec4u>;
@group(0) @binding(1) var red: texture_3d<f32>;
@group(0) @binding(2) var green: texture_3d<f32>;
@group(0) @binding(3) var blue: texture_3d<f32>;
@group(0) @binding(4) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let voxel = voxel_of_listed_brick(group, local, arrayLength(&bricks));
    if (all(voxel < textureDimensions(attenuation))) {
        let rgb = vec3f(textureLoad(red, voxel, 0).r, textureLoad(green, voxel, 0).r, textureLoad(blue, voxel, 0).r);
        textureStore(attenuation, voxel, vec4f(rgb, 1.0));
    }
}
