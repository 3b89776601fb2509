// What attenuates the light of a sky, in listed blocks of voxels: the mean extinction of eight places in each, or of the
// one voxel that a block is, as optical depth per shortest edge of a voxel. In all others is nothing, and around the grid is
// a block of nothing.
#import "sky/places.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(3) var extinction: texture_storage_3d<STORAGE_FORMAT, write>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    blocks = bound_blocks;
    grid = bound_grid;
    let listed = listed_cell(group, lane);
    if (listed >= arrayLength(&cells)) {
        return;
    }
    let id = voxel_of(cells[listed], lane);
    if (any(id >= blocks.dims)) {
        return;
    }
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner += 1u) {
        sum += extinction_at(place_in(id, corner));
    }
    textureStore(extinction, id + 1u, vec4f(sum * blocks.edge / 8.0));
}
