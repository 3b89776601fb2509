// What attenuates the light of a sky, block by block of voxels: the mean extinction of eight places in each, or of the
// one voxel that a block is, as optical depth per shortest edge of a voxel. Around the grid is a block of nothing.
#import "sky/places.wgsl"

@group(0) @binding(3) var extinction: texture_storage_3d<STORAGE_FORMAT, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    blocks = bound_blocks;
    grid = bound_grid;
    if (any(id >= blocks.dims + 2u)) {
        return;
    }
    var sum = 0.0;
    if (may_attenuate(id)) {
        for (var corner = 0u; corner < 8u; corner += 1u) {
            sum += extinction_at(place_in(id, corner));
        }
    }
    textureStore(extinction, id, vec4f(sum * blocks.edge / 8.0));
}
