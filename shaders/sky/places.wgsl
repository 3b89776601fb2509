// The places of a block of voxels from which its mean extinction is taken: eight, or the one voxel that a block is.
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
    // What of light that is met is scattered, not absorbed; only where that is asked for (bounces/blocks.wgsl).
    albedo: f32,
    shading_cut: Cut,
}

@group(0) @binding(0) var<uniform> bound_blocks: Blocks;
var<private> blocks: Blocks;
// Cells of blocks in which anything may attenuate light.
@group(0) @binding(2) var<storage, read> cells: array<u32>;

// What attenuates light at an index-space point.
fn extinction_at(p: vec3f) -> f32 {
#if PRECLASSIFY
    let found = classified_extinction(spread(p, blocks.level).r);
#else
    let found = classified_extinction(pyramid(p, blocks.level)) * pyramid_presence(p, blocks.level);
#endif
    return found * share_that_shades(blocks.shading_cut, p);
}

// The middle of a block, in index space.
fn middle_of(id: vec3u) -> vec3f {
    return (vec3f(id) + 0.5) * blocks.voxel_step - 0.5;
}

// One of the eight.
fn place_in(id: vec3u, corner: u32) -> vec3f {
    let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
    return middle_of(id) + side * blocks.offset;
}
