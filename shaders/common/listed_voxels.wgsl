// Light voxels of the list `bricks`, which the importing shader declares as an array<vec4u>: packed coordinates of a
// brick first, then the mask of its cells.
#import "common/listed_bricks.wgsl"

// Light voxel of an invocation in one of the first `count` bricks; out of range for invocations without one.
fn voxel_of_listed_brick(group: vec3u, local: vec3u, count: u32) -> vec3u {
    let listed = listed_brick(group);
    if (listed >= count) {
        return vec3u(~0u);
    }
    let brick = bricks[listed];
    return select(vec3u(~0u), voxel_in(brick.x, group, local), is_listed(brick, group, local));
}
