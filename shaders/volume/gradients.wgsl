// Gradients of a pyramid level at its texels, so that one fetch replaces twelve: differences between neighbours and
// linear interpolation between texels commute.
#import "volume/field.wgsl"
#import "volume/levels.wgsl"

@group(0) @binding(4) var gradient_level: texture_storage_3d<rgba16float, write>;

fn value(texel: vec3i) -> f32 {
    return source_texel(clamp(texel, vec3i(0), vec3i(source_size()) - 1)).r;
}

// Derivative of the density per texel (density/gradient.wgsl).
fn derivative_along(texel: vec3i, step: vec3i) -> f32 {
    let near = value(texel + step) - value(texel - step);
    let far = value(texel + 2 * step) - value(texel - 2 * step);
    return (8.0 * near - far) / 12.0;
}

@compute @workgroup_size(8, 8, 4)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    resample = bound_resample;
    let texel = level_texel(group, local);
    if (any(texel >= textureDimensions(gradient_level))) {
        return;
    }
    let at = vec3i(texel);
    let slopes = vec3f(
        derivative_along(at, vec3i(1, 0, 0)),
        derivative_along(at, vec3i(0, 1, 0)),
        derivative_along(at, vec3i(0, 0, 1)),
    );
    // Texels of the level are `spacing` voxels apart.
    textureStore(gradient_level, texel, vec4f(slopes / resample.spacing, 0.0));
}
