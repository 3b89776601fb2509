// Gradients for normals, from the gradient texture if there is one (volume/gradients.wgsl).
#import "density/gradient.wgsl"

// Takes gradients from the texture instead of computing them from the pyramid.
override GRADIENT_TEXTURE: bool = false;

// Gradient of the volume in index space.
fn volume_gradient(p: vec3f, level: f32) -> vec3f {
    if (GRADIENT_TEXTURE) {
        return stored_gradient(p, level);
    }
    return index_gradient(p, normal_level(level));
}
