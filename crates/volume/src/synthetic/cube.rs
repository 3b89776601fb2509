//! Built-in volume `box`: a homogeneous cube with exact coverage, for comparisons with formulas.

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;

/// Half the edge of the cube, in units of p.
const HALF: f64 = 0.5;

/// Computes the voxels: 255 in |p|∞ ≤ ½, 0 outside, and on the faces scaled by the share of the voxel that is inside.
///
/// If n is divisible by four, the faces lie between voxels and every value is 0 or 255.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let coverage: Vec<f64> = (0..grid.n).map(|i| coverage(grid, i)).collect();
    grid.fill(context, control, |z, slice| {
        for (y, row) in slice.chunks_exact_mut(grid.n).enumerate() {
            for (x, voxel) in row.iter_mut().enumerate() {
                *voxel = (255.0 * (coverage[x] * coverage[y] * coverage[z])).round() as u8;
            }
        }
    })
}

/// Returns the share of voxel `i` that is inside the cube, along one axis.
fn coverage(grid: UnitGrid, i: usize) -> f64 {
    // Computed in index units, in which the edges are integers if n is divisible by four.
    let (low, high) = ((0.5 - HALF / 2.0) * grid.n as f64, (0.5 + HALF / 2.0) * grid.n as f64);
    (high.min(i as f64 + 1.0) - low.max(i as f64)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use crate::synthetic::builtin;

    #[test]
    fn faces_lie_between_voxels() {
        let volume = builtin("box", Some(16)).unwrap();
        for voxel in 0..16usize.pow(3) {
            let at = [voxel % 16, voxel / 16 % 16, voxel / 256];
            let inside = at.into_iter().all(|i| (4..12).contains(&i));
            assert_eq!(volume.samples().value(voxel), if inside { 255.0 } else { 0.0 }, "{at:?}");
        }
    }

    #[test]
    fn cut_voxels_hold_their_share() {
        // n = 10: the faces are at index 2.5 and 7.5.
        let volume = builtin("box", Some(10)).unwrap();
        assert_eq!(volume.value(2, 5, 5), 128.0);
        assert_eq!(volume.value(2, 2, 5), 64.0);
        assert_eq!(volume.value(7, 7, 7), 32.0);
        assert_eq!(volume.value(1, 5, 5), 0.0);
        assert_eq!(volume.value(3, 6, 5), 255.0);
    }
}
