// Passes over the light voxels of listed bricks (src/gpu/listed_bricks.rs): two workgroups of
// 8 × 8 × 4 to a brick of 8³, in rows of 32768 bricks because a dispatch has at most 65535 groups.

// Which brick of the list a workgroup fills half of.
fn listed_brick(group: vec3u) -> u32 {
    return group.y * 32768u + group.x / 2u;
}

// A brick's coordinates, of ten bits each.
fn unpacked(packed: u32) -> vec3u {
    return vec3u(packed & 1023u, packed >> 10u & 1023u, packed >> 20u);
}

// The light voxel that an invocation fills, of a packed brick.
fn voxel_in(packed: u32, group: vec3u, local: vec3u) -> vec3u {
    let brick = unpacked(packed);
    return brick * 8u + local + vec3u(0u, 0u, group.x % 2u * 4u);
}
