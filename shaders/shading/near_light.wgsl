// Near-field rays: short rays from samples towards lights (P eq. 8 for the first voxels), in front of the light
// volumes.
#import "density/cut.wgsl"
#import "volume/material.wgsl"
#import "shading/shade.wgsl"

// Maximum number of near-field steps (crates/scene/src/settings/shadows.rs), or 0. Area lights take fewer.
override NEAR_STEPS: u32 = 0u;

// Transmittance of a near-field ray, times the attenuation at its end: a light volume blurs what lies within a voxel
// or two, which is where a surface shadows itself. The last step extends half a voxel of the light volume further,
// where the trilinear fetch contains little of the material that the ray has already passed; no part of the path is
// omitted. All samples look up light at the same distance, so that light volumes need no larger extent
// (crates/render/src/plan/geometry/near_field_cells.rs).
fn near_field_attenuation(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
    let forward = index_from_scene_vector(eye.space, towards.direction);
    var way = 0.0;
    var depth = Transmittance(0.0);
    var step = 0u;
    loop {
        // Excess steps have length 0: drivers unroll a loop with a known end.
        let is_taken = select(0.0, 1.0, step < light.near_steps);
        let width =
            is_taken * near_step_length(step) * eye.voxel_edge + select(0.0, light.last_step_extension, step + 1u == light.near_steps);
        let length = min(width, max(towards.distance - way, 0.0));
        let p = surface.point + forward * (way + 0.5 * length);
        let extinction = nearest_lighting_extinction(lighting_field(p, surface.level));
        depth += extinction * shading_fraction(eye.shading_cut, p) * lighting_presence(p, surface.level) * length;
        way += length;
        step += 1u;
        if (step >= NEAR_STEPS) {
            break;
        }
    }
    let end = surface.point + forward * way;
    return exp(-depth * light.extinction_scale) * lookup_attenuation(light, volume, end);
}

// Attenuation of a light that has a volume.
fn shadowed_light(light: LightUniform, volume: texture_3d<f32>, surface: Surface, towards: LightDirection) -> Transmittance {
#if NEAR_STEPS
    return near_field_attenuation(light, volume, surface, towards);
#else
    return lookup_attenuation(light, volume, biased_point(surface, towards));
#endif
}
