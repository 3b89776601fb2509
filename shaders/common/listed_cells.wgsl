// Decoding of dispatches over listed cells of 2³ voxels or blocks (crates/render/src/volume/cell_list.rs): eight
// cells per workgroup of 64 invocations, in rows of 16384 workgroups because a dispatch has at most 65535 along an
// axis. A list entry holds the cell's coordinates, packed like those of bricks.
#import "common/sizes.wgsl"
#import "common/listed_bricks.wgsl"

// List index of the cell of an invocation.
fn listed_cell(group: vec3u, lane: u32) -> u32 {
    return (group.y * LISTED_PER_ROW + group.x) * 8u + lane / 8u;
}

// Index of the invocation's voxel among those of all listed cells.
fn listed_voxel(listed: u32, lane: u32) -> u32 {
    return listed * 8u + lane % 8u;
}

// Coordinates of the invocation's voxel.
fn voxel_of(cell: u32, lane: u32) -> vec3u {
    return unpack_coordinates(cell) * CELL_EDGE + (vec3u(lane, lane >> 1u, lane >> 2u) & vec3u(1u));
}

// Voxel of an invocation from the list `cells`, which the importing shader declares; out of range for invocations
// without one.
fn voxel_of_listed_cell(group: vec3u, lane: u32) -> vec3u {
    let listed = listed_cell(group, lane);
    if (listed >= arrayLength(&cells)) {
        return vec3u(~0u);
    }
    return voxel_of(cells[listed], lane);
}
