// Result of the bounces: stores the light that listed blocks receive with the last one.
#import "scattered_light/bounce.wgsl"
#import "scattered_light/medium.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(5) var<storage, read> sums: array<vec4f>;
@group(0) @binding(6) var<storage, read> cells: array<u32>;
@group(0) @binding(10) var bounced: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    bounce = bound_bounce;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= bounce.dims)) {
        return;
    }
    let sum = sums[block_index(id)] * bounce.share;
#if ONE_COLOR
    let light = sum.r * bounce.color;
#else
    let light = sum.rgb;
#endif
    textureStore(bounced, id, vec4f(min(light, vec3f(MAX_HALF_FLOAT)), 1.0));
}
