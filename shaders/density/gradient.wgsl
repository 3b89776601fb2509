// Normals from the volume.
#import "density/volume.wgsl"

// How steeply the density that the B-spline reconstructs rises, in index space: differences of the prefiltered density
// at ± one and ± two voxels of a level of the pyramid, weighed so that they are right for curves up to the fourth order.
// What blurs then is the prefilter and linear interpolation, which together are as wide as the B-spline; plain central
// differences are twice as wide.
//
// Between two levels the steps are between theirs, where the texture of gradients interpolates between what both say:
// nearly the same, at half the fetches.
fn index_gradient(p: vec3f, level: f32) -> vec3f {
    let h = exp2(level);
    return vec3f(
        slope_along(p, vec3f(h, 0.0, 0.0), level),
        slope_along(p, vec3f(0.0, h, 0.0), level),
        slope_along(p, vec3f(0.0, 0.0, h), level),
    ) / h;
}

// The level of the pyramid from which normals are taken where kernels are stretched to a level. PRECLASSIFY: labels are
// there or not from one voxel to the next, and look like stairs from close by; twice as wide a kernel sees their slope.
fn level_of_normals(level: f32) -> f32 {
#if PRECLASSIFY
    return min(level + 1.0, MAX_STRETCH_LEVEL);
#else
    return level;
#endif
}

// Change of the density per step.
fn slope_along(p: vec3f, step: vec3f, level: f32) -> f32 {
    let near = pyramid(p + step, level) - pyramid(p - step, level);
    let far = pyramid(p + 2.0 * step, level) - pyramid(p - 2.0 * step, level);
    return (8.0 * near - far) / 12.0;
}
