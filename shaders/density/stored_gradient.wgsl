// Normals from the volume, from a texture of gradients where there is one (volume/gradients.wgsl).
#import "density/gradient.wgsl"

@group(0) @binding(6) var gradients: texture_3d<f32>;

// Take gradients from there instead of from the pyramid itself.
override GRADIENT_TEXTURE: bool = false;

// The gradient of the volume in index space.
fn volume_slope(p: vec3f, level: f32) -> vec3f {
    if (GRADIENT_TEXTURE) {
        return textureSampleLevel(gradients, clamped, (p + 4.5) * grid.pyramid_scale, level).xyz;
    }
    return index_gradient(p, level_of_normals(level));
}
