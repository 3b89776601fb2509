// Passes over listed cells of 2³ voxels or blocks (src/gpu/volume/listed_cells.rs), eight to a workgroup of 64 invocations,
// in rows of 16384 workgroups because a dispatch has at most 65535 along an axis. A listed cell is its coordinates, as those
// of bricks are packed.
#import "common/sizes.wgsl"
#import "common/listed_bricks.wgsl"

// Which entry of the list an invocation works on.
fn listed_cell(group: vec3u, lane: u32) -> u32 {
    return (group.y * LISTED_PER_ROW + group.x) * 8u + lane / 8u;
}

// Which of the voxels of all listed cells it works on.
fn listed_voxel(listed: u32, lane: u32) -> u32 {
    return listed * 8u + lane % 8u;
}

// Where that lies.
fn voxel_of(cell: u32, lane: u32) -> vec3u {
    return unpacked(cell) * CELL_EDGE + (vec3u(lane, lane >> 1u, lane >> 2u) & vec3u(1u));
}
