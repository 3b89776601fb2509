// Average of the attenuation volumes of points on an area light, weighted by their cosines to surfaces if the light is
// wide: adds the volumes of a batch of points to the partial sum, and after the last batch stores the mean. One thread
// per voxel.
#import "common/listed_voxels.wgsl"
#import "common/space.wgsl"
#import "shading/point_weights.wgsl"

struct AverageUniform {
    dims: vec3u,
    // Number of bricks listed for this dispatch.
    bricks: u32,
    // Direction towards a parallel light, or position of a perspective one, in scene space.
    place: vec3f,
    // 0: parallel, 1: perspective.
    perspective: f32,
    // Vectors from the centre of the light to its right and its upper border, as in shading/lights.wgsl.
    right: vec3f,
    // One over the number of points added so far.
    share: f32,
    up: vec3f,
    // Number of data voxels per voxel of the light volume, along an axis.
    voxel_step: f32,
    // Coordinates of the points in the batch between the centre of the light and these borders.
    to_right: vec4f,
    to_top: vec4f,
    // Scale from index space to texture coordinates of the normals: (p + ½) × lookup.
    lookup: vec3f,
    pad0: f32,
    space: SpaceUniform,
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

#option COSINES: points of a wide light count by their cosines to the surfaces near voxels
#if COSINES
// Normals of surfaces near blocks (light/block_normals.wgsl).
@group(0) @binding(9) var normals: texture_3d<f32>;
@group(0) @binding(10) var clamped: sampler;
#endif

// Number of points in the batch, up to four; flags for the first and the last batch.
override BATCH_SIZE: u32 = 1u;
override IS_FIRST: bool = true;
override IS_LAST: bool = true;

// Weights of the points in the batch, with a mean of 1 over all points of the light.
fn point_weights(voxel: vec3u) -> vec4f {
#if COSINES
    let p = (vec3f(voxel) + 0.5) * average.voxel_step - 0.5;
    let normal = textureSampleLevel(normals, clamped, (p + 0.5) * average.lookup, 0.0).xyz;
    let towards = average.place - average.perspective * scene_from_index(average.space, p);
    let slope = weight_slope(towards, average.right, average.up, normal, length(normal));
    return 1.0 + dot(slope, average.right) * average.to_right + dot(slope, average.up) * average.to_top;
#else
    return vec4f(1.0);
#endif
}

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    average = bound_average;
    let voxel = voxel_of_listed_brick(group, local, average.bricks);
    if (any(voxel >= average.dims)) {
        return;
    }
    let weights = point_weights(voxel);
    var sum = weights.x * textureLoad(point_0, voxel, 0).r;
    if (BATCH_SIZE > 1u) {
        sum += weights.y * textureLoad(point_1, voxel, 0).r;
    }
    if (BATCH_SIZE > 2u) {
        sum += weights.z * textureLoad(point_2, voxel, 0).r;
    }
    if (BATCH_SIZE > 3u) {
        sum += weights.w * textureLoad(point_3, voxel, 0).r;
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
