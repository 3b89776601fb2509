// Presence: the fraction of a kernel that lies on voxels of the grid. Outside the grid there is no material, whatever
// the transfer function: density continues there with its border value, and extinction fades with presence.
#import "density/boundaries.wgsl"
#import "density/kernel.wgsl"

// Reach of the kernels on either side of the grid's edges, which lie half a voxel outside its outermost voxels (index
// space).
const EDGE_REACH = 1.5;

// Lower bound for the presence by which sums are divided; with less presence nothing is visible.
const MIN_PRESENCE = 1e-4;

#if FACES
// Presence of the prefiltered kernel along each axis, for voxels 0, 1, 2 …, with its centre `depth` voxels inside the
// edge before voxel 0; antisymmetric about ½ at the edge.
fn prefiltered_axis_presence(depth: vec3f) -> vec3f {
    // Linear from 1/12 to 11/12 between the voxels beside the edge, and on to 0 and 1 at the next ones: a slope of
    // 1/12, plus the remainder to 5/6 in the middle.
    return 0.5 + 0.75 * clamp(depth, vec3f(-0.5), vec3f(0.5))
        + clamp(depth, vec3f(-EDGE_REACH), vec3f(EDGE_REACH)) * (1.0 / 12.0);
}

// Presence of the current kernel along each axis. Branches would not save software drivers anything.
fn axis_presence(depth: vec3f) -> vec3f {
    if (KERNEL == KERNEL_PREFILTERED) {
        return prefiltered_axis_presence(depth);
    }
    let away = abs(depth);
    var shares: vec3f;
    if (KERNEL == KERNEL_GAUSSIAN) {
        // Weights of the four voxels around the kernel's centre, which lies between the last missing voxel and the
        // first, or between the first and the second.
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
        // Integral of the B-spline beyond the edge, by truncated powers.
        let outer = max(EDGE_REACH - away, vec3f(0.0));
        let inner = max(outer - 1.0, vec3f(0.0));
        shares = 1.0 - (outer * outer * outer - 3.0 * inner * inner * inner) / 6.0;
    }
    return select(1.0 - shares, shares, depth >= vec3f(0.0));
}

// Presence of a kernel around an index-space point, stretched `width` times.
fn grid_presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = p + 0.5;
    let behind = dims - 0.5 - p;
#if FACES > 1
    let shares = max(axis_presence(before / width) + axis_presence(behind / width) - 1.0, vec3f(0.0));
#else
    let shares = axis_presence(min(before, behind) / width);
#endif
    return shares.x * shares.y * shares.z;
}

// Presence of the prefiltered kernel around an index-space point, stretched `width` times.
fn prefiltered_presence(p: vec3f, dims: vec3f, width: f32) -> f32 {
    let before = p + 0.5;
    let behind = dims - 0.5 - p;
#if FACES > 1
    let shares = max(prefiltered_axis_presence(before / width) + prefiltered_axis_presence(behind / width) - 1.0, vec3f(0.0));
#else
    let shares = prefiltered_axis_presence(min(before, behind) / width);
#endif
    return shares.x * shares.y * shares.z;
}
#endif
