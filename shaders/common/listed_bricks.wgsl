// Passes over the light voxels of listed bricks (src/gpu/volume/listed_bricks.rs): two workgroups of
// 8 × 8 × 4 to a brick of 8³, in rows of 16384 bricks because a dispatch has at most 65535 groups along an axis.
// A listed brick is its coordinates, of ten bits each, and a bit for each of its 4³ cells that is meant.
#import "common/sizes.wgsl"

// Which brick of the list a workgroup fills half of.
fn listed_brick(group: vec3u) -> u32 {
    return group.y * LISTED_PER_ROW + group.x / 2u;
}

// A brick's coordinates.
fn unpacked(packed: u32) -> vec3u {
    return vec3u(packed & 1023u, packed >> 10u & 1023u, packed >> 20u);
}

// The light voxel that an invocation fills, of a packed brick.
fn voxel_in(packed: u32, group: vec3u, local: vec3u) -> vec3u {
    let brick = unpacked(packed);
    return brick * BRICK_EDGE + local + vec3u(0u, 0u, group.x % 2u * (BRICK_EDGE / 2));
}

// Whether that voxel's cell is meant.
fn is_listed(brick: vec4u, group: vec3u, local: vec3u) -> bool {
    let cell = local / CELL_EDGE;
    return (select(brick.y, brick.z, group.x % 2u == 1u) >> (cell.x + 4u * cell.y + 16u * cell.z) & 1u) == 1u;
}
