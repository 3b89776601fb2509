//! Near-field rays: attenuation of light over the last voxels before a sample, in front of a light volume.

use glam::DVec3;

use super::ShadedSample;
use crate::Reference;
use crate::extent::cut::UncutRegion;
use crate::field::classified::TransferSide;
use crate::field::integrated_table::IntegratedTable;
use crate::gather;
use crate::kernel::KernelProfile;
use chiaroscuro_scene::{NearFieldRay, ReconstructionKernel};

/// Sampler of near-field rays.
pub(super) struct NearField<'r> {
    reference: &'r Reference<'r>,
    /// Transfer function of light.
    lighting: IntegratedTable,
    /// Kernel of the eye, and that of fetches from the pyramid.
    sharp: KernelProfile,
    soft: KernelProfile,
    remaining: UncutRegion,
}

/// End of a step.
#[derive(Clone, Copy)]
struct StepEnd {
    /// Distance from the sample, in scene units.
    way: f64,
    density: f64,
    presence: f64,
}

/// Returns the value at `x` of the parabola through three ends.
fn parabola(x: f64, ends: [StepEnd; 3]) -> f64 {
    (0..3)
        .map(|i| {
            let others = (0..3).filter(|&j| j != i);
            let weight: f64 = others.map(|j| (x - ends[j].way) / (ends[i].way - ends[j].way)).product();
            weight * ends[i].density
        })
        .sum()
}

impl<'r> NearField<'r> {
    pub(super) fn new(reference: &'r Reference<'r>) -> Self {
        let kernel = reference.gathered_kernel(reference.settings.sampling.kernel);
        Self {
            reference,
            lighting: IntegratedTable::new(reference.gathered_table(TransferSide::Lighting)),
            sharp: reference.profile(kernel),
            soft: reference.profile(ReconstructionKernel::Prefiltered),
            remaining: reference.attenuating_region(),
        }
    }

    /// Returns the optical depth of the first `steps` nominal steps towards a light at a distance, the last of which
    /// is longer by `extension`, and the length of the ray; lengths in scene units.
    pub(super) fn optical_depth(
        &self,
        sample: &ShadedSample,
        to_light: DVec3,
        steps: u32,
        extension: f64,
        distance: f64,
    ) -> (f64, f64) {
        let edge = self.reference.scene.smallest_edge();
        let settings = self.reference.settings;
        // The scattering engine has no kernel at points.
        let halves =
            settings.effective_near_field().halves_first_step() && !settings.uses_scattering_engine();
        let nominal = (0..steps).map(|step| {
            let extension = if step + 1 == steps { extension } else { 0.0 };
            NearFieldRay::width_voxels(step) * edge + extension
        });
        let widths: Vec<f64> = if halves {
            [0.25 * edge; 2].into_iter().chain(nominal.skip(1)).collect()
        } else {
            nominal.collect()
        };
        // Ends of halved steps are seen with the kernel of the eye.
        let sharp_ends = if halves { 2 } else { 0 };
        let own = self.end(sample, to_light, 0.0, true);
        let own = StepEnd {
            density: if self.reference.classified.is_some() { own.density } else { sample.density },
            presence: self.presence(sample, to_light, 0.0),
            ..own
        };
        let mut ends = vec![own];
        let mut depth = 0.0;
        for (step, width) in widths.into_iter().enumerate() {
            let begin = ends[step];
            let way = (begin.way + width).min(distance.max(begin.way));
            let end = self.end(sample, to_light, way, step < sharp_ends);
            ends.push(end);
            let length = way - begin.way;
            if length <= 0.0 {
                continue;
            }
            let middle = if step == 0 {
                if self.reference.classified.is_some() {
                    0.5 * (begin.density + end.density)
                } else {
                    // Parabola with the sample's own slope.
                    let slope = sample.volume_gradient.dot(to_light);
                    0.75 * begin.density + 0.25 * end.density + 0.25 * slope * length
                }
            } else if step == 1 || (step == 2 && halves) {
                parabola(begin.way + 0.5 * length, [ends[0], begin, end])
            } else {
                0.5 * (begin.density + end.density)
            };
            let mean = 0.5
                * (self.lighting.mean_between(begin.density, middle)[3]
                    + self.lighting.mean_between(middle, end.density)[3]);
            let at = self.point(sample, to_light, begin.way + 0.5 * length);
            depth += 0.5
                * (begin.presence + end.presence)
                * mean
                * length
                * self.reference.attenuating_share(&self.remaining, at);
        }
        (depth, ends[ends.len() - 1].way)
    }

    fn point(&self, sample: &ShadedSample, to_light: DVec3, way: f64) -> DVec3 {
        sample.point + self.reference.scene.index_from_scene.transform_vector3(to_light * way)
    }

    fn presence(&self, sample: &ShadedSample, to_light: DVec3, way: f64) -> f64 {
        self.reference.gathered_presence(&self.soft, self.point(sample, to_light, way), sample.level)
    }

    fn end(&self, sample: &ShadedSample, to_light: DVec3, way: f64, is_sharp: bool) -> StepEnd {
        let point = self.point(sample, to_light, way);
        let profile = if is_sharp { &self.sharp } else { &self.soft };
        let density = gather::density(self.reference, TransferSide::Lighting, profile, point, sample.level);
        StepEnd { way, density, presence: self.presence(sample, to_light, way) }
    }
}
