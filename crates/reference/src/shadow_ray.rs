//! Shadow rays: attenuation of light on the way to a point (P eq. 7 and 8), for every voxel of a light volume or for
//! every sample of the picture.

use glam::DVec3;
use rayon::prelude::*;

use super::back_project::AttenuationVolume;
use super::extent::cut::UncutRegion;
use super::extent::point_weights::PointWeights;
use super::field::classified::TransferSide;
use super::kernel::KernelProfile;
use super::{Reference, gather};
use crate::field::integrated_table::IntegratedTable;
use chiaroscuro_scene::{
    BakedTransfer, DepositMode, LightGeometry, ReconstructionKernel, SceneLight, SlabQuadrature,
};

/// Sampler of shadow rays to one light.
pub(super) struct ShadowRays<'r> {
    reference: &'r Reference<'r>,
    /// Point lights that represent the light; usually the light itself.
    points: Vec<SceneLight>,
    profile: KernelProfile,
    quadrature: SlabQuadrature,
    table: BakedTransfer,
    remaining: UncutRegion,
    /// True if extinction is integrated between the ends of steps, instead of taken in their middle.
    is_integrated: bool,
}

impl<'r> ShadowRays<'r> {
    /// Creates rays to light `index`, with densities reconstructed by a kernel.
    pub(super) fn new(
        reference: &'r Reference<'r>,
        index: usize,
        kernel: ReconstructionKernel,
        quadrature: SlabQuadrature,
    ) -> Self {
        Self::from_points(reference, reference.points(index), (kernel, quadrature))
    }

    fn from_points(
        reference: &'r Reference<'r>,
        points: Vec<SceneLight>,
        (kernel, quadrature): (ReconstructionKernel, SlabQuadrature),
    ) -> Self {
        Self {
            reference,
            points,
            profile: reference.profile(reference.gathered_kernel(kernel)),
            quadrature,
            table: reference.gathered_table(TransferSide::Lighting),
            remaining: reference.attenuating_region(),
            is_integrated: false,
        }
    }

    /// Sets if extinction is integrated between the ends of steps.
    pub(super) fn integrated(self, is_integrated: bool) -> Self {
        Self { is_integrated, ..self }
    }

    /// Returns the transmittance of the light at an index-space point: the mean over its points.
    pub(super) fn attenuation(&self, point: DVec3) -> f64 {
        let of_points = self.points.iter().map(|light| self.attenuation_of(light, point));
        of_points.sum::<f64>() / self.points.len() as f64
    }

    /// Returns the transmittance of a light at an index-space point, with the points of the light weighted.
    pub(super) fn weighted_attenuation(&self, point: DVec3, weights: &PointWeights<'_>) -> f64 {
        let of_points = self.points.iter().map(|light| {
            let weight = weights.by_direction(light);
            (weight * self.attenuation_of(light, point), weight)
        });
        let (sum, all) = of_points.fold((0.0, 0.0), |(sum, all), (a, b)| (sum + a, all + b));
        sum / all
    }

    /// Returns the transmittance of `whole` at a surface that receives light only from above, in direction `up`.
    pub(super) fn attenuation_above(&self, whole: &SceneLight, point: DVec3, up: DVec3) -> f64 {
        let place = self.reference.scene.scene_from_index.transform_point3(point);
        let is_above = |light: &&SceneLight| {
            let towards = match light.kind {
                LightGeometry::Parallel => light.direction(),
                LightGeometry::Perspective => DVec3::from(light.position) - place,
            };
            towards.dot(up) > 0.0
        };
        let weights = PointWeights::new(whole, place, up);
        let all: f64 = self.points.iter().map(|light| weights.by_direction(light)).sum();
        let seen = self.points.iter().filter(is_above);
        seen.map(|light| weights.by_direction(light) * self.attenuation_of(light, point)).sum::<f64>() / all
    }

    /// Returns ∏ (1 − α(s + r·k·Δs)) over the samples between an index-space point and a point light, times the share
    /// that the hood lets through. Point samples: kernels are not stretched.
    fn attenuation_of(&self, light: &SceneLight, point: DVec3) -> f64 {
        let reference = self.reference;
        let place = reference.scene.scene_from_index.transform_point3(point);
        let (towards, reach) = match light.kind {
            LightGeometry::Parallel => (light.direction(), f64::INFINITY),
            LightGeometry::Perspective => {
                let away = DVec3::from(light.position) - place;
                (away.normalize_or(DVec3::Z), away.length())
            }
        };
        let cone = light.cone();
        let step = reference.settings.shadows.ray_step(&reference.scene);
        let forward = reference.scene.index_from_scene.transform_vector3(towards);
        let first = match reference.settings.shadows.deposit {
            DepositMode::Front => 1.0,
            DepositMode::SlabMean => 0.5,
        };
        // There is no material outside the grid.
        let across = 2.0 * reference.scene.support_radius()
            + (place.length() - reference.scene.support_radius()).max(0.0);
        let end = reach.min(across);
        let begin_of = |k: u32| (f64::from(k) + first - 0.5) * step;
        // The last step is shortened to the remaining distance.
        let count = (end / step - first + 0.5).ceil().max(0.0) as u32;
        if self.is_integrated {
            let depth = self.integrated_depth(point, forward, step, end) * light.density_scale;
            return (-depth).exp() * cone.attenuation(-cone.axis.dot(towards));
        }
        let support = reference.scene.support_in_index();
        let optical_depth: f64 = (0..count)
            .map(|k| {
                let length = step.min(end - begin_of(k));
                let middle = begin_of(k) + 0.5 * length;
                let at = point + forward * middle;
                if !(at.cmpge(support.min).all() && at.cmple(support.max).all()) {
                    return 0.0;
                }
                let offsets = self.quadrature.offsets();
                let density = |offset: &f64| {
                    let at = point + forward * (middle + offset * length) + reference.kernel_shift();
                    gather::density(reference, TransferSide::Lighting, &self.profile, at, 0.0)
                };
                let there = |offset: &f64| {
                    let at = point + forward * (middle + offset * length) + reference.kernel_shift();
                    reference.gathered_presence(&self.profile, at, 0.0)
                };
                let there = offsets.iter().map(there).sum::<f64>() / offsets.len() as f64;
                let density = offsets.iter().map(density).sum::<f64>() / offsets.len() as f64;
                let share = there * reference.attenuating_share(&self.remaining, at);
                share * self.table.sample(density)[3] * length * light.density_scale
            })
            .sum();
        (-optical_depth).exp() * cone.attenuation(-cone.axis.dot(towards))
    }

    /// Returns the optical depth over a length of `end` scene units from an index-space point, integrated between the
    /// ends of steps; `forward` is a scene unit in index space.
    fn integrated_depth(&self, point: DVec3, forward: DVec3, step: f64, end: f64) -> f64 {
        let reference = self.reference;
        let table = IntegratedTable::new(self.table.clone(), reference.classified.is_some());
        let sampled = |way: f64| {
            let at = point + forward * way + reference.kernel_shift();
            let density = gather::density(reference, TransferSide::Lighting, &self.profile, at, 0.0);
            (density, reference.gathered_presence(&self.profile, at, 0.0))
        };
        let mut before = sampled(0.0);
        let mut depth = 0.0;
        for k in 0..(end / step).ceil().max(0.0) as u32 {
            let (begin, stop) = (f64::from(k) * step, (f64::from(k + 1) * step).min(end));
            let behind = sampled(stop);
            let there = 0.5 * (before.1 + behind.1);
            let share =
                reference.attenuating_share(&self.remaining, point + forward * (0.5 * (begin + stop)));
            depth += there * share * table.mean_between(before.0, behind.0)[3] * (stop - begin);
            before = behind;
        }
        depth
    }
}

impl Reference<'_> {
    /// Computes the attenuation volume of a point light by a ray from every voxel (P §3.4).
    pub(super) fn raycast(&self, light: &SceneLight, divisor: usize) -> AttenuationVolume {
        let shadows = &self.settings.shadows;
        let mut volume = AttenuationVolume::unattenuated(self.scene.dims, divisor);
        let rays = ShadowRays::from_points(self, vec![*light], (shadows.kernel, shadows.quadrature));
        volume.values = (0..volume.values.len())
            .into_par_iter()
            .map(|voxel| rays.attenuation(volume.voxel_centre(voxel)))
            .collect();
        volume
    }
}
