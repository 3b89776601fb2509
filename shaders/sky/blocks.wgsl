// What attenuates the light of a sky, block by block of voxels: the mean extinction of eight places in each, or of the
// one voxel that a block is, as optical depth per shortest edge of a voxel. Around the grid is a block of nothing.
#import "common/sizes.wgsl"
#import "density/classify.wgsl"
#import "density/cells.wgsl"
#import "density/cut.wgsl"

struct Blocks {
    // Without those around the grid.
    dims: vec3u,
    // Voxels along the edge of a block.
    voxel_step: f32,
    // The level of the pyramid whose texels are as large as an eighth of a block.
    level: f32,
    // How far the eight places are from the middle of a block along each axis, in voxels.
    offset: f32,
    // Optical depth per shortest edge for one of extinction.
    edge: f32,
    pad0: f32,
    shading_cut: Cut,
}

@group(0) @binding(0) var<uniform> bound_blocks: Blocks;
var<private> blocks: Blocks;
// In g the distance in cells to the nearest that attenuates light.
@group(0) @binding(2) var distances: texture_3d<f32>;
@group(0) @binding(3) var extinction: texture_storage_3d<STORAGE_FORMAT, write>;

// What attenuates light at an index-space point.
fn extinction_at(p: vec3f) -> f32 {
#if PRECLASSIFY
    let found = classified_extinction(spread(p, blocks.level).r);
#else
    let found = classified_extinction(pyramid(p, blocks.level)) * pyramid_presence(p, blocks.level);
#endif
    return found * share_that_shades(blocks.shading_cut, p);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    blocks = bound_blocks;
    grid = bound_grid;
    if (any(id >= blocks.dims + 2u)) {
        return;
    }
    let middle = (vec3f(id) - 0.5) * blocks.voxel_step - 0.5;
    let is_inside = all(id >= vec3u(1u)) && all(id <= blocks.dims);
    var sum = 0.0;
    if (is_inside && near(distances, floor(middle / CELL_EDGE)).y <= grid.dilation) {
        for (var corner = 0u; corner < 8u; corner += 1u) {
            let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
            sum += extinction_at(middle + side * blocks.offset);
        }
    }
    textureStore(extinction, id, vec4f(sum * blocks.edge / 8.0));
}
