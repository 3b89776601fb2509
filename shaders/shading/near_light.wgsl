// Short rays from samples towards lights (P eq. 8 for the first voxels of the way), in front of what light volumes know.
#import "density/lighting_density.wgsl"
#import "density/table.wgsl"
#import "density/cut.wgsl"
#import "shading/shade.wgsl"

// Steps of the near field (src/model/settings/shadows.rs), or none. Towards lights that have a size they are fewer.
override NEAR_STEPS: u32 = 0u;

// Light as a ray finds it close by, and as its volume knows it from there on: a volume blurs what lies within a voxel
// or two, which is where a surface shades itself. The last step goes half a voxel of the light volume further, to where
// the trilinear fetch sees little of what the ray has met already; no piece of the way is left out. Every sample looks
// light up equally far away, so that light volumes hold no more than that takes (src/plan/geometry/ahead.rs).
fn near_light(light: Light, volume: texture_3d<f32>, surface: Surface, towards: Towards) -> Left {
    let forward = to_index(eye.space, towards.direction);
    var way = 0.0;
    var depth = Left(0.0);
    var step = 0u;
    loop {
        // Further steps are none: drivers unroll a loop whose end they know.
        let is_taken = select(0.0, 1.0, step < light.near_steps);
        let width =
            is_taken * near_width(step) * eye.near_edge + select(0.0, light.near_ahead, step + 1u == light.near_steps);
        let length = min(width, max(towards.distance - way, 0.0));
        let p = surface.point + forward * (way + 0.5 * length);
        let extinction = met_nearly(lighting_density(p, surface.level));
        depth += extinction * share_that_shades(eye.shading_cut, p) * lighting_presence(p, surface.level) * length;
        way += length;
        step += 1u;
        if (step >= NEAR_STEPS) {
            break;
        }
    }
    let end = surface.point + forward * way;
    return exp(-depth * light.extinction_scale) * looked_up(light, volume, end);
}

// What is left of a light that has a volume.
fn near_or_looked_up(light: Light, volume: texture_3d<f32>, surface: Surface, towards: Towards) -> Left {
#if NEAR_STEPS
    return near_light(light, volume, surface, towards);
#else
    return looked_up(light, volume, biased(surface, towards));
#endif
}
