// Integrated shadow ray: ray marching from a point of the volume towards a light (P eq. 7 and 8), with extinction
// integrated between the ends of steps instead of taken in their middle, as between the faces of slabs
// (eye/slab_faces.wgsl).
#import "common/transmittance.wgsl"
#import "density/cut.wgsl"
#import "shading/shadow_ray.wgsl"
#import "volume/material.wgsl"

// Next step, from `first` on, with an end in a cell that may attenuate light. `walk` counts ends in place of slabs.
fn next_attenuating_step(walk: CellRay, first: i32, last: i32) -> i32 {
    return max(next_attenuating_slab(walk, first, last) - 1, first);
}

// Field of light at an end of a step.
fn ray_field(p: vec3f) -> LightingField {
#if PRECLASSIFY
    return lighting_field(p, 0.0);
#else
    return field_at(p, 0.0);
#endif
}

// Presence for ray_field().
fn ray_presence(p: vec3f) -> f32 {
#if PRECLASSIFY
    return 1.0;
#else
    return lighting_presence_at(p, 0.0);
#endif
}

// Transmittance from the point p to `reach` scene units along `direction`, a unit vector of the scene given in index
// space. Extinction is multiplied by `scale` and limited to `cut`; the ray ends at the optical depth `dark`.
fn integrated_ray(
    p: vec3f,
    direction: vec3f,
    reach: f32,
    ray_step: f32,
    scale: f32,
    dark: f32,
    cut: CutUniform,
) -> Transmittance {
    // The ray as a stack of sheets: the ends of its steps are the middles of the slabs.
    var frame: SheetFrameUniform;
    frame.first_depth = -0.5 * ray_step;
    frame.slab = ray_step;
    frame.voxel_edge = 1.0;
    frame.slab_count = u32(clamp(reach / ray_step + 1.0, 0.0, 65535.0));
    let ray = Ray(p, direction, 1.0);
    let inside = slabs_within(frame, span_within(cut, ray), slabs_inside(frame, ray));
    let walk = cell_ray(frame, ray);
    // Steps begin at end k; the last may be shorter.
    var k = next_attenuating_step(walk, inside.x, inside.y);
    var is_known = false;
    var before = light_integral_place(ray_field(p));
    var presence = 0.0;
    var depth = Transmittance(0.0);
    loop {
        if (k > inside.y) {
            break;
        }
        let number = select(k, k + 1, is_known);
        let at = p + direction * min(f32(number) * ray_step, reach);
        let found = light_integral_place(ray_field(at));
        let there = ray_presence(at);
        if (is_known) {
            let length = min(ray_step, reach - f32(k) * ray_step);
            let share = shading_fraction(cut, at - direction * (0.5 * length)) * 0.5 * (presence + there);
            depth += mean_light_extinction(before, found) * share * max(length, 0.0) * scale;
            let next = next_attenuating_step(walk, k + 1, inside.y);
            is_known = next == k + 1;
            k = next;
        } else {
            is_known = true;
        }
        before = found;
        presence = there;
        if (min_component(depth) > dark || k > inside.y) {
            break;
        }
    }
    return exp(-depth);
}
