// Gradients of the prefiltered density, for normals.
#import "volume/field.wgsl"

// Gradient, in index space, of the density as the B-spline reconstructs it: differences of the prefiltered density at
// ± one and ± two voxels of a pyramid level, weighted to be exact for polynomials up to the fourth order. The
// remaining blur is that of the prefilter and of linear interpolation, together as wide as the B-spline; plain
// central differences are twice as wide.
//
// Between two levels the step is interpolated, while the gradient texture interpolates the results of both levels:
// nearly the same, at half the fetches.
fn index_gradient(p: vec3f, level: f32) -> vec3f {
    let h = exp2(level);
    return vec3f(
        derivative_along(p, vec3f(h, 0.0, 0.0), level),
        derivative_along(p, vec3f(0.0, h, 0.0), level),
        derivative_along(p, vec3f(0.0, 0.0, h), level),
    ) / h;
}

// Pyramid level of the normals for kernels stretched to `level`. Labels change abruptly between voxels,
// and look like stairs from nearby; a kernel twice as wide smooths their slope.
fn normal_level(level: f32) -> f32 {
#if PRECLASSIFY
    return min(level + 1.0, MAX_STRETCH_LEVEL);
#else
    return level;
#endif
}

// Derivative of the density along `step`, per step.
fn derivative_along(p: vec3f, step: vec3f, level: f32) -> f32 {
    let near = pyramid_density(p + step, level) - pyramid_density(p - step, level);
    let far = pyramid_density(p + 2.0 * step, level) - pyramid_density(p - 2.0 * step, level);
    return (8.0 * near - far) / 12.0;
}
