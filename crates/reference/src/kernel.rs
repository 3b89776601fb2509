//! Reconstruction kernels, as functions of one coordinate in voxels; in space a kernel is the product of three
//! (isotropic in index space). `h` of P eq. 10.

use chiaroscuro_scene::ReconstructionKernel;

/// Radius of the kernels, in voxels.
const RADIUS: f64 = 2.0;

/// Returns the cubic B-spline: a partition of unity with variance ⅓, zero from |t| = 2.
///
/// b₃(t) = ⅔ − t² + |t|³/2 up to 1, (2 − |t|)³/6 up to 2.
pub fn cubic_b_spline(t: f64) -> f64 {
    let t = t.abs();
    if t >= 2.0 {
        0.0
    } else if t >= 1.0 {
        (2.0 - t).powi(3) / 6.0
    } else {
        2.0 / 3.0 - t * t + t.powi(3) / 2.0
    }
}

/// Returns the derivative of [`cubic_b_spline`]: −sign(t) · (2|t| − 3t²/2) up to 1, −sign(t) · (2 − |t|)²/2 up to 2.
pub(super) fn cubic_b_spline_slope(t: f64) -> f64 {
    let d = t.abs();
    let fall = if d >= 2.0 {
        0.0
    } else if d >= 1.0 {
        (2.0 - d).powi(2) / 2.0
    } else {
        2.0 * d - 1.5 * d * d
    };
    -fall * t.signum()
}

/// Returns exp(−t²/2σ²), which is not normalised.
pub fn gaussian(t: f64, sigma: f64) -> f64 {
    (-t * t / (2.0 * sigma * sigma)).exp()
}

/// Returns the kernel of linear interpolation.
pub fn tent(t: f64) -> f64 {
    (1.0 - t.abs()).max(0.0)
}

/// Kernel of the settings along one axis, possibly widened by a [`super::ReferenceFault`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct KernelProfile {
    /// Kernel chosen in the settings.
    pub kernel: ReconstructionKernel,
    /// Width of the kernel relative to the correct one; 1 without a fault.
    pub width: f64,
}

impl KernelProfile {
    /// Returns the distance from the middle beyond which the kernel is zero.
    pub(super) fn reach(&self) -> f64 {
        RADIUS * self.width
    }

    /// Returns the reconstruction kernel of the paper's footprints: area 1, not normalised on the grid.
    pub(super) fn density_weight(&self, t: f64) -> f64 {
        let t = t / self.width;
        let value = match self.kernel {
            ReconstructionKernel::BSpline => cubic_b_spline(t),
            // (2π)^−½ σ⁻¹ exp(−t²/2σ²), cut at two voxels.
            ReconstructionKernel::Gaussian { sigma } if t.abs() < RADIUS => {
                gaussian(t, sigma) / (sigma * std::f64::consts::TAU.sqrt())
            }
            ReconstructionKernel::Gaussian { .. } => 0.0,
            // Convolution of the blur [1/12, 10/12, 1/12] with the tent.
            ReconstructionKernel::Prefiltered => (tent(t - 1.0) + 10.0 * tent(t) + tent(t + 1.0)) / 12.0,
        };
        value / self.width
    }

    /// Returns the weight of a sheet's pixel for a voxel of the light volume, to be divided by the sum of weights.
    pub(super) fn light_weight(&self, t: f64) -> f64 {
        let t = t / self.width;
        match self.kernel {
            ReconstructionKernel::BSpline => cubic_b_spline(t),
            ReconstructionKernel::Gaussian { sigma } if t.abs() < RADIUS => gaussian(t, sigma),
            ReconstructionKernel::Gaussian { .. } => 0.0,
            ReconstructionKernel::Prefiltered => tent(t),
        }
    }

    /// Returns the GPU's weights for the voxels ⌊p⌋ − 1 … ⌊p⌋ + 2, with `fraction` = p − ⌊p⌋. Those of the Gaussian
    /// are divided by their sum.
    pub(super) fn four_weights(&self, fraction: f64) -> [f64; 4] {
        let distances: [f64; 4] = std::array::from_fn(|tap| (fraction + 1.0 - tap as f64) / self.width);
        match self.kernel {
            ReconstructionKernel::Gaussian { sigma } => {
                let weights = distances.map(|t| gaussian(t, sigma));
                let sum: f64 = weights.iter().sum();
                weights.map(|weight| weight / sum)
            }
            ReconstructionKernel::BSpline | ReconstructionKernel::Prefiltered => {
                distances.map(|t| cubic_b_spline(t) / self.width)
            }
        }
    }
}

/// Returns eight-point Gauss–Legendre quadrature on [−½, ½]: (offset, weight), weights summing to 1. Exact to degree
/// 15; along an oblique ray a tensor B-spline has degree 9 between its knots.
pub(super) fn quadrature_nodes() -> [(f64, f64); 8] {
    const NODES: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
    ];
    std::array::from_fn(|n| {
        let (offset, weight) = NODES[n / 2];
        (if n % 2 == 0 { -offset / 2.0 } else { offset / 2.0 }, weight / 2.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [ReconstructionKernel; 3] = [
        ReconstructionKernel::BSpline,
        ReconstructionKernel::Gaussian { sigma: 0.6 },
        ReconstructionKernel::Prefiltered,
    ];

    #[test]
    fn footprint_kernels_have_area_one_and_the_same_width() {
        for kernel in KERNELS {
            let profile = KernelProfile { kernel, width: 1.0 };
            let moment = |power: i32| -> f64 {
                (-2000..2000)
                    .map(|n| (f64::from(n) + 0.5) / 1000.0)
                    .map(|t| profile.density_weight(t) * t.powi(power) / 1000.0)
                    .sum()
            };
            assert!((moment(0) - 1.0).abs() < 2e-3, "{kernel:?}: area {}", moment(0));
            assert!((moment(2) - 1.0 / 3.0).abs() < 0.03, "{kernel:?}: variance {}", moment(2));
        }
    }

    #[test]
    fn gather_weights_sum_to_one_unless_at_fault() {
        for kernel in [ReconstructionKernel::BSpline, ReconstructionKernel::Gaussian { sigma: 0.4 }] {
            for step in 0..10 {
                let weights = KernelProfile { kernel, width: 1.0 }.four_weights(f64::from(step) / 10.0);
                assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_quadrature_integrates_high_degrees() {
        let integral: f64 = quadrature_nodes().iter().map(|(x, w)| w * x.powi(14)).sum();
        // ∫ x¹⁴ over [−½, ½] = 2 · ½¹⁵ / 15.
        assert!((integral / (2.0 * 0.5f64.powi(15) / 15.0) - 1.0).abs() < 1e-9);
    }
}
