//! Light that arrives at a point: transmittances of single rays to every light and to the sky.

use glam::DVec3;

use super::rays::{LightSegment, VolumeRays};
use crate::plan::sweep_directions;
use chiaroscuro_scene::{BakedTransfer, LightGeometry, LitSides, SceneLight, Settings};
use chiaroscuro_volume::math::luminance;

/// Number of rays to the sky: a few milliseconds.
const SKY_DIRECTIONS: u32 = 48;

/// Maximum number of rays to each area light: losses are displayed in whole per cent.
const MAX_LIGHT_POINTS: u32 = 16;

/// Arriving part of a light at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightArrival {
    /// Transmittance of the material, 0 … 1; 1 for lights that cast no shadows.
    pub transmittance: f64,
    /// Share that the hood lets through, 0 … 1.
    pub hood: f64,
    /// Cosine between the surface's normal and the direction to the light, never negative if both sides are lit;
    /// `None` where there is no surface.
    pub facing: Option<f64>,
    /// Range of distances from the point, in scene units, in which most of the light from the light's centre is lost;
    /// `None` if hardly any is, or if the light casts no shadows.
    pub blocked: Option<[f64; 2]>,
}

/// Light that arrives at a point.
pub(super) struct ArrivingLight {
    /// Arriving part of every light of the settings.
    pub(super) lights: Vec<LightArrival>,
    /// Sky visibility, if there is a sky.
    pub(super) sky: Option<f64>,
}

impl ArrivingLight {
    /// Computes the light that a volume lets through to a point; `normal` is that of the surface there, or zero.
    pub(super) fn new(rays: &VolumeRays<'_>, settings: &Settings, point: DVec3, normal: DVec3) -> Self {
        let rays = &rays.of_light();
        let (scene, range) = (&rays.scene, rays.volume.table_range());
        let is_one_sided = settings.shading.sides == LitSides::One;
        let lighting = settings.bake_lighting(range, scene);
        let met_by_colors =
            settings.has_colored_shadows().then(|| [0, 1, 2].map(|color| lighting.for_light_color(color)));
        let shading_cut = settings.cuts.shadowing_part().region(scene);
        let sky = settings.sky.is_on().then(|| {
            if !settings.has_sky_volume() {
                return 1.0;
            }
            let left = |towards: DVec3| {
                let depth = rays.optical_depth(
                    &lighting,
                    &shading_cut,
                    LightSegment { point, towards, distance: f64::INFINITY },
                );
                (-depth * settings.sky.density_scale).exp()
            };
            // For a surface, sky visibility over the hemisphere that it faces, weighted by the cosine.
            let facing =
                |towards: DVec3| if normal == DVec3::ZERO { 1.0 } else { normal.dot(towards).max(0.0) };
            let directions = sweep_directions(SKY_DIRECTIONS);
            let open: f64 = directions.iter().map(|&towards| facing(towards) * left(towards)).sum();
            open / directions.into_iter().map(facing).sum::<f64>().max(1e-9)
        });
        let lights = settings
            .lights
            .iter()
            .map(|light| {
                let light = light.resolve(&settings.camera);
                let is_shadowed = light.needs_volume() && settings.shadows.algorithm.is_on();
                // The mean over points of an area light.
                let points = light.sample_lights(settings.shadows.area.samples.min(MAX_LIGHT_POINTS));
                let mean = |of: &dyn Fn(&SceneLight) -> f64| {
                    points.iter().map(of).sum::<f64>() / points.len() as f64
                };
                let left = |light: &SceneLight| {
                    let way = segment_to_light(light, point);
                    let of_color = |table: &BakedTransfer| {
                        let depth = rays.optical_depth(table, &shading_cut, way);
                        (-depth * light.density_scale).exp()
                    };
                    match &met_by_colors {
                        Some(tables) => luminance(tables.each_ref().map(of_color)),
                        None => of_color(&lighting),
                    }
                };
                let through_hood = |light: &SceneLight| {
                    let cone = light.cone();
                    cone.attenuation(cone.axis.dot(-segment_to_light(light, point).towards))
                };
                let middle = segment_to_light(&light, point);
                let blocked =
                    is_shadowed.then(|| rays.blocked_range(&lighting, &shading_cut, middle)).flatten();
                // For an area light, the part above the surface's horizon.
                let risen = light.above_horizon(point, normal, 1.0);
                let facing = if is_one_sided && light.casts_shadows {
                    risen.mean_cosine
                } else {
                    risen.centre_cosine.abs()
                };
                LightArrival {
                    transmittance: if is_shadowed { mean(&left) } else { 1.0 },
                    hood: mean(&through_hood),
                    facing: (normal != DVec3::ZERO).then_some(facing),
                    blocked,
                }
            })
            .collect();
        Self { lights, sky }
    }

    /// Dims the light by what another volume lets through.
    pub(super) fn dim_by(&mut self, other: &Self) {
        for (own, other) in self.lights.iter_mut().zip(&other.lights) {
            if other.transmittance < own.transmittance {
                own.blocked = other.blocked;
            }
            own.transmittance *= other.transmittance;
        }
        self.sky = self.sky.zip(other.sky).map(|(own, other)| own * other);
    }
}

/// Returns the segment from a point to a light.
fn segment_to_light(light: &SceneLight, point: DVec3) -> LightSegment {
    let distance = match light.kind {
        LightGeometry::Parallel => f64::INFINITY,
        LightGeometry::Perspective => DVec3::from(light.position).distance(point),
    };
    LightSegment { point, towards: light.direction_from(point), distance }
}
