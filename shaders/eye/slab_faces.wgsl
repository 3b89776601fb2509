// Slabs between two faces: the field is sampled at the faces that neighbouring slabs share, the light at those between
// segments of one or more slabs, and what a segment shows is integrated between them. Samples in the middle of slabs
// show as wood grain on steep surfaces, because the amount of opacity and of light that one sample stands for depends
// on where the surface cuts the slab.
#import "density/slab_material.wgsl"
#import "density/kernel_gradient.wgsl"
#import "common/slab_mean.wgsl"
#import "shading/shade.wgsl"

// Values of the field that material depends on: density, or a pre-classified material.
#if PRECLASSIFY
alias FaceValue = vec4f;
#else
alias FaceValue = f32;
#endif

// Face of a slab where a ray crosses it.
struct SlabFace {
    // Depth along the ray.
    depth: f32,
    value: FaceValue,
    presence: f32,
    integral: IntegralPlace,
}

#if PRECLASSIFY
fn density_of(value: FaceValue) -> f32 {
    return value.r;
}
#else
fn density_of(value: FaceValue) -> f32 {
    return value;
}
#endif

fn face_at(ray: Ray, depth: f32) -> SlabFace {
    let p = ray.origin + ray.direction * depth;
    let level = kernel_level(eye.frame, depth);
#if PRECLASSIFY
    let value = preclassified_at(p, level);
    return SlabFace(depth, value, 1.0, integral_place(value.r));
#else
    let density = field_at(p, level).density;
    return SlabFace(depth, density, presence_at(p, level), integral_place(density));
#endif
}

// Attenuation of the lights that cast shadows.
struct LightShares {
#if SHADOWED > 0
    light_0: Transmittance,
#else
    none: f32,
#endif
#if SHADOWED > 1
    light_1: Transmittance,
#endif
#if SHADOWED > 2
    light_2: Transmittance,
#endif
#if SHADOWED > 3
    light_3: Transmittance,
#endif
#if SHADOWED > 4
    light_4: Transmittance,
#endif
#if SHADOWED > 5
    light_5: Transmittance,
#endif
#if SHADOWED > 6
    light_6: Transmittance,
#endif
#if SHADOWED > 7
    light_7: Transmittance,
#endif
}

// Light at a face.
struct FaceLight {
    // Gradient in scene space, with that of faces of the grid and of cuts.
    slope: vec3f,
    shares: LightShares,
}

fn attenuation_of(index: u32, volume: texture_3d<f32>, surface: Surface) -> Transmittance {
    let light = eye.lights[index];
    return attenuation_at(light, volume, surface, light_above_surface(light, surface).towards);
}

fn face_light(ray: Ray, face: SlabFace) -> FaceLight {
    let p = ray.origin + ray.direction * face.depth;
    let level = kernel_level(eye.frame, face.depth);
    let field = Field(density_of(face.value));
    let gradient = gradient_to_scene(eye.space, gradient_at(p, level));
    let slope = gradient + face_slope(p, level, field, presence_gradient(p, level));
    var light: FaceLight;
    light.slope = slope;
    if (!COMBINED) {
        let surface = surface_of(VolumeSample(p, slope, field, level));
#if SHADOWED > 0
        light.shares.light_0 = attenuation_of(0u, attenuation_0, surface);
#endif
#if SHADOWED > 1
        light.shares.light_1 = attenuation_of(1u, attenuation_1, surface);
#endif
#if SHADOWED > 2
        light.shares.light_2 = attenuation_of(2u, attenuation_2, surface);
#endif
#if SHADOWED > 3
        light.shares.light_3 = attenuation_of(3u, attenuation_3, surface);
#endif
#if SHADOWED > 4
        light.shares.light_4 = attenuation_of(4u, attenuation_4, surface);
#endif
#if SHADOWED > 5
        light.shares.light_5 = attenuation_of(5u, attenuation_5, surface);
#endif
#if SHADOWED > 6
        light.shares.light_6 = attenuation_of(6u, attenuation_6, surface);
#endif
#if SHADOWED > 7
        light.shares.light_7 = attenuation_of(7u, attenuation_7, surface);
#endif
    }
    return light;
}

// Material of a segment, summed over the parts of its slabs front to back.
struct SlabSum {
    // Optical depth, and the opacity that it makes.
    depth: f32,
    opacity: f32,
    // Sums of the opacities of parts times their places along the ray, and times their values.
    places: f32,
    values: FaceValue,
}

// Opacity-weighted mean depth in homogeneous material of optical depth τ, relative to its thickness: 1/τ − 1/(e^τ −
// 1), within 0.011.
fn visible_place(tau: f32) -> f32 {
    return (6.0 + tau) / (12.0 + tau * (4.0 + tau));
}

fn with_part(sum: SlabSum, tau: f32, place: f32, length: f32, a: FaceValue, b: FaceValue) -> SlabSum {
    let depth = sum.depth + tau;
    let opacity = 1.0 - exp(-depth);
    let share = opacity - sum.opacity;
    let at = visible_place(tau);
    return SlabSum(depth, opacity, sum.places + share * (place + at * length), sum.values + share * mix(a, b, at));
}

// Adds the material between two faces, between which the field is linear; none of it if `share` is 0.
fn with_slab(sum: SlabSum, before: SlabFace, behind: SlabFace, obliquity: f32, share: f32) -> SlabSum {
    let length = share * (behind.depth - before.depth);
    let present = 0.5 * length * obliquity * (before.presence + behind.presence);
    let extinction = mean_extinction(before.integral, behind.integral);
    return with_part(sum, extinction * present, before.depth, length, before.value, behind.value);
}

// Attenuation below which a light is gone: between the faces of a segment it may still count, because light decreases
// exponentially between them.
const MIN_SHARE = 1e-12;

// Mean attenuation over the visible material of a segment of optical depth τ, of light that changes exponentially with
// the eye's optical depth, from a to b: with λ = ln(a/b) it is ∫ a e^(−t(1 + λ/τ)) dt / ∫ e^−t dt over 0 … τ,
// = a φ(τ + λ)/φ(τ), φ(x) = (1 − e^−x)/x; 1/φ(τ) is `depth_per_opacity`.
fn mean_attenuation(a: Transmittance, b: Transmittance, tau: f32, depth_per_opacity: f32) -> Transmittance {
    let near = max(a, Transmittance(MIN_SHARE));
    let far = max(b, Transmittance(MIN_SHARE));
    let x = tau + log(near / far);
#if COLORED
    let mean = vec3f(exponential_mean(x.r), exponential_mean(x.g), exponential_mean(x.b));
#else
    let mean = exponential_mean(x);
#endif
    return near * mean * depth_per_opacity;
}

// φ(x) = (1 − e^−x)/x for any x.
fn exponential_mean(x: f32) -> f32 {
    // The series avoids 0/0; at 0.05 its error is x⁴/120 = 5e-8.
    let is_small = abs(x) < 0.05;
    let series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
    return select((1.0 - exp(-x)) / select(x, 1.0, is_small), series, is_small);
}

fn slab_light(index: u32, surface: Surface, a: Transmittance, b: Transmittance, sum: SlabSum) -> ReflectedLight {
    let light = eye.lights[index];
    let attenuation = mean_attenuation(a, b, sum.depth, sum.depth / sum.opacity);
    return attenuated_light(light, surface, light_above_surface(light, surface), attenuation);
}

// Light from the material between two depths towards the eye.
fn shade_segment(ray: Ray, front: f32, back: f32, a: FaceLight, b: FaceLight, sum: SlabSum) -> vec3f {
    let depth = sum.places / sum.opacity;
    let value = sum.values / sum.opacity;
    let at = clamp((depth - front) / max(back - front, 1e-9), 0.0, 1.0);
    let p = ray.origin + ray.direction * depth;
#if PRECLASSIFY
    let material = material_of_preclassified(value).color;
#else
    let material = material_of(Field(value)).color;
#endif
    let field = Field(density_of(value));
    let slope = mix(a.slope, b.slope, at);
    let surface = surface_of(VolumeSample(p, slope, field, kernel_level(eye.frame, depth)));
    var lit = ReflectedLight(vec3f(0.0), vec3f(0.0));
    if (COMBINED) {
        lit = combined_light(p);
    } else {
#if SHADOWED > 0
        lit = add_light(lit, slab_light(0u, surface, a.shares.light_0, b.shares.light_0, sum));
#endif
#if SHADOWED > 1
        lit = add_light(lit, slab_light(1u, surface, a.shares.light_1, b.shares.light_1, sum));
#endif
#if SHADOWED > 2
        lit = add_light(lit, slab_light(2u, surface, a.shares.light_2, b.shares.light_2, sum));
#endif
#if SHADOWED > 3
        lit = add_light(lit, slab_light(3u, surface, a.shares.light_3, b.shares.light_3, sum));
#endif
#if SHADOWED > 4
        lit = add_light(lit, slab_light(4u, surface, a.shares.light_4, b.shares.light_4, sum));
#endif
#if SHADOWED > 5
        lit = add_light(lit, slab_light(5u, surface, a.shares.light_5, b.shares.light_5, sum));
#endif
#if SHADOWED > 6
        lit = add_light(lit, slab_light(6u, surface, a.shares.light_6, b.shares.light_6, sum));
#endif
#if SHADOWED > 7
        lit = add_light(lit, slab_light(7u, surface, a.shares.light_7, b.shares.light_7, sum));
#endif
    }
    return shade_surface(surface, lit, tinted(material, p, kernel_level(eye.frame, depth)));
}
