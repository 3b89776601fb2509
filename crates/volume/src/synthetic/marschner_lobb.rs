//! Built-in volume `marschner-lobb`: the Marschner–Lobb signal, a standard test of reconstruction filters.
//!
//! S. Marschner, R. Lobb, "An evaluation of reconstruction filters for volume rendering", IEEE Visualization 1994. At
//! 40³ voxels nearly all of its energy is just below the Nyquist frequency.

use std::f64::consts::PI;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;

/// Amplitude α of the ripple.
const ALPHA: f64 = 0.25;

/// Frequency fM of the ripple.
const F_M: f64 = 6.0;

/// Computes ρ(p), in [0, 1], at the voxel centres of [-1, 1]³.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<f32>, LoadError> {
    let centres: Vec<f64> = (0..grid.n).map(|i| grid.centre(i)).collect();
    // The ripple depends only on x and y: one plane of it serves all slices.
    let radius = |x: f64, y: f64| (x * x + y * y).sqrt();
    let ripples: Vec<f64> =
        centres.iter().flat_map(|&y| centres.iter().map(move |&x| ripple(radius(x, y)))).collect();
    grid.fill(context, control, |z, slice| {
        for (voxel, ripple) in slice.iter_mut().zip(&ripples) {
            *voxel = density(centres[z], *ripple) as f32;
        }
    })
}

/// Returns ρᵣ(r) = cos(2π fM cos(πr/2)).
fn ripple(r: f64) -> f64 {
    (2.0 * PI * F_M * (PI * r / 2.0).cos()).cos()
}

/// Returns ρ = (1 − sin(πz/2) + α (1 + ρᵣ)) / (2 (1 + α)).
fn density(z: f64, ripple: f64) -> f64 {
    (1.0 - (PI * z / 2.0).sin() + ALPHA * (1.0 + ripple)) / (2.0 * (1.0 + ALPHA))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::builtin;
    use crate::{ValueRange, VoxelType};

    #[test]
    fn known_values() {
        assert!((density(0.0, ripple(0.0)) - 0.6).abs() < 1e-12);
        assert!((density(0.0, ripple(1.0)) - 0.6).abs() < 1e-12);
        assert!(density(1.0, -1.0).abs() < 1e-12);
        assert!((density(-1.0, 1.0) - 1.0).abs() < 1e-12);
        let volume = builtin("marschner-lobb", Some(9)).unwrap();
        assert_eq!(volume.samples().voxel_type(), VoxelType::F32);
        assert!((volume.value(4, 4, 4) - 0.6).abs() < 1e-6);
        let ValueRange { low, high } = volume.value_range();
        assert!(low >= 0.0 && high <= 1.0);
    }
}
