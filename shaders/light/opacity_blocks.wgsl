// Mean opacity of listed blocks of voxels, for an opacity unit of the shortest edge of a voxel: mean over eight sample
// points. Other blocks are empty, and so is a border around the grid. Unlike mean extinction it is linear in the share
// of a block that opaque material fills, so that normals do not depend on where a surface cuts its blocks.
#import "sky/places.wgsl"
#import "common/listed_cells.wgsl"

@group(0) @binding(3) var opacity: texture_storage_3d<STORAGE_FORMAT, write>;

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
        sum += 1.0 - exp(-extinction_at(block_sample_point(id, corner)) * blocks.edge);
    }
    textureStore(opacity, id + 1u, vec4f(sum / 8.0));
}
