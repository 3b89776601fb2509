// Where there is material at all: outside the grid is none, whatever the transfer function says. The field goes on
// there as it is at the border, and its material fades with the share of the kernel that lies on voxels.
#import "density/kernel.wgsl"

// Edges of the grid, in index space, lie half a voxel beyond its outermost voxels. Kernels reach so far to either side.
const EDGE_REACH = 1.5;

// What sums over the voxels that are there are divided by at least: below, so little is there that nobody sees it.
const LEAST_PRESENCE = 1e-4;

// Along each axis the share of a kernel's weights that lies on voxels 0, 1, 2 …, where the kernel's middle is `depth`
// voxels inside the edge before voxel 0; symmetrical about ½ at the edge. Branches would spare software drivers nothing.
fn shares_inside(depth: vec3f) -> vec3f {
    let away = abs(depth);
    var shares: vec3f;
    if (KERNEL == KERNEL_PREFILTERED) {
        // Linear between 11/12 on the outermost voxel and 1 on the next; and between 1/12 and 11/12 across the edge.
        shares = min(0.5 + away * (5.0 / 6.0), min((away + 10.5) / 12.0, vec3f(1.0)));
    } else if (KERNEL == KERNEL_GAUSSIAN) {
        shares = vec3f(gaussian_share(away.x), gaussian_share(away.y), gaussian_share(away.z));
    } else {
        // What the B-spline has beyond the edge, by truncated powers.
        let outer = max(EDGE_REACH - away, vec3f(0.0));
        let inner = max(outer - 1.0, vec3f(0.0));
        shares = 1.0 - (outer * outer * outer - 3.0 * inner * inner * inner) / 6.0;
    }
    return select(1.0 - shares, shares, depth >= vec3f(0.0));
}

// The same of a Gaussian, inside the edge: of the weights of the four voxels around its middle.
fn gaussian_share(away: f32) -> f32 {
    // Between the last voxel that is missing and the first, or the first and the second.
    let is_inside = away >= 0.5;
    let weights = kernel_weights(fract(select(away + 0.5, away - 0.5, is_inside)));
    let share = select(weights.z + weights.w, 1.0 - weights.x, is_inside);
    return select(1.0, share, away < EDGE_REACH);
}

// The share of a kernel around an index-space point that lies on the voxels of a grid, where it is `width` times as
// wide as on voxels.
fn presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = (p + 0.5) / width;
    let behind = (dims - 0.5 - p) / width;
    let shares = max(shares_inside(before) + shares_inside(behind) - 1.0, vec3f(0.0));
    return shares.x * shares.y * shares.z;
}
