// Decoding of dispatches over the light voxels of listed bricks (crates/render/src/volume/brick_list.rs): two
// workgroups of 8 × 8 × 4 invocations per brick of 8³, in rows of 16384 bricks because a dispatch has at most 65535
// groups along an axis. A list entry holds the brick's coordinates, ten bits each, and a mask of its 4³ cells.
#import "common/sizes.wgsl"

// List index of the brick whose half a workgroup processes.
fn listed_brick(group: vec3u) -> u32 {
    return group.y * LISTED_PER_ROW + group.x / 2u;
}

// Coordinates of a packed brick.
fn unpack_coordinates(packed: u32) -> vec3u {
    return vec3u(packed & 1023u, packed >> 10u & 1023u, packed >> 20u);
}

// Light voxel of an invocation, in a packed brick.
fn voxel_in(packed: u32, group: vec3u, local: vec3u) -> vec3u {
    let brick = unpack_coordinates(packed);
    return brick * BRICK_EDGE + local + vec3u(0u, 0u, group.x % 2u * (BRICK_EDGE / 2));
}

// Whether the mask contains the invocation's cell.
fn is_listed(brick: vec4u, group: vec3u, local: vec3u) -> bool {
    let cell = local / CELL_EDGE;
    return (select(brick.y, brick.z, group.x % 2u == 1u) >> (cell.x + 4u * cell.y + 16u * cell.z) & 1u) == 1u;
}
