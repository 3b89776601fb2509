// Near-field rays: short rays from samples towards lights (P eq. 8 for the first voxels), in front of the light
// volumes.
//
// Extinction is integrated between the ends of steps: at a surface that is opaque within a fraction of a voxel, the
// middle of a step is no measure of it. The ray begins with the density of the sample itself, or it would see another
// surface than the eye does; for the same reason the end of the first step has the kernel of the eye.
//
// The importing shader provides the field at a point with the kernel of the eye, as sharp_lighting_field().
#import "density/cut.wgsl"
#import "volume/material.wgsl"
#import "shading/shade.wgsl"

// Maximum number of near-field steps (crates/scene/src/settings/shadows.rs), or 0. Area lights take fewer.
override NEAR_STEPS: u32 = 0u;
#option NEAR_HALVES: the first step is divided into two, both with the kernel of the eye

// Lengths of the steps, in shortest edges of a voxel: ½ ½ 1 1 1 1 1. Longer ones would pass thin sheets.
fn near_step_length(step: u32) -> f32 {
    return select(1.0, 0.5, step < 2u);
}

// End of a step.
struct NearStepEnd {
    field: LightingField,
    presence: f32,
    integral: LightIntegralPlace,
}

fn near_step_end(field: LightingField, presence: f32) -> NearStepEnd {
    return NearStepEnd(field, presence, light_integral_place(field));
}

fn soft_step_end(p: vec3f, level: f32) -> NearStepEnd {
    return near_step_end(lighting_field(p, level), lighting_presence(p, level));
}

#if PRECLASSIFY
alias FieldNumber = Transmittance;

fn number_of(field: LightingField) -> FieldNumber {
    return field;
}

fn field_of(number: FieldNumber) -> LightingField {
    return number;
}
#else
alias FieldNumber = f32;

fn number_of(field: LightingField) -> FieldNumber {
    return field.density;
}

fn field_of(number: FieldNumber) -> LightingField {
    return Field(number);
}
#endif

// Mean of the straight line from the sample to the end of the step and of the parabola that also meets the end of the
// second, half way along the step: a surface bends more than the one and less than the other. The slope at the sample
// is no help, because stored gradients are differences over two voxels, 40 % too small at a sharp surface.
fn bend_of(own: FieldNumber, end: FieldNumber, behind: FieldNumber) -> FieldNumber {
    return 0.4375 * own + 0.625 * end - 0.0625 * behind;
}

// Value half way along the second of two steps, of the parabola through their ends; `ratio` is the length of the
// second relative to the first.
fn after_step(first: FieldNumber, second: FieldNumber, third: FieldNumber, ratio: f32) -> FieldNumber {
    let sum = 1.0 + ratio;
    let reach = 1.0 + 0.5 * ratio;
    return -0.25 * ratio * ratio / sum * first + 0.5 * reach * second + 0.5 * reach / sum * third;
}

// Optical depth of a step per length and unit density of the light, in two halves that meet at a value.
fn curved_step(begin: NearStepEnd, middle: FieldNumber, end: NearStepEnd) -> Transmittance {
    let half = light_integral_place(field_of(middle));
    return 0.25 * (begin.presence + end.presence)
        * (mean_light_extinction(begin.integral, half) + mean_light_extinction(half, end.integral));
}

// End within the first step, seen with the kernel of the eye.
fn sharp_step_end(p: vec3f, level: f32) -> NearStepEnd {
    return near_step_end(sharp_lighting_field(p, level), lighting_presence(p, level));
}

// Length of step `step`, 0 if the light takes fewer. The last step extends half a voxel of the light volume further,
// where the trilinear fetch contains little of the material that the ray has already passed.
fn taken_step_length(light: LightUniform, step: u32) -> f32 {
    let nominal = select(0.0, near_step_length(step) * eye.voxel_edge, step < light.near_steps);
    return nominal + select(0.0, light.last_step_extension, step + 1u == light.near_steps);
}

#if NEAR_HALVES
// Optical depth of the first step, from the sample to `end`, per unit density of the light, in two halves.
fn halved_step(surface: Surface, forward: vec3f, own: NearStepEnd, end: NearStepEnd, length: f32) -> Transmittance {
    let half = 0.5 * length;
    let between = sharp_step_end(surface.point + forward * half, surface.level);
    let middle = bend_of(number_of(own.field), number_of(between.field), number_of(end.field));
    let next = after_step(number_of(own.field), number_of(between.field), number_of(end.field), 1.0);
    return half * (curved_step(own, middle, between) + curved_step(between, next, end));
}
#endif

// Transmittance of a near-field ray, times the attenuation at its end: a light volume blurs what lies within a voxel
// or two, which is where a surface shadows itself. No part of the path is omitted. All samples look up light at the
// same distance, so that light volumes need no larger extent (crates/render/src/plan/geometry/near_field_cells.rs).
fn near_field_attenuation(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
    let forward = index_from_scene_vector(eye.space, towards.direction);
    let first = min(0.5 * eye.voxel_edge, towards.distance);
    var way = min(first + taken_step_length(light, 1u), towards.distance);
#if PRECLASSIFY
    let own = near_step_end(lighting_field(surface.point, surface.level), 1.0);
#else
    let own = near_step_end(Field(surface.density), lighting_presence(surface.point, surface.level));
#endif
    var begin = sharp_step_end(surface.point + forward * first, surface.level);
    var end = soft_step_end(surface.point + forward * way, surface.level);
#if NEAR_HALVES
    var depth = halved_step(surface, forward, own, begin, first);
#else
    let bend = bend_of(number_of(own.field), number_of(begin.field), number_of(end.field));
    var depth = first * curved_step(own, bend, begin);
#endif
    depth *= shading_fraction(eye.shading_cut, surface.point + forward * (0.5 * first));
    // Densities bend over lengths of a voxel; farther steps are too long for a parabola.
    let ratio = (way - first) / max(first, 1e-9);
    let bent = after_step(number_of(own.field), number_of(begin.field), number_of(end.field), ratio);
    var share = shading_fraction(eye.shading_cut, surface.point + forward * (0.5 * (first + way)));
    depth += share * (way - first) * curved_step(begin, bent, end);
    var step = 2u;
    loop {
        // Excess steps have length 0: drivers unroll a loop with a known end.
        let length = min(taken_step_length(light, step), max(towards.distance - way, 0.0));
        share = shading_fraction(eye.shading_cut, surface.point + forward * (way + 0.5 * length));
        way += length;
        begin = end;
        end = soft_step_end(surface.point + forward * way, surface.level);
        let present = 0.5 * (begin.presence + end.presence);
        depth += share * length * present * mean_light_extinction(begin.integral, end.integral);
        step += 1u;
        if (step >= NEAR_STEPS) {
            break;
        }
    }
    let last = surface.point + forward * way;
    return exp(-depth * light.extinction_scale) * lookup_attenuation(light, volume, last);
}

// Attenuation of a light that has a volume.
fn shadowed_light(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
#if NEAR_STEPS
    return near_field_attenuation(light, volume, surface, towards);
#else
    return lookup_attenuation(light, volume, biased_point(surface, towards));
#endif
}
