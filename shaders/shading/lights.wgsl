// Phong's illumination model with attenuated light (P eq. 2–4).
#import "common/transmittance.wgsl"
#import "shading/point_weights.wgsl"

const MAX_LIGHTS = 8;

struct LightUniform {
    // Unit direction towards a parallel light, or position of a perspective one, in scene space.
    position_or_direction: vec3f,
    // 0: parallel, 1: perspective.
    perspective: f32,
    // Linear colour × intensity.
    color: vec3f,
    // Factor applied to extinction for this light.
    extinction_scale: f32,
    // Scale from index space to texture coordinates of its volume: (p + ½) × lookup.
    lookup: vec3f,
    // Cosine of the cone's inner angle, up to which the light is full; hood_outer is where it ends.
    cone_cos_inner: f32,
    // Axis of the cone, a unit vector from the light towards its target.
    cone_axis: vec3f,
    cone_cos_outer: f32,
    // Additional length of the last near-field step: half a voxel of the light volume, in scene units.
    last_step_extension: f32,
    // Number of points on an area light (crates/scene/src/settings/light/area_light.rs), or 1.
    points: u32,
    // Shape of the area light: 1 disc, 2 rectangle, 3 ball.
    shape: u32,
    // Number of near-field steps towards the light.
    near_steps: u32,
    // Vectors from the centre of the area light to its borders: right, up, and towards the volume. Relative to the
    // place, or for a parallel light to its direction.
    area_right: vec3f,
    // 1 if surfaces take its diffuse light on both sides.
    two_sided: f32,
    area_up: vec3f,
    pad0: f32,
    area_near: vec3f,
    pad1: f32,
}

// Step and start of the fractions that place the orbits of a ball's points along their chords
// (crates/scene/src/settings/light/area_light.rs).
const DEPTH_STEP = 0.68;
const DEPTH_START = 0.4;
// Number of points up to which those of a disc are a single orbit.
const MAX_SINGLE_ORBIT = 8u;

// Point `index` of `count` on a disc of radius 1, arranged in rings of fours, in xy; in z the number of its orbit, which
// it has in common with its mirror images.
fn point_on_disc(index: u32, count: u32) -> vec3f {
    if (count < 2u) {
        return vec3f(0.0);
    }
    let all = f32(count);
    let rings = max(floor(sqrt(all) / 2.0 + 0.5), 1.0);
    let each = all / (4.0 * rings * rings);
    var ring = 1.0;
    var first = 0.0;
    var end = 4.0 * floor(each + 0.5);
    while (f32(index) >= end) {
        ring += 1.0;
        first = end;
        end = 4.0 * floor(each * ring * ring + 0.5);
    }
    let half_steps = 2.0 * (f32(index) - first) + ring;
    let quarter = 0.5 * (end - first);
    let within = half_steps - quarter * floor(half_steps / quarter);
    let orbit = first / 4.0 + floor(min(within, quarter - within) / 2.0);
    let turn = 3.1415927 * half_steps / (end - first);
    return vec3f(vec2f(cos(turn), sin(turn)) * sqrt((first + end) / (2.0 * all)), orbit);
}

// Point `index` of `count` on a rectangle of half-edges 1: points of Hammersley in a quarter of it, and their mirror
// images at both axes.
fn point_on_rectangle(index: u32, count: u32) -> vec2f {
    if (count < 2u) {
        return vec2f(0.0);
    }
    let place = index / 4u;
    let number = count / 4u;
    // Number of bits of the places: 0 for a single one.
    let bits = select(32u - countLeadingZeros(number - 1u), 0u, number == 1u);
    let reversed = f32(reverseBits(place)) / 4294967296.0 + 0.5 / f32(1u << bits);
    let corner = vec2f((f32(place) + 0.5) / f32(number), reversed);
    return corner * (1.0 - 2.0 * vec2f(f32(index & 1u), f32(index >> 1u & 1u)));
}

// Factors that move points of a wide flat light towards its middle, so that a surface facing it takes the same light
// from each (crates/scene/src/settings/light/area_light.rs).
fn closer_to_middle(light: LightUniform, at: vec2f) -> vec2f {
    let squares = vec2f(dot(light.area_right, light.area_right), dot(light.area_up, light.area_up));
    let tangents = squares / dot(light.position_or_direction, light.position_or_direction);
    let inner = 1.0 - select(vec2f(dot(at, at)), at * at, light.shape == 2u);
    return select(inverseSqrt(1.0 + inner * tangents), vec2f(1.0), light.shape == 3u);
}

// Point `index` of an area light, as a point light.
fn area_light_point(light: LightUniform, index: u32) -> LightUniform {
    var one = light;
    if (light.points > 1u) {
        let in_ring = point_on_disc(index, light.points);
        let disc = in_ring.xy;
        let spread = select(fract(in_ring.z * DEPTH_STEP + DEPTH_START), 0.5, light.points <= MAX_SINGLE_ORBIT);
        let even = select(disc, point_on_rectangle(index, light.points), light.shape == 2u);
        let across = even * closer_to_middle(light, even);
        let deep = sqrt(1.0 - dot(disc, disc)) * sin(3.1415927 * (spread - 0.5));
        let place = light.position_or_direction + light.area_right * across.x + light.area_up * across.y + light.area_near * deep;
        one.position_or_direction = select(normalize(place), place, light.perspective > 0.5);
        one.cone_axis = -normalize(place);
    }
    return one;
}

struct LightDirection {
    // Unit vector to the light.
    direction: vec3f,
    // Distance to the light; for a parallel one, beyond all material.
    distance: f32,
    // One over the distance to the light's place, also for parallel lights.
    per_length: f32,
}

fn to_light(light: LightUniform, position: vec3f) -> LightDirection {
    let away = light.position_or_direction - position * light.perspective;
    let distance = length(away);
    let per_length = 1.0 / max(distance, 1e-9);
    return LightDirection(away * per_length, select(1e6, distance, light.perspective > 0.5), per_length);
}

// Change of the weights of a light's points on a surface (shading/point_weights.wgsl), relative to unit directions.
fn point_slope(light: LightUniform, position: vec3f, normal: vec3f, share: f32) -> vec3f {
    let towards = light.position_or_direction - position * light.perspective;
    return weight_slope(towards, light.area_right, light.area_up, normal, share) * length(towards);
}

// Weight of a point in a direction, for a slope that is 0 along the direction to the centre.
fn point_weight(slope: vec3f, centre: vec3f, direction: vec3f) -> f32 {
    return max(1.0 + dot(slope, direction) / max(dot(centre, direction), 0.1), 0.0);
}

// Squared sine of half the angular width of a light; 0 for a point light.
fn angular_width(light: LightUniform, towards: LightDirection) -> f32 {
    let mean_square = 0.5 * (dot(light.area_right, light.area_right) + dot(light.area_up, light.area_up));
    let tangent = mean_square * towards.per_length * towards.per_length;
    return tangent / (1.0 + tangent);
}

// Part of a disc of radius 1 above the horizon, for a centre at a height from −1 to 1: fraction of its area, and
// height of the centroid.
fn disc_above_horizon(height: f32) -> vec2f {
    // Below −0.98, f32 lacks the precision for the remainder; the centroid of a thin segment is at 2/5 of its height.
    let u = clamp(height, -0.98, 1.0);
    let quarter = 1.5707963 + asin(u);
    let root = sqrt(1.0 - u * u);
    let share = quarter + u * root;
    let moment = u * quarter + root * (2.0 + u * u) / 3.0;
    let low = max(1.0 + height, 0.0);
    let share_of_all = select(share / 3.1415927, 0.0, height <= -1.0);
    return vec2f(share_of_all, select(moment / share, 0.4 * low, height < -0.98));
}

// Part of a light above the horizon of a surface.
struct HorizonClip {
    // Direction to the centroid of the part above the horizon.
    towards: LightDirection,
    // Cosine between the surface normal and the direction to the light's centre.
    middle: f32,
    // Mean cosine over the part above the horizon.
    facing: f32,
    // Fraction of the light above the horizon, which bounds the light that can arrive.
    share: f32,
}

// Computes the part of a light above the horizon; `weight` is the surfaceness, which scales the turn of the
// direction.
fn clip_to_horizon(light: LightUniform, towards: LightDirection, normal: vec3f, weight: f32) -> HorizonClip {
    let half_width = sqrt(angular_width(light, towards));
    let facing = dot(normal, towards.direction);
    // A single point is either above the horizon or below.
    if (light.points == 1u || half_width <= max(facing, 0.0)) {
        return HorizonClip(towards, facing, facing, 1.0);
    }
    let height = facing / half_width;
    let disc = disc_above_horizon(height);
    // With nothing above the horizon there is no centroid; the direction returns gradually to the centre.
    let up = select(disc.y - height, max(2.0 + height, 0.0), height < -1.0) * half_width * weight;
    let direction = normalize(towards.direction + normal * up);
    let turned = LightDirection(direction, towards.distance, towards.per_length);
    return HorizonClip(turned, facing, disc.y * half_width, disc.x);
}

// Smooth step across the rim of the light's cone: 3t² − 2t³.
fn cone_attenuation(light: LightUniform, to_light: vec3f) -> f32 {
    return smoothstep(light.cone_cos_outer, light.cone_cos_inner, -dot(light.cone_axis, to_light));
}

struct ShadingUniform {
    emission: f32,
    ambient: f32,
    diffuse: f32,
    specular: f32,
    shininess: f32,
    // Gradient per scene unit at which the surfaceness is one half.
    surface_gradient: f32,
    strength: f32,
    ambient_offset: f32,
    gain: f32,
    // Offset towards the light of the attenuation look-up, in scene units.
    bias: f32,
    // Distance between the samples of a ray to a light, in scene units.
    ray_step: f32,
    // Optical depth at which a ray to a light ends.
    max_optical_depth: f32,
    // Mean cosine of the scattering angle in material without a surface.
    anisotropy: f32,
    // Share of a light's intensity that material without a surface scatters in each direction on average: ¼ if light
    // bounces, E/4π of the E/π that a white surface returns which faces the light; else 1.
    amid: f32,
    // Length to which opacities refer, in scene units.
    opacity_unit: f32,
    pad0: f32,
}

// Sample of the volume that is lit.
struct Surface {
    // Position in scene space.
    position: vec3f,
    // Position in index space.
    point: vec3f,
    normal: vec3f,
    // Surfaceness: 0 within homogeneous material, 1 at a boundary.
    surfaceness: f32,
    // Unit vector to the eye.
    to_eye: vec3f,
    // 1 where opacity falls along the normal, −1 where it rises; in between where it changes over.
    side: f32,
    // Pyramid level for the stretch of the sample's kernel.
    level: f32,
    // Density at the point, where near-field rays begin.
    density: f32,
}

// Shadowed lights light only the side of a surface to which opacity falls; highlights appear on that side, too.
override ONE_SIDED: bool = false;

struct ReflectedLight {
    diffuse: vec3f,
    specular: vec3f,
}

// Attenuated light at the sample, after the cures for darkness (P §4).
fn apply_shadow_cures(shading: ShadingUniform, attenuation: Transmittance) -> Transmittance {
    let light = min(shading.gain * attenuation + shading.ambient_offset, Transmittance(1.0));
    return 1.0 - shading.strength * (1.0 - light);
}

#option ANISOTROPIC: more light is scattered forward, or back

// Phase function of material without a surface, relative to isotropic scattering: that of Henyey and Greenstein times
// 4π, (1 − g²) / (1 + g² − 2 g cos θ)^(3/2).
fn relative_phase_function(shading: ShadingUniform, surface: Surface, to_light: vec3f) -> f32 {
#if ANISOTROPIC
    let g = shading.anisotropy;
    // The scattering angle is 0 for light that continues in its direction.
    let cosine = -dot(to_light, surface.to_eye);
    let span = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (span * sqrt(span));
#else
    return 1.0;
#endif
}

// Diffusely reflected fraction of a light of which `share` arrives. The part below the horizon is subtracted;
// `unmissed` is the part of the light that counts even if it is below. `amid` is the factor for material without a
// surface.
fn diffuse_reflectance(light: LightUniform, surface: Surface, risen: HorizonClip, share: Transmittance, unmissed: f32, amid: f32) -> Transmittance {
    var reflected = share * abs(risen.middle);
    if (ONE_SIDED) {
        let outer = 0.5 + 0.5 * abs(surface.side);
        let arriving = share - unmissed * (1.0 - risen.share);
        let outward = arriving * (outer * max(risen.facing, 0.0)) + share * ((1.0 - outer) * max(-risen.middle, 0.0));
        reflected = mix(outward, reflected, light.two_sided);
    }
    return mix(share * amid, reflected, surface.surfaceness);
}

// Diffuse and specular light of one light of which `share` arrives; highlights show its angular width. `unmissed` is
// the part of the light that counts even if it is below the horizon.
//
// A highlight (N·H)^n is approximately a Gaussian of variance 1/n. Light from a uniform disc of radius s moves H by
// half its own deflection, which adds s²/16 to the variance, and the highlight dims as it widens.
fn reflect_light(shading: ShadingUniform, light: LightUniform, surface: Surface, risen: HorizonClip, share: Transmittance, unmissed: f32) -> ReflectedLight {
    let to_light = risen.towards.direction;
    // Highlights are one-sided: on the side to which density falls, or opacity if ONE_SIDED.
    let turned = select(1.0, -1.0, ONE_SIDED && surface.side < 0.0);
    let clear = select(1.0, abs(surface.side), ONE_SIDED);
    let amid = shading.amid * relative_phase_function(shading, surface, to_light);
    let diffuse = light.color * diffuse_reflectance(light, surface, risen, share, unmissed, amid);
    let half_vector = to_light + surface.to_eye;
    // Avoids pow(0, x), which is NaN on some drivers.
    let aligned = max(turned * dot(surface.normal, half_vector) / max(length(half_vector), 1e-6), 1e-6);
    let width = angular_width(light, risen.towards);
    let wider = 1.0 / (1.0 + shading.shininess * width / 16.0);
    let mirrored = pow(aligned, shading.shininess * wider) * wider;
    let is_before = turned * dot(surface.normal, to_light) > 0.0;
    let highlight = select(0.0, mirrored, is_before) * surface.surfaceness * clear;
    return ReflectedLight(diffuse, light.color * share * highlight);
}
