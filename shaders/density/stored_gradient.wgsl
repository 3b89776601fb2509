// Gradients for normals, from the gradient texture if there is one (volume/gradients.wgsl).
#import "density/gradient.wgsl"

@group(0) @binding(6) var gradients: texture_3d<f32>;

// Takes gradients from the texture instead of computing them from the pyramid.
override GRADIENT_TEXTURE: bool = false;

// Gradient of the volume in index space.
fn volume_gradient(p: vec3f, level: f32) -> vec3f {
    if (GRADIENT_TEXTURE) {
        return textureSampleLevel(gradients, clamped, (p + 4.5) * grid.pyramid_scale, level).xyz;
    }
    return index_gradient(p, normal_level(level));
}
