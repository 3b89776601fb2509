// Light of the sky (crates/scene/src/settings/light/sky.rs): radiance that is linear in the direction, times sky
// visibility.
#import "volume/field.wgsl"
#import "shading/lights.wgsl"
#import "shading/sky.wgsl"

// V₁ in rgb, V₀ in a: see sky/moments.wgsl.
@group(2) @binding(8) var sky_texture: texture_3d<f32>;

// Moments of sky visibility at an index-space point.
fn sky_moments(sky: SkyUniform, p: vec3f, strength: f32) -> vec4f {
#if SKY > 1
    let stored = textureSampleLevel(sky_texture, clamped, (p + 0.5) * sky.lookup, 0.0);
    return mix(vec4f(0.0, 0.0, 0.0, 1.0), stored, strength);
#else
    return vec4f(0.0, 0.0, 0.0, 1.0);
#endif
}

// Light of the sky in one colour: mean radiance for material without a surface, and the irradiance over π of surfaces
// that face along and against the normal. A₀ = l₀ V₀ + l₁ · V₁, A₁ = l₀ V₁ + l₁ V₀ / 3, E/π = A₀ ± 2 n · A₁.
fn sky_irradiance(color: vec4f, open: vec4f, normal: vec3f) -> vec3f {
    let mean = color.a * open.a + dot(color.rgb, open.rgb);
    let facing = 2.0 * dot(normal, color.a * open.rgb + color.rgb * (open.a / 3.0));
    return max(vec3f(mean, mean + facing, mean - facing), vec3f(0.0));
}

// Reflected light of the sky, to be multiplied by the colour.
fn reflect_sky(sky: SkyUniform, surface: Surface, p: vec3f, strength: f32) -> vec3f {
    let open = sky_moments(sky, p, strength);
    // Two-sided surfaces take the brighter side.
    let along = select(1.0, 0.5 + 0.5 * surface.side, ONE_SIDED);
    let shares = vec3f(1.0 - surface.surfaceness, surface.surfaceness * along, surface.surfaceness * (1.0 - along));
    let red = sky_irradiance(sky.red, open, surface.normal);
    let green = sky_irradiance(sky.green, open, surface.normal);
    let blue = sky_irradiance(sky.blue, open, surface.normal);
    if (ONE_SIDED) {
        return vec3f(dot(red, shares), dot(green, shares), dot(blue, shares));
    }
    let brighter = vec2f(shares.x, shares.y + shares.z);
    return vec3f(
        dot(vec2f(red.x, max(red.y, red.z)), brighter),
        dot(vec2f(green.x, max(green.y, green.z)), brighter),
        dot(vec2f(blue.x, max(blue.y, blue.z)), brighter),
    );
}
