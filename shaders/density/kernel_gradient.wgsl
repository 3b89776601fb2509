// Gradients for normals: analytic gradient of the kernel, or the stored one.
#import "density/stored_gradient.wgsl"

#option KERNEL_GRADIENTS: gradients are those of the kernel

// Derivatives of the cubic B-spline's weights with respect to f (kernel.wgsl); they sum to 0.
fn kernel_derivatives(f: f32) -> vec4f {
    let g = 1.0 - f;
    return vec4f(-0.5 * g * g, f * (1.5 * f - 2.0), g * (2.0 - 1.5 * g), 0.5 * f * f);
}

// Gradient, in index space, of the B-spline reconstruction.
fn gradient_by_kernel(p: vec3f) -> vec3f {
    let cell = floor(p);
    let f = p - cell;
    let wx = kernel_weights(f.x);
    let wy = kernel_weights(f.y);
    let wz = kernel_weights(f.z);
    return vec3f(
        weighted_sum(cell, kernel_derivatives(f.x), wy, wz),
        weighted_sum(cell, wx, kernel_derivatives(f.y), wz),
        weighted_sum(cell, wx, wy, kernel_derivatives(f.z)),
    );
}

// Gradient of the reconstruction with the kernel stretched to a pyramid level, as for densities.
fn stretched_gradient(p: vec3f, level: f32) -> vec3f {
    if (!STRETCH) {
        return gradient_by_kernel(p);
    }
    let blurred = volume_gradient(p, max(level, 1.0));
    if (level >= 1.0) {
        return blurred;
    }
    return mix(gradient_by_kernel(p), blurred, level);
}

// Gradient of the volume in index space.
fn gradient_at(p: vec3f, level: f32) -> vec3f {
#if KERNEL_GRADIENTS
    return stretched_gradient(p, level);
#else
    return volume_gradient(p, level);
#endif
}
