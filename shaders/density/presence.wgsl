// Where there is material at all: outside the grid is none, whatever the transfer function says. The field goes on
// there as it is at the border, and its material fades with the share of the kernel that lies on voxels. FACES: anything
// is shown so near the faces of the grid that its end there could be seen; all else does without, and compiles quicker.
// FACES > 1: some kernel may be cut by two opposite faces at once, so few voxels lie between them.
#import "density/kernel.wgsl"

// Edges of the grid, in index space, lie half a voxel beyond its outermost voxels. Kernels reach so far to either side.
const EDGE_REACH = 1.5;

// What sums over the voxels that are there are divided by at least: below, so little is there that nobody sees it.
const LEAST_PRESENCE = 1e-4;

#if FACES
// Along each axis the share of the prefiltered kernel that lies on voxels 0, 1, 2 …, where its middle is `depth` voxels
// inside the edge before voxel 0; symmetrical about ½ at the edge.
fn prefiltered_shares(depth: vec3f) -> vec3f {
    // From 1/12 to 11/12 between the voxels beside the edge, and on to 0 and 1 on the next: two slopes, 1/12 and what
    // 5/6 is more than that.
    return 0.5 + 0.75 * clamp(depth, vec3f(-0.5), vec3f(0.5))
        + clamp(depth, vec3f(-EDGE_REACH), vec3f(EDGE_REACH)) * (1.0 / 12.0);
}

// The same of the kernel at hand. Branches would spare software drivers nothing.
fn shares_inside(depth: vec3f) -> vec3f {
    if (KERNEL == KERNEL_PREFILTERED) {
        return prefiltered_shares(depth);
    }
    let away = abs(depth);
    var shares: vec3f;
    if (KERNEL == KERNEL_GAUSSIAN) {
        // Of the weights of the four voxels around its middle: between the last that is missing and the first, or the
        // first and the second.
        let is_inside = away >= vec3f(0.5);
        let f = fract(select(away + 0.5, away - 0.5, is_inside));
        let scale = -0.5 / (SIGMA * SIGMA);
        let w0 = exp((f + 1.0) * (f + 1.0) * scale);
        let w1 = exp(f * f * scale);
        let w2 = exp((1.0 - f) * (1.0 - f) * scale);
        let w3 = exp((2.0 - f) * (2.0 - f) * scale);
        let outside = select(w0 + w1, w0, is_inside);
        shares = select(vec3f(1.0), 1.0 - outside / (w0 + w1 + w2 + w3), away < vec3f(EDGE_REACH));
    } else {
        // What the B-spline has beyond the edge, by truncated powers.
        let outer = max(EDGE_REACH - away, vec3f(0.0));
        let inner = max(outer - 1.0, vec3f(0.0));
        shares = 1.0 - (outer * outer * outer - 3.0 * inner * inner * inner) / 6.0;
    }
    return select(1.0 - shares, shares, depth >= vec3f(0.0));
}

// The share of a kernel around an index-space point that lies on the voxels of a grid, where it is `width` times as
// wide as on voxels.
fn presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = p + 0.5;
    let behind = dims - 0.5 - p;
#if FACES > 1
    let shares = max(shares_inside(before / width) + shares_inside(behind / width) - 1.0, vec3f(0.0));
#else
    let shares = shares_inside(min(before, behind) / width);
#endif
    return shares.x * shares.y * shares.z;
}

// The same of the prefiltered kernel.
fn prefiltered_presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = p + 0.5;
    let behind = dims - 0.5 - p;
#if FACES > 1
    let shares = max(prefiltered_shares(before / width) + prefiltered_shares(behind / width) - 1.0, vec3f(0.0));
#else
    let shares = prefiltered_shares(min(before, behind) / width);
#endif
    return shares.x * shares.y * shares.z;
}
#endif
