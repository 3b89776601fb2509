// Gradients for normals, from the gradient texture if there is one (volume/gradients.wgsl).
#import "density/gradient.wgsl"

// Gradient of the volume in index space.
fn volume_gradient(p: vec3f, level: f32) -> vec3f {
#if PAGED
    return paged_gradient(p, level);
#else
    if (GRADIENT_TEXTURE) {
        return stored_gradient(p, level);
    }
    return index_gradient(p, normal_level(level));
#endif
}
