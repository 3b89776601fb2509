// Shading of samples: material, lights, and their attenuation (P eq. 2–5).
//
// The importing shader provides the attenuation of a shadowed light, as attenuation_at().
#import "volume/material.wgsl"
#import "shading/lights.wgsl"
#import "shading/sky_light.wgsl"
#import "shading/scattered_light.wgsl"
#import "common/space.wgsl"
#import "sheets/sheet_frame.wgsl"
#import "density/cut.wgsl"
#import "shading/light_volumes.wgsl"

struct EyeUniform {
    frame: SheetFrameUniform,
    shading: ShadingUniform,
    space: SpaceUniform,
    // Eye in scene space; w is 0 for an orthographic camera, for which it is the direction to the eye.
    eye: vec4f,
    // First row of this dispatch.
    first_row: u32,
    // End of the rows of this dispatch, exclusive.
    end_row: u32,
    // Distance from occupied bricks, in bricks, within which sums of scattered sheets are complete.
    dilation: i32,
    // Minimum transmittance, at which the ray ends.
    min_transmittance: f32,
    // Distances of gradients from sheets, in pixels and slabs to either side.
    gradient_pixels: i32,
    gradient_slabs: i32,
    // Number of interleaved runs of tile rows (sheets/tiles.wgsl).
    runs: u32,
    // Shortest edge of a voxel, in scene units; unit of the near-field steps.
    voxel_edge: f32,
    // Scale from index space to texture coordinates of the combined light volume.
    combined_lookup: vec3f,
    // Share of the visible light above which an adaptive slab is halved.
    max_undivided_share: f32,
    // Region that is visible.
    visible_cut: CutUniform,
    // Region that is visible, limited to the grid: the faces of solids.
    face_cut: CutUniform,
    // Region that attenuates light.
    shading_cut: CutUniform,
    sky: SkyUniform,
    scattered_light: ScatteredLightUniform,
    lights: array<LightUniform, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> bound_eye: EyeUniform;
var<private> eye: EyeUniform;

// Number of lights that are on; those with an attenuation volume come first.
override LIGHTS: u32 = 1u;
// Number of lights that cast shadows.
override SHADOWED: u32 = 1u;
// Set if the first volume holds the diffuse light of all shadowed lights, as colours (P §4).
override COMBINED: bool = false;

// Point where a sample's light is looked up: offset towards the light by the bias.
fn biased_point(surface: Surface, towards: LightDirection) -> vec3f {
    return surface.point + index_from_scene_vector(eye.space, towards.direction) * eye.shading.bias;
}

// Light above the horizon of the side of a surface to which opacity falls.
fn light_above_surface(light: LightUniform, surface: Surface) -> HorizonClip {
    let towards = to_light(light, surface.position);
    if (ONE_SIDED) {
        let outward = surface.normal * select(1.0, -1.0, surface.side < 0.0);
        return clip_to_horizon(light, towards, outward, surface.surfaceness * abs(surface.side) * (1.0 - light.two_sided));
    }
    let facing = dot(surface.normal, towards.direction);
    return HorizonClip(towards, facing, facing, 1.0);
}

// Attenuation of a light at an index-space point, from its volume.
fn lookup_attenuation(light: LightUniform, volume: texture_3d<f32>, p: vec3f) -> Transmittance {
    return stored_transmittance(textureSampleLevel(volume, clamped, (p + 0.5) * light.lookup, 0.0));
}

// Light of a shadowed light, with its attenuation.
fn attenuated_light(light: LightUniform, surface: Surface, risen: HorizonClip, attenuation: Transmittance) -> ReflectedLight {
    let share = apply_shadow_cures(eye.shading, attenuation);
    // With weaker shadows, light below the horizon counts in part.
    return reflect_light(eye.shading, light, surface, risen, share, 1.0 - eye.shading.strength);
}

fn light_from(index: u32, volume: texture_3d<f32>, surface: Surface) -> ReflectedLight {
    let light = eye.lights[index];
    let risen = light_above_surface(light, surface);
    return attenuated_light(light, surface, risen, attenuation_at(light, volume, surface, risen.towards));
}

fn add_light(a: ReflectedLight, b: ReflectedLight) -> ReflectedLight {
    return ReflectedLight(a.diffuse + b.diffuse, a.specular + b.specular);
}

// Sample of the volume.
struct VolumeSample {
    // Position in index space.
    point: vec3f,
    // Gradient in scene space.
    slope: vec3f,
    field: Field,
    // Pyramid level for the stretch of the sample's kernel.
    level: f32,
}

// Gradient, in scene space, of the faces of the visible region, including those of the grid: into the solid, in the
// direction in which density rises or, if opacity falls with density, against it. `rising` is the gradient of
// presence.
fn face_slope(p: vec3f, level: f32, field: Field, rising: vec3f) -> vec3f {
    let turned = select(1.0, -1.0, ONE_SIDED && side_of(field) < 0.0);
#if PRECLASSIFY
    // Pre-classified materials end with their voxels.
    let faces = face_gradient(eye.visible_cut, p, level);
#else
#if MISSING
    // Presence includes the faces of the grid.
    let faces = face_gradient(eye.visible_cut, p, level) + rising;
#else
    let faces = face_gradient(eye.face_cut, p, level);
#endif
#endif
    return turned * gradient_to_scene(eye.space, faces);
}

fn surface_of(found: VolumeSample) -> Surface {
    let p = found.point;
    let slope = found.slope;
    let steepness = length(slope);
    let s = eye.shading;
    let steep2 = steepness * steepness;
    let position = scene_from_index(eye.space, p);
    let away = eye.eye.xyz - position * eye.eye.w;
    return Surface(
        position,
        p,
        slope * (-1.0 / max(steepness, 1e-9)),
        steep2 / (steep2 + s.surface_gradient * s.surface_gradient),
        away * (1.0 / max(length(away), 1e-9)),
        select(1.0, side_of(found.field), ONE_SIDED),
        found.level,
        found.field.density,
    );
}

// Light of all lights that cast shadows.
fn shadowed_light_sum(surface: Surface) -> ReflectedLight {
    var lit = ReflectedLight(vec3f(0.0), vec3f(0.0));
#if SHADOWED > 0
    lit = add_light(lit, light_from(0u, attenuation_0, surface));
#endif
#if SHADOWED > 1
    lit = add_light(lit, light_from(1u, attenuation_1, surface));
#endif
#if SHADOWED > 2
    lit = add_light(lit, light_from(2u, attenuation_2, surface));
#endif
#if SHADOWED > 3
    lit = add_light(lit, light_from(3u, attenuation_3, surface));
#endif
#if SHADOWED > 4
    lit = add_light(lit, light_from(4u, attenuation_4, surface));
#endif
#if SHADOWED > 5
    lit = add_light(lit, light_from(5u, attenuation_5, surface));
#endif
#if SHADOWED > 6
    lit = add_light(lit, light_from(6u, attenuation_6, surface));
#endif
#if SHADOWED > 7
    lit = add_light(lit, light_from(7u, attenuation_7, surface));
#endif
    return lit;
}

// Point at a distance in front of a surface, on its lit side; the sample itself within homogeneous material. In index
// space.
fn point_in_front(surface: Surface, way: f32) -> vec3f {
    let turned = select(1.0, -1.0, ONE_SIDED && surface.side < 0.0);
    return surface.point + index_from_scene_vector(eye.space, surface.normal) * (turned * surface.surfaceness * way);
}

// Light of the sky at a sample, to be multiplied by its colour.
fn sky_light(surface: Surface) -> vec3f {
#if SKY
    return reflect_sky(eye.sky, surface, point_in_front(surface, eye.sky.lookup_distance), eye.shading.strength);
#else
    return vec3f(0.0);
#endif
}

#option BOUNCES: scattered light is looked up in a volume

#if BOUNCES
@group(2) @binding(9) var bounced_texture: texture_3d<f32>;
#endif

// Scattered light at a sample, to be multiplied by its colour.
fn scattered_light(surface: Surface) -> vec3f {
#if BOUNCES
    let bounces = eye.scattered_light;
    let place = (point_in_front(surface, bounces.lookup_distance) + 0.5) * bounces.lookup;
    return bounces.share * textureSampleLevel(bounced_texture, clamped, place, 0.0).rgb;
#else
    return vec3f(0.0);
#endif
}

// Light from a sample towards the eye.
fn shade(found: VolumeSample, material: vec3f) -> vec3f {
    let surface = surface_of(found);
    var lit: ReflectedLight;
    if (COMBINED) {
        lit = combined_light(found.point);
    } else {
        lit = shadowed_light_sum(surface);
    }
    return shade_surface(surface, lit, tinted(material, found.point, found.level));
}

// Diffuse light of all lights that cast shadows, from the combined volume.
fn combined_light(p: vec3f) -> ReflectedLight {
    return ReflectedLight(textureSampleLevel(attenuation_0, clamped, (p + 0.5) * eye.combined_lookup, 0.0).rgb, vec3f(0.0));
}

// Light from a surface towards the eye, with the light of those lights that cast shadows.
fn shade_surface(surface: Surface, shadowed: ReflectedLight, material: vec3f) -> vec3f {
    let s = eye.shading;
    var lit = shadowed;
    for (var i = SHADOWED; i < LIGHTS; i += 1u) {
        // Indexed in the uniform: copying an array that is indexed dynamically would keep it in memory.
        let light = bound_eye.lights[i];
        let risen = light_above_surface(light, surface);
        let share = cone_attenuation(light, risen.towards.direction);
        lit = add_light(lit, reflect_light(s, light, surface, risen, Transmittance(share), share));
    }
    let around = sky_light(surface) + scattered_light(surface);
    return material * (s.emission + s.ambient + around + s.diffuse * lit.diffuse) + s.specular * lit.specular;
}

// Gradient in scene space from differences of sheets: per pixel to the right, per pixel down and per unit of depth.
// If the columns of J are the displacements of the sample by these steps, it is J⁻ᵀ times the differences (the
// paper's [16], for any projection and voxel shape). Sheets lie across the line of sight, or across `axis` in index
// space if that is not zero.
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
