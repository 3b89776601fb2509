// Average of the attenuation volumes of points on an area light: adds the volumes of a batch of points to the partial
// sum, and after the last batch stores the mean. One thread per voxel.
#import "common/listed_voxels.wgsl"

struct AverageUniform {
    dims: vec3u,
    // Number of bricks listed for this dispatch.
    bricks: u32,
    // One over the number of points added so far.
    share: f32,
    pad0: u32,
    pad1: u32,
    pad2: u32,
}

@group(0) @binding(0) var<uniform> bound_average: AverageUniform;
var<private> average: AverageUniform;
@group(0) @binding(1) var<storage, read> bricks: array<vec4u>;
// Attenuation volumes of the points in the batch.
@group(0) @binding(2) var point_0: texture_3d<f32>;
@group(0) @binding(3) var point_1: texture_3d<f32>;
@group(0) @binding(4) var point_2: texture_3d<f32>;
@group(0) @binding(5) var point_3: texture_3d<f32>;
// Partial sum before and after this batch.
@group(0) @binding(6) var before: texture_3d<f32>;
@group(0) @binding(7) var after: texture_storage_3d<r32float, write>;
@group(0) @binding(8) var attenuation: texture_storage_3d<TARGET_FORMAT, write>;

// Number of points in the batch, up to four; flags for the first and the last batch.
override BATCH_SIZE: u32 = 1u;
override IS_FIRST: bool = true;
override IS_LAST: bool = true;

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    average = bound_average;
    let voxel = voxel_of_listed_brick(group, local, average.bricks);
    if (any(voxel >= average.dims)) {
        return;
    }
    var sum = textureLoad(point_0, voxel, 0).r;
    if (BATCH_SIZE > 1u) {
        sum += textureLoad(point_1, voxel, 0).r;
    }
    if (BATCH_SIZE > 2u) {
        sum += textureLoad(point_2, voxel, 0).r;
    }
    if (BATCH_SIZE > 3u) {
        sum += textureLoad(point_3, voxel, 0).r;
    }
    if (!IS_FIRST) {
        sum += textureLoad(before, voxel, 0).r;
    }
    if (IS_LAST) {
        textureStore(attenuation, voxel, vec4f(sum * average.share));
    } else {
        textureStore(after, voxel, vec4f(sum));
    }
}
