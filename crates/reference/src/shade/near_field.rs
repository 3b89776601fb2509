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

/// Returns the density half way between two ends of steps, of the parabola through them and another.
fn bent([a, b]: [StepEnd; 2], other: StepEnd) -> f64 {
    let (x, ends) = (0.5 * (a.way + b.way), [a, b, other]);
    (0..3)
        .map(|i| {
            let others = (0..3).filter(|&j| j != i);
            let weight: f64 = others.map(|j| (x - ends[j].way) / (ends[i].way - ends[j].way)).product();
            weight * ends[i].density
        })
        .sum()
}

/// Returns the density half way along a first step: the mean of the straight line to its end and of the parabola that
/// also meets the end of a second step as long.
fn bent_first(own: f64, end: f64, behind: f64) -> f64 {
    let line = 0.5 * (own + end);
    let parabola = 0.375 * own + 0.75 * end - 0.125 * behind;
    0.5 * (line + parabola)
}

impl<'r> NearField<'r> {
    pub(super) fn new(reference: &'r Reference<'r>) -> Self {
        let kernel = reference.gathered_kernel(reference.settings.sampling.kernel);
        Self {
            reference,
            lighting: IntegratedTable::new(
                reference.gathered_table(TransferSide::Lighting),
                reference.classified.is_some(),
            ),
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
        let is_sharp = !settings.uses_scattering_engine();
        let width = |step: u32| {
            let extension = if step + 1 == steps { extension } else { 0.0 };
            NearFieldRay::width_voxels(step) * edge + extension
        };
        let own = StepEnd {
            way: 0.0,
            density: if self.reference.classified.is_some() {
                self.end(sample, to_light, 0.0, true).density
            } else {
                sample.density
            },
            presence: self.presence(sample, to_light, 0.0),
        };
        let mut begin = self.end(sample, to_light, (0.5 * edge).min(distance), is_sharp);
        let mut end = self.end(sample, to_light, (begin.way + width(1)).min(distance), false);
        let first = if is_sharp && settings.effective_near_field().halves_first_step() {
            let between = self.end(sample, to_light, 0.5 * begin.way, true);
            let middle = bent_first(own.density, between.density, begin.density);
            0.5 * self.curved(own, middle, between)
                + 0.5 * self.curved(between, bent([between, begin], own), begin)
        } else {
            self.curved(own, bent_first(own.density, begin.density, end.density), begin)
        };
        let mut depth = first * begin.way * self.attenuating_share(sample, to_light, 0.5 * begin.way);
        for step in 1..steps {
            let length = end.way - begin.way;
            if length > 0.0 {
                let mean = if step == 1 {
                    self.curved(begin, bent([begin, end], own), end)
                } else {
                    self.curved(begin, 0.5 * (begin.density + end.density), end)
                };
                depth += mean * length * self.attenuating_share(sample, to_light, begin.way + 0.5 * length);
            }
            if step + 1 < steps {
                begin = end;
                end = self.end(sample, to_light, (begin.way + width(step + 1)).min(distance), false);
            }
        }
        (depth, end.way)
    }

    /// Returns the mean extinction between two ends, in two halves that meet at a density.
    fn curved(&self, begin: StepEnd, middle: f64, end: StepEnd) -> f64 {
        let between = |a, b| self.lighting.mean_between(a, b)[3];
        0.25 * (begin.presence + end.presence)
            * (between(begin.density, middle) + between(middle, end.density))
    }

    fn attenuating_share(&self, sample: &ShadedSample, to_light: DVec3, way: f64) -> f64 {
        self.reference.attenuating_share(&self.remaining, self.point(sample, to_light, way))
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
