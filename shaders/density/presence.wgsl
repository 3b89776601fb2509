// Where there is material at all: outside the grid is none, whatever the transfer function says. The field goes on
// there as it is at the border, and its material fades with the share of the kernel that lies on voxels.
#import "density/kernel.wgsl"

// Edges of the grid, in index space, lie half a voxel beyond its outermost voxels. Kernels reach so far to either side.
const EDGE_REACH = 1.5;

// What sums over the voxels that are there are divided by at least: below, so little is there that nobody sees it.
const LEAST_PRESENCE = 1e-4;

// The share of a kernel's weights that lies on voxels 0, 1, 2 …, where the kernel's middle is `depth` voxels inside
// the edge before voxel 0; symmetrical about ½ at the edge.
fn share_inside(depth: f32) -> f32 {
    let away = abs(depth);
    var share = 1.0;
    if (KERNEL == KERNEL_PREFILTERED) {
        // Linear between 11/12 on the outermost voxel and 1 on the next; and between 1/12 and 11/12 across the edge.
        share = min(0.5 + away * (5.0 / 6.0), min((away + 10.5) / 12.0, 1.0));
    } else if (away < EDGE_REACH) {
        // Between the last voxel that is missing and the first, or the first and the second.
        let is_inside = away >= 0.5;
        let weights = kernel_weights(select(away + 0.5, away - 0.5, is_inside));
        share = select(weights.z + weights.w, 1.0 - weights.x, is_inside);
    }
    return select(1.0 - share, share, depth >= 0.0);
}

// The share of a kernel around an index-space point that lies on the voxels of a grid, where it is `width` times as
// wide as on voxels.
fn presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = (p + 0.5) / width;
    let behind = (dims - 0.5 - p) / width;
    if (all(min(before, behind) >= vec3f(EDGE_REACH))) {
        return 1.0;
    }
    let shares = vec3f(
        share_inside(before.x) + share_inside(behind.x),
        share_inside(before.y) + share_inside(behind.y),
        share_inside(before.z) + share_inside(behind.z),
    ) - 1.0;
    return max(shares.x, 0.0) * max(shares.y, 0.0) * max(shares.z, 0.0);
}
