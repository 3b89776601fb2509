// Sample points of a block of voxels for its mean extinction: eight, or the single voxel of a block.
#import "common/sizes.wgsl"
#import "density/cells.wgsl"
#import "density/cut.wgsl"
#import "volume/material.wgsl"

struct BlocksUniform {
    // Number of blocks along x, y and z, without the border.
    dims: vec3u,
    // Number of voxels along the edge of a block.
    voxel_step: f32,
    // Pyramid level with texels as large as an eighth of a block.
    level: f32,
    // Distance of the eight sample points from the block's centre along each axis, in voxels.
    offset: f32,
    // Optical depth per shortest edge of a voxel, for unit extinction.
    edge: f32,
    // Fraction of attenuated light that is scattered, not absorbed; used by scattered_light/blocks.wgsl only.
    albedo: f32,
    // Largest optical depth per shortest edge of a voxel that a sample point counts for; used by
    // sky/extinction_blocks.wgsl only.
    max_depth: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
    shading_cut: CutUniform,
}

@group(0) @binding(0) var<uniform> bound_blocks: BlocksUniform;
var<private> blocks: BlocksUniform;
// Cells of blocks in which something may attenuate light.
@group(0) @binding(2) var<storage, read> cells: array<u32>;

// Extinction at an index-space point.
fn extinction_at(p: vec3f) -> f32 {
    return pyramid_extinction(p, blocks.level) * shading_fraction(blocks.shading_cut, p);
}

// Centre of a block in index space.
fn block_centre(id: vec3u) -> vec3f {
    return (vec3f(id) + 0.5) * blocks.voxel_step - 0.5;
}

// Sample point of a block, one of eight.
fn block_sample_point(id: vec3u, corner: u32) -> vec3f {
    let side = vec3f(f32(corner & 1u), f32(corner >> 1u & 1u), f32(corner >> 2u)) * 2.0 - 1.0;
    return block_centre(id) + side * blocks.offset;
}
