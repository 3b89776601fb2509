// Clearing of the margin around the filled blocks, which only previews look up: the whole sky is visible there.
#import "common/listed_cells.wgsl"

@group(0) @binding(0) var<storage, read> cells: array<u32>;
// V₁ in rgb, V₀ in a.
@group(0) @binding(1) var moments: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = voxel_of_listed_cell(group, lane);
    if (all(block < textureDimensions(moments))) {
        textureStore(moments, block, vec4f(0.0, 0.0, 0.0, 1.0));
    }
}
