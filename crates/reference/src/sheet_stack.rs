//! Stack of sheet buffers: densities with either kind of weights, and their classification.

use glam::DVec3;
use rayon::prelude::*;

use super::extent::cut::UncutRegion;
use super::field::DensityField;
use super::field::classified::{ClassifiedVoxels, TransferSide, associated, unassociated};
use super::kernel::KernelProfile;
use super::{Reference, ReferenceFault, ReferenceWeights, footprint, gather};
use chiaroscuro_render::plan::SheetFrame;
use chiaroscuro_scene::{BakedTransfer, ReconstructionKernel, SlabQuadrature};

/// Lower limit of the presence by which sums over present voxels are divided; below it nothing is visible.
const MIN_PRESENCE: f64 = 1e-4;

/// Sheets of one pass.
pub(super) struct SheetStack<'r> {
    reference: &'r Reference<'r>,
    /// Rays and slabs of the stack.
    pub frame: &'r SheetFrame,
    side: TransferSide,
    /// Kernel that spreads densities, or classified voxels.
    profile: KernelProfile,
    quadrature: SlabQuadrature,
    /// Table that classifies densities of the sheets.
    table: BakedTransfer,
    remaining: CutTreatment,
}

/// Treatment of cuts: abrupt for the eye, soft for light.
pub(super) enum CutTreatment {
    /// Part visible to the eye.
    Visible(UncutRegion),
    /// Part that attenuates light.
    Attenuating(UncutRegion),
}

/// Contribution of one slab to one ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlabContribution {
    /// Index-space point in the middle of the slab.
    pub point: DVec3,
    /// Linear colour of the transfer function.
    pub rgb: [f64; 3],
    /// Optical depth τ of the slab along this ray.
    pub optical_depth: f64,
}

impl<'r> SheetStack<'r> {
    pub(super) fn new(
        reference: &'r Reference<'r>,
        frame: &'r SheetFrame,
        kernel: ReconstructionKernel,
        quadrature: SlabQuadrature,
        remaining: CutTreatment,
    ) -> Self {
        let side = match remaining {
            CutTreatment::Visible(_) => TransferSide::Eye,
            CutTreatment::Attenuating(_) => TransferSide::Lighting,
        };
        let kernel = match reference.weights() {
            ReferenceWeights::Gather => reference.gathered_kernel(kernel),
            ReferenceWeights::Footprint | ReferenceWeights::Scatter => kernel,
        };
        let (profile, table) = (reference.profile(kernel), reference.gathered_table(side));
        Self { reference, frame, side, profile, quadrature, table, remaining }
    }

    /// Returns the mean densities of slab `k`, row by row; 0 outside the volume's support. Splatted sums are divided
    /// by the share of the kernels that lies within the grid.
    pub(super) fn densities(&self, k: u32) -> Vec<f64> {
        let Self { reference, frame, profile, quadrature, .. } = self;
        match reference.weights() {
            weights @ (ReferenceWeights::Footprint | ReferenceWeights::Scatter) => {
                let points = (weights == ReferenceWeights::Scatter).then_some(*quadrature);
                let shift = reference.kernel_shift();
                if let Some(classified) = reference.classified(self.side) {
                    // Sums of classified voxels are not normalised.
                    return footprint::splat(&classified.field, frame, profile, points, shift, k);
                }
                let sums = footprint::splat(&reference.field, frame, profile, points, shift, k);
                let mean = |(pixel, sum): (usize, f64)| {
                    let [i, j] = self.pixel_position(pixel as u32);
                    sum / self.presence_in_grid([i, j, f64::from(k)])
                };
                sums.into_iter().enumerate().map(mean).collect()
            }
            ReferenceWeights::Gather => {
                let width = frame.size[0];
                (0..width * frame.size[1])
                    .into_par_iter()
                    .map(|pixel| self.density_at([pixel % width, pixel / width, k].map(f64::from)))
                    .collect()
            }
        }
    }

    /// Returns linear colour and extinction of slab `k`, row by row: classified densities, or spread classified
    /// voxels.
    pub(super) fn materials(&self, k: u32) -> Vec<[f64; 4]> {
        let Self { reference, frame, side, profile, quadrature, table, remaining: _ } = self;
        let Some(classified) = reference.classified(*side) else {
            return self.densities(k).into_iter().map(|density| table.sample(density)).collect();
        };
        let weights = reference.weights();
        let ClassifiedVoxels { field, colors, .. } = classified;
        if weights != ReferenceWeights::Gather {
            let voxels = reference.table(*side);
            let points = (weights == ReferenceWeights::Scatter).then_some(*quadrature);
            let channels: [Vec<f64>; 4] = std::array::from_fn(|channel| {
                let of_voxel = |&density: &f64| associated(voxels.sample(density))[channel];
                let densities = reference.field.densities.iter().map(of_voxel).collect();
                let field = DensityField { dims: field.dims, densities, border: field.border };
                footprint::splat(&field, frame, profile, points, reference.kernel_shift(), k)
            });
            let material = |at: usize| {
                let [i, j] = self.pixel_position(at as u32);
                let place = [i, j, f64::from(k)];
                // Missing voxels have substitute values, so the sums are multiplied by presence; the grid's border is
                // excluded, as nothing is substituted outside.
                let there = match &reference.presence {
                    Some(_) => self.presence_at(place) / self.presence_in_grid(place),
                    None => 1.0,
                };
                unassociated(std::array::from_fn(|channel| channels[channel][at] * there))
            };
            return (0..self.pixel_count()).map(material).collect();
        }
        let material = |pixel: usize| {
            let [i, j] = self.pixel_position(pixel as u32);
            let place = [i, j, f64::from(k)];
            let share = self.density_at(place);
            if share <= 0.0 {
                return [0.0; 4];
            }
            let [r, g, b] = colors.each_ref().map(|color| {
                gather::slab_mean(reference, frame, *quadrature, place, |point, level| {
                    color.fetch(point, level)
                }) / share
            });
            [r, g, b, table.sample(share)[3]]
        };
        (0..self.pixel_count()).into_par_iter().map(material).collect()
    }

    /// Returns the middle of slab `k` on a pixel's ray, if there can be material.
    fn material_at(&self, [i, j, k]: [f64; 3]) -> Option<DVec3> {
        let point = self.frame.point(i, j, self.frame.depth_of(k));
        let support = self.reference.scene.support_in_index();
        // Tolerance for faces that lie exactly in the middle of a slab.
        let is_inside = point.cmpge(support.min - 1e-9).all() && point.cmple(support.max + 1e-9).all();
        is_inside.then_some(point)
    }

    /// Returns the contribution of a slab's material to a pixel's ray; `None` if there is none.
    ///
    /// τ = μ(ρ̄) · Δs / cos θ, so that the opacity is 1 − e^−τ (P eq. 6).
    pub(super) fn sample(&self, pixel: u32, k: u32, material: [f64; 4]) -> Option<SlabContribution> {
        self.sample_of(pixel, f64::from(k), 1.0, material)
    }

    /// Computes [`Self::sample`] for a slab centred at `k` that is `width` times as thick.
    pub(super) fn sample_of(
        &self,
        pixel: u32,
        k: f64,
        width: f64,
        material: [f64; 4],
    ) -> Option<SlabContribution> {
        let [i, j] = self.pixel_position(pixel);
        let point = self.material_at([i, j, k])?;
        let [r, g, b, extinction] = material;
        // Presence is already part of the spread extinction of classified voxels.
        let is_pre = self.reference.settings.classification().is_pre();
        let there = if is_pre { 1.0 } else { self.presence_at([i, j, k]) };
        let optical_depth = there * extinction * self.uncut_length([i, j, k], width, point);
        (optical_depth > 0.0).then_some(SlabContribution { point, rgb: [r, g, b], optical_depth })
    }

    /// Returns the uncut length of a ray in a slab, in scene units; `point` is in the middle of the slab.
    fn uncut_length(&self, [i, j, k]: [f64; 3], width: f64, point: DVec3) -> f64 {
        let lengthening = if self.reference.options.fault == ReferenceFault::NoObliquity {
            1.0
        } else {
            self.frame.obliquity(i, j)
        };
        let share = match &self.remaining {
            CutTreatment::Visible(remaining) => {
                let end = |k| self.frame.point(i, j, self.frame.depth_of(k));
                self.reference.uncut_share(remaining, end(k - 0.5 * width), end(k + 0.5 * width))
            }
            CutTreatment::Attenuating(remaining) => self.reference.attenuating_share(remaining, point),
        };
        share * width * self.frame.slab * lengthening
    }

    /// Returns the presence of the material in slab `k`.
    pub(super) fn presence_at(&self, at: [f64; 3]) -> f64 {
        let Self { reference, frame, side, profile, quadrature, .. } = self;
        reference.slab_mean_presence(frame, *quadrature, at, |point, level| {
            reference.presence(*side, profile, point, level)
        })
    }

    /// Returns the share of the kernels of slab `k` that lies within the grid, regardless of missing voxels; at least
    /// [`MIN_PRESENCE`].
    fn presence_in_grid(&self, at: [f64; 3]) -> f64 {
        let Self { reference, frame, profile, quadrature, .. } = self;
        let share = |point, level| reference.presence_in_grid(profile, point, level);
        reference.slab_mean_presence(frame, *quadrature, at, share).max(MIN_PRESENCE)
    }

    /// Returns the density with the GPU's weights in the middle of slab `k` on the ray of pixel (i, j); 0 outside the
    /// volume's support.
    pub(super) fn density_at(&self, at: [f64; 3]) -> f64 {
        if self.material_at(at).is_none() {
            return 0.0;
        }
        self.density_around(at)
    }

    /// Returns [`Self::density_at`] without the limit to the volume's support, outside of which the field continues.
    pub(super) fn density_around(&self, at: [f64; 3]) -> f64 {
        let Self { reference, frame, side, profile, quadrature, .. } = self;
        gather::slab_mean(reference, frame, *quadrature, at, |point, level| {
            gather::density(reference, *side, profile, point, level)
        })
    }

    /// Returns the density with the GPU's weights, and the presence, at an index-space point.
    pub(super) fn sampled_at(&self, point: DVec3, level: f64) -> (f64, f64) {
        let Self { reference, side, profile, .. } = self;
        let at = point + reference.kernel_shift();
        let density = gather::density(reference, *side, profile, at, level);
        // Already part of the spread extinction of classified voxels.
        let is_pre = reference.settings.classification().is_pre();
        let presence = if is_pre { 1.0 } else { reference.presence(*side, profile, at, level) };
        (density, presence)
    }

    /// Returns the depth on a pixel's ray that is nearest to `depth` and not cut.
    pub(super) fn depth_within_cut(&self, [i, j]: [f64; 2], depth: f64) -> f64 {
        let CutTreatment::Visible(remaining) = &self.remaining else { return depth };
        let first = self.frame.depth_of(-0.5);
        let last = self.frame.depth_of(f64::from(self.frame.slab_count) - 0.5);
        let end = |depth| self.frame.point(i, j, depth);
        match self.reference.uncut_span(remaining, end(first), end(last)) {
            Some([begin, stop]) => {
                let at = |share: f64| first + (last - first) * share;
                depth.clamp(at(begin), at(stop))
            }
            None => first,
        }
    }

    /// Returns the uncut length of a ray between the middles of two neighbouring slabs, in scene units; 0 if the
    /// farther one lies outside the volume's support.
    pub(super) fn length_between(&self, [from, to]: [[f64; 3]; 2]) -> f64 {
        if self.material_at(to).is_none() {
            return 0.0;
        }
        let middle = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
        let point = self.frame.point(middle[0], middle[1], self.frame.depth_of(middle[2]));
        self.uncut_length(middle, 1.0, point)
    }

    /// Returns the column and row of a pixel.
    pub(super) fn pixel_position(&self, pixel: u32) -> [f64; 2] {
        let width = self.frame.size[0];
        [pixel % width, pixel / width].map(f64::from)
    }

    /// Returns the number of pixels of a sheet.
    pub(super) fn pixel_count(&self) -> usize {
        self.frame.size[0] as usize * self.frame.size[1] as usize
    }
}
