// Extinction of listed blocks of voxels, for the sky's light: mean extinction of eight sample points in each (or of
// the single voxel), as optical depth per shortest edge of a voxel. Other blocks are empty, and so is a border around
// the grid.
#import "sky/places.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(3) var extinction: texture_storage_3d<STORAGE_FORMAT, write>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    blocks = bound_blocks;
    grid = bound_grid;
    let id = voxel_of_listed_cell(group, lane);
    if (any(id >= blocks.dims)) {
        return;
    }
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        sum += min(extinction_at(block_sample_point(id, corner)) * blocks.edge, blocks.max_depth);
    }
    textureStore(extinction, id + 1u, vec4f(sum / 8.0));
}
