//! Shading of a sample: P eq. 2 – 4 with the light of the attenuation volumes.

mod near_field;
mod opacity_sides;

use glam::DVec3;

use self::near_field::NearField;
use self::opacity_sides::opacity_sides;
use crate::back_project::AttenuationVolume;
use crate::extent::point_weights::PointWeights;
use crate::field::classified::TransferSide;
use crate::field::pyramid::MAX_LEVEL;
use crate::indirect::bounces::BouncedLight;
use crate::indirect::sky::SkyVisibility;
use crate::shadow_ray::ShadowRays;
use crate::{Reference, ReferenceFault, gather, linear_from_srgb};
use chiaroscuro_render::plan::MAX_STRETCH_LEVEL;
use chiaroscuro_scene::{
    LightGeometry, LightSettings, LitSides, NearFieldRay, Projection, SceneLight, ShadowAlgorithm,
    VisibleLight,
};

/// Shader of one picture: its lights and its eye.
pub(super) struct Shader<'r> {
    reference: &'r Reference<'r>,
    lights: Vec<ShadedLight<'r>>,
    /// Opacity unit in scene units, to which gradients refer.
    opacity_unit: f64,
    near: NearField<'r>,
    /// Sky visibility, if there is a sky that material attenuates.
    sky_visibility: Option<SkyVisibility>,
    /// Bounced light, if any light bounces.
    bounced: Option<BouncedLight>,
    /// Result of [`opacity_sides()`], evenly spaced over densities 0 … 1.
    sides: Vec<f64>,
}

/// Sample of the volume that is shaded.
pub(super) struct ShadedSample {
    /// Position in index space.
    pub(super) point: DVec3,
    pub(super) density: f64,
    /// Gradient in scene space, with that of the ends of solids.
    pub(super) gradient: DVec3,
    /// Pyramid level that corresponds to the kernel's stretch.
    pub(super) level: f64,
}

/// Light that is on, with its attenuation.
struct ShadedLight<'r> {
    /// Light resolved into scene space.
    light: SceneLight,
    /// Linear colour times intensity and balance: `C_L` of P eq. 5.
    rgb: [f64; 3],
    attenuated: LightAttenuation<'r>,
}

/// Source of a light's attenuation.
enum LightAttenuation<'r> {
    None,
    Volume(&'r AttenuationVolume),
    Rays(Box<ShadowRays<'r>>),
}

/// Surface properties of a sample, from its gradient.
struct SurfaceEstimate {
    /// Unit vector from dense to thin; zero where there is no gradient.
    normal: DVec3,
    /// Surface weight: 0 inside a material, which is lit evenly from all sides; 1 on a surface.
    weight: f64,
}

impl<'r> Shader<'r> {
    pub(super) fn new(reference: &'r Reference<'r>, attenuations: &'r [Option<AttenuationVolume>]) -> Self {
        let settings = reference.settings;
        let algorithm = settings.shadows.algorithm;
        let shadows_on = algorithm.is_on();
        let balance = if shadows_on { settings.shadows.balance } else { 1.0 };
        let shaded_light = |(index, light): (usize, &'r LightSettings)| ShadedLight {
            light: reference.light(index),
            rgb: light.color.map(|c| linear_from_srgb(c) * light.intensity * balance),
            attenuated: match attenuations.get(index) {
                // Shadow rays use the picture's own reconstruction, set up once for all rays (P §3.3).
                _ if algorithm == ShadowAlgorithm::Direct && light.needs_volume() => {
                    let sampling = &settings.sampling;
                    let rays = ShadowRays::new(reference, index, sampling.kernel, sampling.quadrature);
                    LightAttenuation::Rays(Box::new(rays.integrated(settings.has_adaptive_slabs())))
                }
                Some(Some(volume)) if shadows_on && light.casts_shadows => LightAttenuation::Volume(volume),
                _ => LightAttenuation::None,
            },
        };
        Self {
            reference,
            lights: settings
                .lights
                .iter()
                .enumerate()
                .filter(|(_, light)| light.on)
                .map(shaded_light)
                .collect(),
            opacity_unit: settings.layer().opacity_unit.scene_units(&reference.scene).max(1e-9),
            near: NearField::new(reference),
            sky_visibility: settings.has_sky_volume().then(|| reference.sky_visibility()),
            bounced: settings.has_bounces().then(|| reference.bounced_light()),
            sides: opacity_sides(&reference.gathered_table(TransferSide::Eye)),
        }
    }

    /// Returns C(s) of P eq. 2 at a sample with the transfer function's colour `C_o`: `C_o · (emission + k_a + Σ
    /// C_l·k_d·r) + Σ C_l·k_s·(N·H)^n_s`, where r is |N·L| for two-sided surfaces, and max(N·L, 0) for one-sided ones
    /// with the normal N towards falling opacity.
    pub(super) fn color(&self, sample: &ShadedSample, base: [f64; 3]) -> [f64; 3] {
        self.color_with(sample, base, &self.attenuations(sample))
    }

    /// Returns [`Self::color`] with given attenuations of the lights.
    pub(super) fn color_with(
        &self,
        sample: &ShadedSample,
        base: [f64; 3],
        attenuations: &[Option<f64>],
    ) -> [f64; 3] {
        let &ShadedSample { point, density, gradient, level } = sample;
        let base = self.reference.tinted(base, point, level);
        let shading = &self.reference.settings.shading;
        let scene = &self.reference.scene;
        let surface = self.surface(gradient);
        let is_one_sided = shading.sides == LitSides::One;
        // If opacity falls along the gradient, the outside is on the other side.
        let side = if is_one_sided { self.side_of(density) } else { 1.0 };
        let outward = surface.normal * self.normal_sign(density);
        let place = scene.scene_from_index.transform_point3(point);
        let to_eye = self.towards_eye(place);
        // Where light bounces, the albedo is the share of all light that is scattered.
        let settings = self.reference.settings;
        let scattered = if settings.has_bounces() { settings.scattering.albedo } else { 1.0 };
        let side_lit = is_one_sided.then_some(side);
        let openness = self.sky_visibility.as_ref();
        let sky = self.reference.lit_by_sky(openness, point, surface.normal, surface.weight, side_lit);
        let bounced = self.bounced.as_ref();
        let bounced = self.reference.lit_by_bounces(bounced, point, surface.normal, surface.weight, side_lit);
        let mut diffuse: [f64; 3] =
            std::array::from_fn(|c| scattered * (settings.flat_ambient() + sky[c] + bounced[c]));
        let mut specular = [0.0; 3];
        for (shaded_light, attenuation) in self.lights.iter().zip(attenuations) {
            let has_horizon = is_one_sided && shaded_light.light.casts_shadows;
            let risen = self.above_horizon(shaded_light, sample);
            let to_light = risen.direction;
            let arriving = if let Some(attenuation) = attenuation {
                self.reference.apply_cures(*attenuation)
            } else {
                let cone = shaded_light.light.cone();
                cone.attenuation(-cone.axis.dot(to_light))
            };
            let reflected = if has_horizon {
                let before = 0.5 + 0.5 * side.abs();
                // The part below the horizon does not count, even where shadows have no effect.
                let counted = match shaded_light.attenuated {
                    LightAttenuation::None => arriving * risen.visible_share,
                    _ => arriving - self.reference.shadowed_share() * (1.0 - risen.visible_share),
                };
                counted * before * risen.mean_cosine.max(0.0)
                    + arriving * (1.0 - before) * (-risen.centre_cosine).max(0.0)
            } else {
                arriving * risen.centre_cosine.abs()
            };
            // Away from surfaces, light is scattered towards the eye by the phase function: of an irradiance E = π, π/4π.
            let quarter = if settings.has_bounces() { 0.25 } else { 1.0 };
            let amid = quarter * henyey_greenstein(settings.scattering.anisotropy, -to_light.dot(to_eye));
            let reflected = arriving * amid * (1.0 - surface.weight) + reflected * surface.weight;
            let half_way = (to_light + to_eye).normalize_or_zero();
            let mirrored = if outward.dot(to_light) > 0.0 {
                let wider = 1.0 / (1.0 + shading.shininess * shaded_light.light.angular_size(place) / 16.0);
                let mirrored = outward.dot(half_way).max(0.0).powf(shading.shininess * wider) * wider;
                side.abs() * surface.weight * mirrored
            } else {
                0.0
            };
            for channel in 0..3 {
                diffuse[channel] += scattered * shaded_light.rgb[channel] * shading.diffuse * reflected;
                specular[channel] += shaded_light.rgb[channel] * arriving * shading.specular * mirrored;
            }
        }
        std::array::from_fn(|channel| {
            base[channel] * (shading.emission + diffuse[channel]) + specular[channel]
        })
    }

    /// Returns the part of a light above the horizon of a sample.
    fn above_horizon(&self, shaded_light: &ShadedLight<'_>, sample: &ShadedSample) -> VisibleLight {
        let surface = self.surface(sample.gradient);
        let is_one_sided = self.reference.settings.shading.sides == LitSides::One;
        let side = if is_one_sided { self.side_of(sample.density) } else { 1.0 };
        let has_horizon = is_one_sided && shaded_light.light.casts_shadows;
        let horizon = if has_horizon { side.abs() * surface.weight } else { 0.0 };
        let place = self.reference.scene.scene_from_index.transform_point3(sample.point);
        let outward = surface.normal * self.normal_sign(sample.density);
        self.reference.with_sampled_area(shaded_light.light).above_horizon(place, outward, horizon)
    }

    /// Returns the attenuation of each light at a sample, before the cures for darkness; `None` for lights without.
    pub(super) fn attenuations(&self, sample: &ShadedSample) -> Vec<Option<f64>> {
        self.lights
            .iter()
            .map(|light| self.attenuation(light, sample, self.above_horizon(light, sample).direction))
            .collect()
    }

    fn attenuation(
        &self,
        shaded_light: &ShadedLight<'_>,
        sample: &ShadedSample,
        to_light: DVec3,
    ) -> Option<f64> {
        let shadows = &self.reference.settings.shadows;
        let scene = &self.reference.scene;
        let bias = to_light * (scene.smallest_edge() * shadows.bias_voxels);
        let place = sample.point + scene.index_from_scene.transform_vector3(bias);
        match &shaded_light.attenuated {
            LightAttenuation::None => None,
            LightAttenuation::Volume(volume)
                if self.reference.settings.effective_near_field() != NearFieldRay::Off =>
            {
                Some(self.near_field(&shaded_light.light, volume, sample, to_light))
            }
            LightAttenuation::Volume(volume) => Some(volume.at(place)),
            LightAttenuation::Rays(rays) => {
                let surface = self.surface(sample.gradient);
                let on_surface = scene.scene_from_index.transform_point3(sample.point);
                let normal = surface.normal * surface.weight;
                let weights = PointWeights::new(&shaded_light.light, on_surface, normal);
                Some(rays.weighted_attenuation(place, &weights))
            }
        }
    }

    /// Returns e^(−τ) over the steps of a near-field ray, the last of which is half a voxel of the light volume
    /// longer, times the volume's value at its end. No step reaches beyond the light.
    fn near_field(
        &self,
        light: &SceneLight,
        volume: &AttenuationVolume,
        sample: &ShadedSample,
        to_light: DVec3,
    ) -> f64 {
        let scene = &self.reference.scene;
        let distance = match light.kind {
            LightGeometry::Parallel => f64::INFINITY,
            LightGeometry::Perspective => {
                DVec3::from(light.position).distance(scene.scene_from_index.transform_point3(sample.point))
            }
        };
        let steps = light.near_field_steps(self.reference.settings.effective_near_field());
        let extension = 0.5 * volume.divisor as f64 * scene.smallest_edge();
        let (depth, way) = self.near.optical_depth(sample, to_light, steps, extension, distance);
        let end = sample.point + scene.index_from_scene.transform_vector3(to_light * way);
        (-depth * light.density_scale).exp() * volume.at(end)
    }

    /// Returns −1 if opacity falls as density rises and surfaces are one-sided; otherwise 1.
    pub(super) fn normal_sign(&self, density: f64) -> f64 {
        let is_one_sided = self.reference.settings.shading.sides == LitSides::One;
        if is_one_sided && self.side_of(density) < 0.0 { -1.0 } else { 1.0 }
    }

    /// Returns the side of a surface to which opacity falls at a density, interpolated in [`opacity_sides()`].
    fn side_of(&self, density: f64) -> f64 {
        let last = self.sides.len() - 1;
        let at = density.clamp(0.0, 1.0) * last as f64;
        let low = (at as usize).min(last - 1);
        let t = at - low as f64;
        self.sides[low] * (1.0 - t) + self.sides[low + 1] * t
    }

    /// Returns the gradient in scene space, by the method in the settings.
    pub(super) fn gradient(&self, point: DVec3, level: f64) -> DVec3 {
        let level = level.clamp(0.0, MAX_LEVEL as f64);
        if self.reference.classified.is_some() {
            // One level coarser, as labels change abruptly from voxel to voxel. Steps are interpolated between
            // levels, too.
            return self.to_scene(self.gradient_of_level(point, (level + 1.0).min(MAX_STRETCH_LEVEL)));
        }
        if !self.reference.settings.has_kernel_gradients() || level >= 1.0 {
            return self.prefiltered_gradient(point, level);
        }
        let narrow = self.to_scene(gather::kernel_gradient(self.reference, point));
        narrow + (self.prefiltered_gradient(point, 1.0) - narrow) * level
    }

    /// Converts a gradient from index space to scene space, by the transposed inverse.
    fn to_scene(&self, in_index: DVec3) -> DVec3 {
        self.reference.scene.index_from_scene.matrix3.transpose() * in_index
    }

    /// Returns the gradient in scene space of the prefiltered density: that of the two levels around `level`, linear
    /// between them, as for densities.
    pub(super) fn prefiltered_gradient(&self, point: DVec3, level: f64) -> DVec3 {
        let level = level.clamp(0.0, MAX_LEVEL as f64);
        let finer = self.gradient_of_level(point, level.floor());
        let coarser = self.gradient_of_level(point, level.ceil());
        self.to_scene(finer + (coarser - finer) * level.fract())
    }

    /// Returns differences of a level of the pyramid, one and two of its voxels to either side, with weights that are
    /// exact to the fourth order: f′(x) ≈ [8 (f(x + h) − f(x − h)) − (f(x + 2h) − f(x − 2h))] / 12h.
    fn gradient_of_level(&self, point: DVec3, level: f64) -> DVec3 {
        let step = level.exp2();
        let fetch = |at: DVec3| self.reference.gathered_pyramid(TransferSide::Eye).fetch(at, level);
        let along = |axis: DVec3| {
            let change = |steps: f64| fetch(point + axis * steps * step) - fetch(point - axis * steps * step);
            (8.0 * change(1.0) - change(2.0)) / (12.0 * step)
        };
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    fn surface(&self, gradient: DVec3) -> SurfaceEstimate {
        let length = gradient.length();
        let outward = if self.reference.options.fault == ReferenceFault::FlippedNormal { 1.0 } else { -1.0 };
        let change = length * self.opacity_unit;
        let threshold = self.reference.settings.shading.surface_gradient;
        SurfaceEstimate {
            normal: if length < 1e-9 { DVec3::ZERO } else { gradient * (outward / length) },
            weight: change * change / (change * change + threshold * threshold),
        }
    }

    /// Returns the unit vector from a scene point towards the eye.
    fn towards_eye(&self, place: DVec3) -> DVec3 {
        let camera = &self.reference.settings.camera;
        let backward = camera.scene_from_view().z_axis;
        match camera.projection {
            Projection::Orthographic => backward,
            Projection::Perspective => (camera.position() - place).normalize_or(backward),
        }
    }
}

/// Returns the Henyey–Greenstein phase function relative to isotropic scattering; `mean` is its mean cosine.
fn henyey_greenstein(mean: f64, cosine: f64) -> f64 {
    (1.0 - mean * mean) / (1.0 + mean * mean - 2.0 * mean * cosine).powf(1.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ReferenceOptions;
    use chiaroscuro_scene::{Camera, PhongShading, Settings};
    use chiaroscuro_volume::{Samples, Volume};

    #[test]
    fn a_ramp_is_lit_as_the_equation_says() {
        // Density falls from 1 to 0 over 16 voxels along x: the surface faces +x.
        let values = (0..16usize.pow(3)).map(|v| (15 - v % 16) as u8).collect();
        let volume = Volume::with_spacing("ramp", [16; 3], DVec3::ONE, Samples::U8(values)).unwrap();
        let settings = Settings {
            camera: Camera {
                projection: Projection::Orthographic,
                azimuth_deg: 0.0,
                elevation_deg: 0.0,
                ..Camera::default()
            },
            lights: vec![LightSettings {
                position: [3.0, 4.0, 0.0],
                intensity: 2.0,
                ..LightSettings::default()
            }],
            shading: PhongShading {
                emission: 0.1,
                shininess: 2.0,
                surface_gradient: 1.0 / 15.0,
                ..PhongShading::default()
            },
            ..Settings::default()
        };
        // One voxel is the opacity unit, so the density change per unit is 1/15, half a surface.
        let weight = 0.5;
        let reference = Reference::new(&volume, &settings, ReferenceOptions::default());
        let half = AttenuationVolume { dims: [1; 3], divisor: 16, values: vec![0.5] };
        for (attenuations, arriving) in [(vec![], 1.0), (vec![Some(half)], 0.5)] {
            let shader = Shader::new(&reference, &attenuations);
            let middle = DVec3::splat(7.5);
            let gradient = shader.gradient(middle, 0.0);
            let sample = ShadedSample { point: middle, density: 0.5, gradient, level: 0.0 };
            let found = shader.color(&sample, [1.0, 0.5, 0.0]);
            let diffuse = 0.1 + 0.15 + 2.0 * arriving * 0.85 * (1.0 - weight + weight * 0.6);
            // The half-vector of (0.6, 0.8, 0) and (1, 0, 0): cos² = (1 + 0.6)/2.
            let specular = 2.0 * arriving * 0.25 * weight * 0.8;
            for (channel, base) in [1.0, 0.5, 0.0].into_iter().enumerate() {
                let right = base * diffuse + specular;
                assert!((found[channel] - right).abs() < 1e-6, "{} {right}", found[channel]);
            }
        }
    }
}
