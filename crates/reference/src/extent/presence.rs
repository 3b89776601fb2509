//! Presence: the share of the kernel around a point that lies on present voxels. Outside the grid is no material,
//! although the density field continues there with the values at the border.

use glam::DVec3;

use crate::field::classified::TransferSide;
use crate::field::pyramid::MAX_LEVEL;
use crate::kernel::{KernelProfile, quadrature_nodes};
use crate::{Reference, ReferenceWeights};
use chiaroscuro_render::plan::SheetFrame;
use chiaroscuro_scene::{ReconstructionKernel, SlabQuadrature};

impl Reference<'_> {
    /// Returns Σ w(v) over the voxels that are present to the eye or to light, at an index-space point with the kernel
    /// stretched 2^`level` times. If voxels are missing, it is a fetch of the presence pyramid, with the prefiltered kernel whatever the settings
    /// are.
    pub(crate) fn presence(
        &self,
        side: TransferSide,
        profile: &KernelProfile,
        point: DVec3,
        level: f64,
    ) -> f64 {
        match &self.presence {
            Some(presence) => presence.for_side(side).fetch(point, level),
            None => self.presence_in_grid(profile, point, level),
        }
    }

    /// Returns the share of the kernel within the grid, regardless of missing voxels.
    pub(crate) fn presence_in_grid(&self, profile: &KernelProfile, point: DVec3, level: f64) -> f64 {
        let width = level.clamp(0.0, MAX_LEVEL as f64).exp2();
        let along = |axis: usize| {
            let n = self.scene.dims[axis] as f64;
            let before = share_of_half_space(profile, (point[axis] + 0.5) / width);
            let behind = share_of_half_space(profile, (n - 0.5 - point[axis]) / width);
            // The parts cut off at both ends overlap only if there are fewer voxels than a kernel covers.
            (before + behind - 1.0).max(0.0)
        };
        along(0) * along(1) * along(2)
    }

    /// Returns ∇ presence in index space: central differences over the stretched width of a voxel.
    fn presence_slope(&self, profile: &KernelProfile, point: DVec3, level: f64) -> DVec3 {
        let step = level.clamp(0.0, MAX_LEVEL as f64).exp2();
        if let Some(changes) = self.presence.as_ref().and_then(|presence| presence.changes.as_ref()) {
            return DVec3::from(changes.each_ref().map(|along| along.fetch(point, level))) / (2.0 * step);
        }
        let at = |point| self.presence(TransferSide::Eye, profile, point, level);
        let along = |axis: DVec3| (at(point + axis * step) - at(point - axis * step)) / (2.0 * step);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// Returns the gradient in scene space of a solid that ends at missing voxels.
    pub(crate) fn missing_gradient(&self, point: DVec3, level: f64) -> DVec3 {
        if self.presence.is_none() || self.classified.is_some() {
            return DVec3::ZERO;
        }
        let profile = self.profile(self.settings.sampling.kernel);
        self.scene.index_from_scene.matrix3.transpose() * self.presence_slope(&profile, point, level)
    }

    /// Returns the mean of `presence(point, level)` over slab `k` along the ray of pixel (i, j): at the points of the
    /// densities' quadrature, or for footprints integrated over the slab.
    pub(crate) fn slab_mean_presence(
        &self,
        frame: &SheetFrame,
        quadrature: SlabQuadrature,
        [i, j, k]: [f64; 3],
        presence: impl Fn(DVec3, f64) -> f64,
    ) -> f64 {
        let at = |offset: f64| {
            let depth = frame.depth_of(k) + offset * frame.slab;
            presence(frame.point(i, j, depth) + self.kernel_shift(), frame.stretch_level(depth))
        };
        if self.weights() == ReferenceWeights::Footprint {
            return quadrature_nodes().into_iter().map(|(offset, weight)| weight * at(offset)).sum();
        }
        let offsets = quadrature.offsets();
        offsets.iter().map(|&offset| at(offset)).sum::<f64>() / offsets.len() as f64
    }
}

/// Returns the share of the weights along an axis that lie on voxels 0, 1, 2 …, at a position `depth` voxels behind
/// the edge before voxel 0.
fn share_of_half_space(profile: &KernelProfile, depth: f64) -> f64 {
    let place = depth - 0.5;
    let first = place.floor() - 1.0;
    let weights: Vec<f64> = match profile.kernel {
        // The convolution of blur and tent covers the same four voxels.
        ReconstructionKernel::Prefiltered => {
            (0..4).map(|tap| profile.density_weight(place - first - f64::from(tap))).collect()
        }
        ReconstructionKernel::BSpline | ReconstructionKernel::Gaussian { .. } => {
            profile.four_weights(place - place.floor()).to_vec()
        }
    };
    let inside = |tap: usize| first + tap as f64 >= 0.0;
    let there: f64 =
        weights.iter().enumerate().filter(|(tap, _)| inside(*tap)).map(|(_, weight)| weight).sum();
    there / weights.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_a_kernel_lies_behind_an_edge() {
        let kernels = [
            ReconstructionKernel::BSpline,
            ReconstructionKernel::Gaussian { sigma: 0.6 },
            ReconstructionKernel::Prefiltered,
        ];
        for kernel in kernels {
            let profile = KernelProfile { kernel, width: 1.0 };
            let share = |depth| share_of_half_space(&profile, depth);
            assert!((share(0.0) - 0.5).abs() < 1e-12, "{kernel:?}");
            assert!((share(1.51) - 1.0).abs() < 1e-12 && share(-1.51).abs() < 1e-12, "{kernel:?}");
            for depth in [0.1, 0.4, 0.7, 1.2] {
                assert!((share(depth) + share(-depth) - 1.0).abs() < 1e-12, "{kernel:?} {depth}");
                assert!(share(depth) >= share(depth - 0.1), "{kernel:?} {depth}");
            }
        }
        // At the outermost voxel, the part of the kernel beyond it is missing.
        let on_voxel = |kernel| share_of_half_space(&KernelProfile { kernel, width: 1.0 }, 0.5);
        assert!((on_voxel(ReconstructionKernel::BSpline) - 5.0 / 6.0).abs() < 1e-12);
        assert!((on_voxel(ReconstructionKernel::Prefiltered) - 11.0 / 12.0).abs() < 1e-12);
    }
}
