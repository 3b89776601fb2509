// What the picture's samples look like: material, lights, and what of them arrives (P eq. 2–5).
//
// The shader that imports this says what is left of a shadowed light, by attenuation_at().
#import "density/table.wgsl"
#import "density/volume.wgsl"
#import "shading/lights.wgsl"
#import "shading/sky_light.wgsl"
#import "shading/bounces.wgsl"
#import "common/space.wgsl"
#import "sheets/sheet_frame.wgsl"
#import "density/cut.wgsl"
#import "shading/light_volumes.wgsl"

struct Eye {
    frame: SheetFrame,
    shading: Shading,
    space: Space,
    // The eye in scene space; w is 0 for an orthographic camera, whose eye is the direction to it.
    eye: vec4f,
    // Rows of this dispatch start here.
    first_row: u32,
    // One beyond the last row of this dispatch.
    end_row: u32,
    // Of scattered sheets: bricks beyond an occupied one in which sums are complete.
    dilation: i32,
    // The ray ends when less than this is left of its transmittance.
    dark: f32,
    // Gradients from sheets are differences between so many pixels and slabs to either side.
    gradient_pixels: i32,
    gradient_slabs: i32,
    // Runs of rows of tiles (sheets/tiles.wgsl).
    runs: u32,
    // Smallest edge of a voxel, in scene units: the widths of the near field are in these.
    near_edge: f32,
    // Index space to texture coordinates of the volume into which lights have been combined.
    combined_lookup: vec3f,
    pad0: f32,
    // What is seen.
    seen: Cut,
    // The same within the grid: where solids end.
    faces: Cut,
    // What attenuates light.
    shading_cut: Cut,
    sky: Sky,
    bounces: Bounces,
    lights: array<Light, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> bound_eye: Eye;
var<private> eye: Eye;

// Lights that are on; those with an attenuation volume come first.
override LIGHTS: u32 = 1u;
// How many of them have one, or would have.
override SHADOWED: u32 = 1u;
// The diffuse light of those that have one is in the first volume, as colours (P §4).
override COMBINED: bool = false;

// Where the light of a sample is looked up: the bias nearer to the source.
fn biased(surface: Surface, towards: Towards) -> vec3f {
    return surface.point + to_index(eye.space, towards.direction) * eye.shading.bias;
}

// A light as the side of a surface sees it to which opacity falls.
fn seen_by(light: Light, surface: Surface) -> Risen {
    let towards = to_light(light, surface.position);
    if (ONE_SIDED) {
        let outward = surface.normal * select(1.0, -1.0, surface.side < 0.0);
        return risen_above(light, towards, outward, surface.surfaceness * abs(surface.side) * (1.0 - light.two_sided));
    }
    let facing = dot(surface.normal, towards.direction);
    return Risen(towards, facing, facing, 1.0);
}

// What its light volume says of a light at an index-space point.
fn looked_up(light: Light, volume: texture_3d<f32>, p: vec3f) -> Left {
    return stored_left(textureSampleLevel(volume, clamped, (p + 0.5) * light.lookup, 0.0));
}

fn lit_by(index: u32, volume: texture_3d<f32>, surface: Surface) -> Lit {
    let light = eye.lights[index];
    let risen = seen_by(light, surface);
    let share = received(eye.shading, attenuation_at(light, volume, surface, risen.towards));
    // Without shadows nothing keeps away what has not risen.
    return reflect_light(eye.shading, light, surface, risen, share, 1.0 - eye.shading.strength);
}

fn add(a: Lit, b: Lit) -> Lit {
    return Lit(a.diffuse + b.diffuse, a.specular + b.specular);
}

// A sample of the volume.
struct Sampled {
    // In index space.
    point: vec3f,
    // Gradient in scene space.
    slope: vec3f,
    density: f32,
    // Of the pyramid, as stretched as its kernel.
    level: f32,
}

// To which side of a surface opacity falls; of voxels that were classified, whose densities are opacities, away from them.
fn side_at(density: f32) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
    return side_of(density);
#endif
}

// The gradient, in scene space, that faces of what is seen have of their own, the grid's included: into the solid that
// ends there, in which opacity rises, as density does or against it. `rising` is how presence rises there.
fn face_slope(p: vec3f, level: f32, density: f32, rising: vec3f) -> vec3f {
    let turned = select(1.0, -1.0, ONE_SIDED && side_at(density) < 0.0);
#if PRECLASSIFY
    // What voxels mean ends with them by itself.
    let faces = face_gradient(eye.seen, p, level);
#else
#if MISSING
    // Beyond the grid, too, nothing is there.
    let faces = face_gradient(eye.seen, p, level) + rising;
#else
    let faces = face_gradient(eye.faces, p, level);
#endif
#endif
    return turned * gradient_to_scene(eye.space, faces);
}

fn surface_of(found: Sampled) -> Surface {
    let p = found.point;
    let slope = found.slope;
    let steepness = length(slope);
    let s = eye.shading;
    let steep2 = steepness * steepness;
    let position = place_of(eye.space, p);
    let away = eye.eye.xyz - position * eye.eye.w;
    return Surface(
        position,
        p,
        slope * (-1.0 / max(steepness, 1e-9)),
        steep2 / (steep2 + s.surface_gradient * s.surface_gradient),
        away * (1.0 / max(length(away), 1e-9)),
        select(1.0, side_at(found.density), ONE_SIDED),
        found.level,
    );
}

// The light of all lights that material attenuates.
fn lit_through_material(surface: Surface) -> Lit {
    var lit = Lit(vec3f(0.0), vec3f(0.0));
#if SHADOWED > 0
    lit = add(lit, lit_by(0u, attenuation_0, surface));
#endif
#if SHADOWED > 1
    lit = add(lit, lit_by(1u, attenuation_1, surface));
#endif
#if SHADOWED > 2
    lit = add(lit, lit_by(2u, attenuation_2, surface));
#endif
#if SHADOWED > 3
    lit = add(lit, lit_by(3u, attenuation_3, surface));
#endif
#if SHADOWED > 4
    lit = add(lit, lit_by(4u, attenuation_4, surface));
#endif
#if SHADOWED > 5
    lit = add(lit, lit_by(5u, attenuation_5, surface));
#endif
#if SHADOWED > 6
    lit = add(lit, lit_by(6u, attenuation_6, surface));
#endif
#if SHADOWED > 7
    lit = add(lit, lit_by(7u, attenuation_7, surface));
#endif
    return lit;
}

// Some way in front of a surface, on the side from which light comes; amid matter, the sample itself. In index space.
fn in_front(surface: Surface, way: f32) -> vec3f {
    let turned = select(1.0, -1.0, ONE_SIDED && surface.side < 0.0);
    return surface.point + to_index(eye.space, surface.normal) * (turned * surface.surfaceness * way);
}

// The light of the sky on a sample, as a share of its colour.
fn lit_by_sky(surface: Surface) -> vec3f {
#if SKY
    return reflect_sky(eye.sky, surface, in_front(surface, eye.sky.ahead), eye.shading.strength);
#else
    return vec3f(0.0);
#endif
}

#if BOUNCES
@group(2) @binding(9) var bounced_texture: texture_3d<f32>;
#endif

// The light on a sample that material has scattered before, as a share of its colour.
fn lit_by_bounces(surface: Surface) -> vec3f {
#if BOUNCES
    let bounces = eye.bounces;
    let place = (in_front(surface, bounces.ahead) + 0.5) * bounces.lookup;
    return bounces.share * textureSampleLevel(bounced_texture, clamped, place, 0.0).rgb;
#else
    return vec3f(0.0);
#endif
}

// The light from a sample.
fn shade(found: Sampled, material: vec3f) -> vec3f {
    let s = eye.shading;
    let p = found.point;
    let surface = surface_of(found);
    var lit: Lit;
    if (COMBINED) {
        lit = Lit(textureSampleLevel(attenuation_0, clamped, (p + 0.5) * eye.combined_lookup, 0.0).rgb, vec3f(0.0));
    } else {
        lit = lit_through_material(surface);
    }
    for (var i = SHADOWED; i < LIGHTS; i += 1u) {
        // Not from the copy: an index that varies would keep that as an array in memory.
        let light = bound_eye.lights[i];
        let risen = seen_by(light, surface);
        let share = hood_share(light, risen.towards.direction);
        lit = add(lit, reflect_light(s, light, surface, risen, Left(share), share));
    }
    let around = lit_by_sky(surface) + lit_by_bounces(surface);
    return material * (s.emission + s.ambient + around + s.diffuse * lit.diffuse) + s.specular * lit.specular;
}

// The gradient in scene space from differences of the sheets: per pixel to the right, per pixel down
// and per unit of depth. With the columns of J what a step of each kind moves the sample, it is J⁻ᵀ of
// the differences (the paper's [16], for any projection and voxel shape). Sheets lie across the line of
// sight, or across an axis of index space if it is not zero.
fn gradient_of_sheets(pixel: vec2f, depth: f32, differences: vec3f, axis: vec3f) -> vec3f {
    let frame = eye.frame;
    let forward = ray_of(frame, pixel).direction;
    let speed = dot(axis, forward);
    let back = select(vec3f(0.0), forward / speed, speed != 0.0);
    let right_across = frame.origin_di + depth * frame.direction_di;
    let down_across = frame.origin_dj + depth * frame.direction_dj;
    let right = right_across - back * dot(axis, right_across);
    let down = down_across - back * dot(axis, down_across);
    let volume = dot(right, cross(down, forward));
    let gradient = (cross(down, forward) * differences.x + cross(forward, right) * differences.y
        + cross(right, down) * differences.z) / volume;
    return gradient_to_scene(eye.space, gradient);
}
