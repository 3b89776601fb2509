//! Transfer functions for grids of few slices, which are pictures: opaque grey, or both colours around zero.

use super::super::domain::DataDomain;
use super::super::palette::DomainPalette;
use super::{FirstTransfer, TransferStyle, quantile, sample_values, transfer_from_points};
use crate::ControlPoint;
use chiaroscuro_volume::{DataKind, Volume};

/// Largest number of slices of a picture: four, of which two are faces, have no inside to look for an object in.
const MAX_SLICES: usize = 4;

/// Smallest ratio of a picture's shorter edge to its number of slices, in voxels: a flat grid, not a small block.
const MIN_EDGE_RATIO: usize = 8;

/// Share of the voxels at either end that a picture may show as black and as white.
const CLIPPED_SHARE: f64 = 0.01;

/// Grey of zero in a picture of deviations, as pale as both colours begin.
const ZERO_COLOR: [f32; 3] = [0.93; 3];

/// Returns the axis across a picture, along which it has few slices; `None` for other grids. What counts are the
/// slices of the file, however many are averaged into one.
pub(crate) fn axis_across_picture(volume: &Volume) -> Option<usize> {
    let dims = volume.file_dims();
    let mut by_count = [0, 1, 2];
    by_count.sort_by_key(|&axis| dims[axis]);
    let [across, shorter, _] = by_count;
    let is_flat = dims[across] <= MAX_SLICES && dims[shorter] >= MIN_EDGE_RATIO * dims[across];
    is_flat.then_some(across)
}

/// Builds the function of a picture: all of it is opaque, and as bright as its values; `None` for other grids, for
/// masks and labels, which have colours, and for pictures of one value.
pub(super) fn find_picture(volume: &Volume, kind: DataKind) -> Option<FirstTransfer> {
    axis_across_picture(volume)?;
    if matches!(kind, DataKind::Mask | DataKind::LabelMap { .. }) {
        return None;
    }
    let values = sample_values(volume, Some);
    let [low, high] = [CLIPPED_SHARE, 1.0 - CLIPPED_SHARE].map(|share| quantile(&values, share));
    // A few bright spots on black are all there is of some pictures.
    let [low, high] = if low < high { [low, high] } else { [*values.first()?, *values.last()?] };
    let points = if kind == DataKind::Signed {
        let most = low.abs().max(high.abs());
        let color = |is_negative| DomainPalette::diverging(is_negative).color_at(1.0);
        vec![
            ControlPoint::new(-most, color(true), 1.0),
            ControlPoint::new(0.0, ZERO_COLOR, 1.0),
            ControlPoint::new(most, color(false), 1.0),
        ]
    } else {
        vec![ControlPoint::new(low, [0.0; 3], 1.0), ControlPoint::new(high, [1.0; 3], 1.0)]
    };
    let found = FirstTransfer::from_values(transfer_from_points(points), DataDomain::Unknown);
    (low < high).then_some(FirstTransfer { style: TransferStyle::Picture, ..found })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Settings;
    use crate::first_look::{first_settings, tests::ball};
    use chiaroscuro_volume::{Histogram, Samples};

    fn slices(dims: [usize; 3], value: impl Fn(usize) -> f64) -> Volume {
        let samples = Samples::F32((0..dims.iter().product()).map(|at| value(at) as f32).collect());
        Volume::with_spacing("t", dims, DVec3::new(0.5, 0.5, 5.0), samples).unwrap()
    }

    fn look(volume: &Volume) -> Settings {
        first_settings(volume, &Histogram::from_volume(volume))
    }

    /// Returns a value of noise between 0 and 1.
    fn noise(at: usize) -> f64 {
        ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / f64::from(1 << 24)
    }

    #[test]
    fn few_slices_are_opaque_and_as_bright_as_their_values() {
        for dims in [[40, 48, 1], [48, 40, 2], [64, 64, 4], [1, 40, 50], [40, 3, 50]] {
            let settings = look(&slices(dims, |at| 20.0 + 200.0 * noise(at)));
            let transfer = &settings.layer().transfer;
            for value in [25.0, 60.0, 120.0, 215.0] {
                assert!(transfer.opacity_at(value) > 0.99, "{dims:?} {value}");
            }
            let [dark, bright] = [40.0, 200.0].map(|value| transfer.sample(value).color[1]);
            assert!(dark < 0.2 && bright > 0.6, "{dims:?}: {dark} {bright}");
            assert!(!settings.shading.has_surfaces() || settings.shading.diffuse == 0.0, "no relief");
            // Seen from its front, or a little from above.
            let across = axis_across_picture(&slices(dims, |_| 0.0)).unwrap();
            let along = settings.camera.scene_from_view().z_axis.to_array()[across].abs();
            assert!(along > 0.9, "{dims:?}: {along}");
        }
    }

    #[test]
    fn deviations_in_few_slices_have_both_colors() {
        let wave = |at: usize| (0.3 * (at % 48) as f64).sin() * (0.2 * (at / 48 % 48) as f64).cos();
        let settings = look(&slices([48, 48, 2], wave));
        let transfer = &settings.layer().transfer;
        let [below, zero, above] = [-0.9, 0.0, 0.9].map(|value| transfer.sample(value).color);
        assert!(below[2] > below[0] && above[0] > above[2], "{below:?} {above:?}");
        assert!((zero[0] - zero[2]).abs() < 0.01 && transfer.opacity_at(0.0) > 0.99);
    }

    #[test]
    fn blocks_masks_and_labels_are_no_pictures() {
        for dims in [[4, 4, 4], [16, 16, 4], [40, 40, 5], [100, 1, 1]] {
            assert_eq!(axis_across_picture(&slices(dims, |_| 0.0)), None, "{dims:?}");
        }
        let mask = look(&slices([48, 48, 3], |at| f64::from(u8::from(at % 48 > 20))));
        assert_eq!(mask.layer().transfer.opacity_at(0.0), 0.0);
        assert_eq!(look(&ball(200.0, 0.0)).layer().transfer.opacity_at(0.0), 0.0);
        // One value alone is shown as ever.
        assert!(find_picture(&slices([48, 48, 3], |_| 7.0), DataKind::Scalar).is_none());
    }
}
