// Reconstruction kernels: weights of the four neighbours along an axis, and values at any distance.
const KERNEL_BSPLINE = 0u;
const KERNEL_GAUSSIAN = 1u;
const KERNEL_PREFILTERED = 2u;

override KERNEL: u32 = 0u;
// Standard deviation of the Gaussian, in voxels.
override SIGMA: f32 = 0.6;

// Quadrature points per slab: 1 in the middle, or 2 by Gauss–Legendre, whose mean is the paper's h̄.
override QUADRATURE: u32 = 1u;

// Weights of the neighbours at −1, 0, 1, 2 for a point at fraction f in [0, 1); they sum to 1.
fn kernel_weights(f: f32) -> vec4f {
    if (KERNEL == KERNEL_GAUSSIAN) {
        let distance = vec4f(f + 1.0, f, 1.0 - f, 2.0 - f);
        let weights = exp(distance * distance * (-0.5 / (SIGMA * SIGMA)));
        return weights / dot(weights, vec4f(1.0));
    }
    // Cubic B-spline: (1−f)³/6, 2/3 − f²(2−f)/2, and their mirror images.
    let g = 1.0 - f;
    let sixths = vec4f(g * g * g, 4.0 - 3.0 * f * f * (2.0 - f), 4.0 - 3.0 * g * g * (2.0 - g), f * f * f);
    return sixths * (1.0 / 6.0);
}

// Radius of the kernel, in units of its width.
fn kernel_radius() -> f32 {
    return select(2.0, 1.0, KERNEL == KERNEL_PREFILTERED);
}

// Kernel value at a distance in units of its width; unnormalised, since sums are normalised.
fn kernel_at(distance: f32) -> f32 {
    let d = abs(distance);
    if (KERNEL == KERNEL_PREFILTERED) {
        return max(1.0 - d, 0.0);
    }
    if (KERNEL == KERNEL_GAUSSIAN) {
        return select(0.0, exp(d * d * (-0.5 / (SIGMA * SIGMA))), d < 2.0);
    }
    let outer = max(2.0 - d, 0.0);
    return select(outer * outer * outer / 6.0, 2.0 / 3.0 - 0.5 * d * d * (2.0 - d), d < 1.0);
}
