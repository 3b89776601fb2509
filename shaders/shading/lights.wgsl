// Phong's illumination with attenuated light (P eq. 2–4).
#import "common/left.wgsl"

const MAX_LIGHTS = 8;

struct Light {
    // Unit direction towards a parallel light, or the position of a perspective one; scene space.
    place: vec3f,
    // 0: parallel, 1: perspective.
    perspective: f32,
    // Linear colour × intensity.
    color: vec3f,
    // Multiplies the extinction that this light meets.
    extinction_scale: f32,
    // Index space to texture coordinates of that volume: (p + ½) × lookup.
    lookup: vec3f,
    // Of the hood: cosines of the angles up to which it shines fully, and from which it does not.
    hood_inner: f32,
    // From the light to what it shines at; a unit vector.
    hood_axis: vec3f,
    hood_outer: f32,
    // By how much the last step of rays nearby is longer: half a voxel of its volume, in scene units.
    near_ahead: f32,
    // Of a light that has a size (src/model/settings/light/area.rs): point lights that stand for it, or 1 …
    points: u32,
    // … 1: a disc, 2: a rectangle, 3: a ball …
    shape: u32,
    // … how many steps rays nearby take towards it …
    near_steps: u32,
    // … and from its middle to its borders: to the right, up, and towards the volume. Around the place, or of a parallel
    // light around its direction.
    area_right: vec3f,
    // 1: surfaces take its diffuse light from both sides.
    two_sided: f32,
    area_up: vec3f,
    pad0: f32,
    area_near: vec3f,
    pad1: f32,
}

// The golden ratio less one.
const GOLDEN_SHARE = 0.618034;

// Point number `index` of `count` on a disc of radius 1, in rings.
fn on_rings(index: u32, count: u32) -> vec2f {
    let all = f32(count);
    let rings = max(floor(sqrt(all) / 2.0 + 0.5), 1.0);
    let each = all / (rings * rings);
    var ring = 1.0;
    var first = 0.0;
    var end = floor(each + 0.5);
    while (f32(index) >= end) {
        ring += 1.0;
        first = end;
        end = floor(each * ring * ring + 0.5);
    }
    let turn = 6.2831853 * (f32(index) - first + 0.5 * ring) / (end - first);
    return vec2f(cos(turn), sin(turn)) * sqrt((first + end) / (2.0 * all));
}

// A light's point number `index`, as a light of its own.
fn point_of(light: Light, index: u32) -> Light {
    var one = light;
    if (light.points > 1u) {
        let number = f32(index);
        let at = (number + 0.5) / f32(light.points);
        let spread = fract(number * GOLDEN_SHARE + 0.5);
        let disc = on_rings(index, light.points);
        let across = select(disc, vec2f(2.0 * at, 2.0 * spread) - 1.0, light.shape == 2u);
        let deep = sqrt(1.0 - dot(disc, disc)) * sin(3.1415927 * (spread - 0.5));
        let place = light.place + light.area_right * across.x + light.area_up * across.y + light.area_near * deep;
        one.place = select(normalize(place), place, light.perspective > 0.5);
        one.hood_axis = -normalize(place);
    }
    return one;
}

struct Towards {
    // Unit vector to the light.
    direction: vec3f,
    // To the light; of a parallel one, beyond all material.
    distance: f32,
    // One over the length of the light's place as seen from there.
    per_length: f32,
}

fn to_light(light: Light, position: vec3f) -> Towards {
    let away = light.place - position * light.perspective;
    let distance = length(away);
    let per_length = 1.0 / max(distance, 1e-9);
    return Towards(away * per_length, select(1e6, distance, light.perspective > 0.5), per_length);
}

// The square of the sine of half the width of a light as it is seen from somewhere; 0 of a point.
fn width_seen(light: Light, towards: Towards) -> f32 {
    let mean_square = 0.5 * (dot(light.area_right, light.area_right) + dot(light.area_up, light.area_up));
    let tangent = mean_square * towards.per_length * towards.per_length;
    return tangent / (1.0 + tangent);
}

// Of a disc of radius 1 whose middle stands at a height above the horizon, from −1 to 1: the share that has risen, and how
// high the middle of that stands.
fn risen_disc(height: f32) -> vec2f {
    // Just below, f32 has too few digits for what is left; the middle of a thin segment stands at 2/5 of its height.
    let u = clamp(height, -0.98, 1.0);
    let quarter = 1.5707963 + asin(u);
    let root = sqrt(1.0 - u * u);
    let share = quarter + u * root;
    let moment = u * quarter + root * (2.0 + u * u) / 3.0;
    let low = max(1.0 + height, 0.0);
    let share_of_all = select(share / 3.1415927, 0.0, height <= -1.0);
    return vec2f(share_of_all, select(moment / share, 0.4 * low, height < -0.98));
}

// A light as a plane sees it.
struct Risen {
    // Towards the middle of what stands above the plane's horizon.
    towards: Towards,
    // Cosine between the plane's normal and the direction to the light's own middle …
    middle: f32,
    // … and the mean of those to all that stands above.
    facing: f32,
    // The share of the light that does. Light that comes past the plane is no more than that.
    share: f32,
}

// `weight`: how much of a surface the plane is, which turns the direction.
fn risen_above(light: Light, towards: Towards, normal: vec3f, weight: f32) -> Risen {
    let half_width = sqrt(width_seen(light, towards));
    let facing = dot(normal, towards.direction);
    // One point that stands for all is risen or not.
    if (light.points == 1u || half_width <= max(facing, 0.0)) {
        return Risen(towards, facing, facing, 1.0);
    }
    let height = facing / half_width;
    let disc = risen_disc(height);
    // Where nothing has risen there is nothing to turn to; it turns back by and by.
    let up = select(disc.y - height, max(2.0 + height, 0.0), height < -1.0) * half_width * weight;
    let direction = normalize(towards.direction + normal * up);
    let turned = Towards(direction, towards.distance, towards.per_length);
    return Risen(turned, facing, disc.y * half_width, disc.x);
}

// What a hood leaves of the light in a direction: 3t² − 2t³ across the rim.
fn hood_share(light: Light, to_light: vec3f) -> f32 {
    return smoothstep(light.hood_outer, light.hood_inner, -dot(light.hood_axis, to_light));
}

struct Shading {
    emission: f32,
    ambient: f32,
    diffuse: f32,
    specular: f32,
    shininess: f32,
    // Gradient per scene unit at which a sample counts half as a surface.
    surface_gradient: f32,
    strength: f32,
    ambient_offset: f32,
    gain: f32,
    // Length of the step towards the light before looking up its attenuation, in scene units.
    bias: f32,
    // Distance between the samples of a ray to a light, in scene units.
    ray_step: f32,
    // Optical depth at which it ends.
    dark_depth: f32,
    // Of light that matter without a surface scatters, the mean cosine of the angle by which it turns.
    anisotropy: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}

// What is lit: a sample of the volume.
struct Surface {
    // In scene space …
    position: vec3f,
    // … and in index space.
    point: vec3f,
    normal: vec3f,
    // How much of a surface it is: 0 amid homogeneous material, 1 at a boundary.
    surfaceness: f32,
    // Unit vector to the eye.
    to_eye: vec3f,
    // 1 where opacity falls along the normal, −1 where it falls against it, and between them amid a change.
    side: f32,
    // Of the pyramid, as stretched as the kernel of the sample.
    level: f32,
}

// Lights that cast shadows light the side of a surface to which opacity falls, and highlights lie there, too.
override ONE_SIDED: bool = false;

// Widths of the steps towards a light, in smallest edges of voxels: ½ ½ 1 1 1½ 1½ 2.
fn near_width(step: u32) -> f32 {
    return 0.5 * f32(1u + (step >> 1u));
}

struct Lit {
    diffuse: vec3f,
    specular: vec3f,
}

// Attenuated light as it reaches the sample, after the cures for darkness (P §4).
fn received(shading: Shading, attenuation: Left) -> Left {
    let light = min(shading.gain * attenuation + shading.ambient_offset, Left(1.0));
    return 1.0 - shading.strength * (1.0 - light);
}

// What matter without a surface scatters of light towards the eye, over the mean of all directions: Henyey and Greenstein's
// phase function times 4π, (1 − g²) / (1 + g² − 2 g cos θ)^(3/2).
fn scattered_share(shading: Shading, surface: Surface, to_light: vec3f) -> f32 {
#if ANISOTROPIC
    let g = shading.anisotropy;
    // Light that goes on as it came turns by nothing.
    let cosine = -dot(to_light, surface.to_eye);
    let span = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (span * sqrt(span));
#else
    return 1.0;
#endif
}

// What of a light diffuse reflection gives back of which a share arrives, without what has not risen, of which `unmissed`
// counts as if it had; and `amid` of it where there is no surface.
fn diffuse_share(light: Light, surface: Surface, risen: Risen, share: Left, unmissed: f32, amid: f32) -> Left {
    var reflected = share * abs(risen.middle);
    if (ONE_SIDED) {
        let outer = 0.5 + 0.5 * abs(surface.side);
        let arriving = share - unmissed * (1.0 - risen.share);
        let outward = arriving * (outer * max(risen.facing, 0.0)) + share * ((1.0 - outer) * max(-risen.middle, 0.0));
        reflected = mix(outward, reflected, light.two_sided);
    }
    return mix(share * amid, reflected, surface.surfaceness);
}

// What one light adds of which a given share arrives, and of which highlights show the width. `unmissed`: what counts of
// that share that has not risen.
//
// A highlight (N·H)^n is about a Gaussian of variance 1/n; light from an even disc of radius s moves H by half of what it
// moves itself, which adds s²/16 to that, and the highlight is weaker as it is wider.
fn reflect_light(shading: Shading, light: Light, surface: Surface, risen: Risen, share: Left, unmissed: f32) -> Lit {
    let to_light = risen.towards.direction;
    // Highlights have one side: that to which density falls, or opacity.
    let turned = select(1.0, -1.0, ONE_SIDED && surface.side < 0.0);
    let clear = select(1.0, abs(surface.side), ONE_SIDED);
    let amid = scattered_share(shading, surface, to_light);
    let diffuse = light.color * diffuse_share(light, surface, risen, share, unmissed, amid);
    let half_vector = to_light + surface.to_eye;
    // pow(0, x) is spared: some drivers make it NaN.
    let aligned = max(turned * dot(surface.normal, half_vector) / max(length(half_vector), 1e-6), 1e-6);
    let width = width_seen(light, risen.towards);
    let wider = 1.0 / (1.0 + shading.shininess * width / 16.0);
    let mirrored = pow(aligned, shading.shininess * wider) * wider;
    let is_before = turned * dot(surface.normal, to_light) > 0.0;
    let highlight = select(0.0, mirrored, is_before) * surface.surfaceness * clear;
    return Lit(diffuse, light.color * share * highlight);
}
