//! Floor pass: rays from the eye that meet the floor, and rays from there to the lights.

use glam::DVec3;
use rayon::prelude::*;

use super::shadow_ray::ShadowRays;
use super::{Reference, linear_from_srgb};
use chiaroscuro_render::plan::SweepFrame;
use chiaroscuro_scene::{Projection, SceneLight, ShadowAlgorithm};

impl Reference<'_> {
    /// Renders the floor without what is in front of it: linear, premultiplied RGBA, row by row from the top left.
    pub fn floor(&self, size: [u32; 2]) -> Vec<[f64; 4]> {
        let settings = self.settings;
        let shadows = &settings.shadows;
        let attenuates = settings.shadows.algorithm != ShadowAlgorithm::Off;
        let scene_lights: Vec<_> = (0..settings.lights.len())
            .filter(|&index| settings.lights[index].on)
            .map(|index| {
                let rays = attenuates && settings.lights[index].needs_volume();
                (
                    self.light(index),
                    rays.then(|| ShadowRays::new(self, index, shadows.kernel, shadows.quadrature)),
                )
            })
            .collect();
        let sky = self.sky_rays();
        let [width, height] = size.map(f64::from);
        let camera = &settings.camera;
        let pixel = |at: u32| {
            let (i, j) = (f64::from(at % size[0]) + 0.5, f64::from(at / size[0]) + 0.5);
            let (eye, direction) = camera.ray_through(i, j, width, height);
            self.floor_along(eye, direction, &scene_lights, &sky)
        };
        (0..size[0] * size[1]).into_par_iter().map(pixel).collect()
    }

    fn floor_along(
        &self,
        eye: DVec3,
        direction: DVec3,
        scene_lights: &[(SceneLight, Option<ShadowRays<'_>>)],
        sky: &[(SweepFrame, Vec<f64>)],
    ) -> [f64; 4] {
        let (floor, shading) = (&self.settings.floor, &self.settings.shading);
        let up = self.settings.camera.up.direction();
        let towards = direction.dot(up);
        // An orthographic eye has no position: its rays begin infinitely far away.
        let along = (floor.height - eye.dot(up)) / towards;
        let is_in_front = along > 0.0 || self.settings.camera.projection == Projection::Orthographic;
        if towards >= 0.0 || !is_in_front {
            return [0.0; 4];
        }
        let place = eye + direction * along;
        let presence = floor.opacity_at(place.reject_from(up).length());
        let index = self.scene.index_from_scene.transform_point3(place);
        let (mut fallen, mut bare) = ([0.0; 3], [0.0; 3]);
        for (light, rays) in scene_lights {
            let risen = self.with_sampled_area(*light).above_horizon(place, up, 1.0);
            let cone = light.cone();
            let hood = cone.attenuation(-cone.axis.dot(risen.direction)) * risen.visible_share;
            let of_rays = |rays: &ShadowRays<'_>| {
                self.apply_cures(rays.attenuation_above(light, index, up))
                    - self.shadowed_share() * (1.0 - risen.visible_share)
            };
            let arriving = rays.as_ref().map_or(hood, of_rays);
            for channel in 0..3 {
                let rgb =
                    linear_from_srgb(light.color[channel]) * light.intensity * risen.mean_cosine.max(0.0);
                fallen[channel] += rgb * arriving;
                bare[channel] += rgb * hood;
            }
        }
        let [sky, open_sky] = self.sky_on_floor(sky, index);
        let reflected = |sky: [f64; 3], light: [f64; 3]| {
            [0, 1, 2].map(|c| self.settings.flat_ambient() + sky[c] + shading.diffuse * light[c])
        };
        let luminance = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let (shown, unshadowed) = (reflected(sky, fallen), reflected(open_sky, bare));
        if floor.shadow_only {
            let missing = (1.0 - luminance(shown) / luminance(unshadowed).max(1e-6)).clamp(0.0, 1.0);
            return [0.0, 0.0, 0.0, presence * missing];
        }
        let [r, g, b] = [0, 1, 2].map(|c| presence * linear_from_srgb(floor.color[c]) * shown[c]);
        [r, g, b, presence]
    }
}
