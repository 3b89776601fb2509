//! Transfer functions for distance fields: distances from a surface, signed by the side, which are shown at zero.

use glam::DVec3;

use super::super::domain::DataDomain;
use super::super::palette::MASK_COLOR;
use super::{FirstTransfer, TransferStyle, quantile, sample_values, transfer_from_points};
use crate::{ControlPoint, srgb_from_lch};
use chiaroscuro_volume::Volume;

/// Number of voxels whose gradients are measured; larger volumes are subsampled.
const SAMPLED_GRADIENTS: usize = 1 << 16;

/// Largest deviation of the median slope of distances from 1, and the largest ratio of its quartiles: a computed
/// distance field has 1.02 and 1.001, one that was stored with rounding a few hundredths more. The quartiles of other
/// fields have ratios of 1.9 and more.
const MAX_SLOPE_ERROR: f64 = 0.06;
const MAX_QUARTILE_RATIO: f64 = 1.12;

/// Length of the mean direction of gradients above which a field is a ramp along one direction, as coordinates are:
/// around anything with sides, directions cancel out.
const MAX_COMMON_DIRECTION: f64 = 0.9;

/// Smallest share of voxels on the side that is shown: a ball of ten voxels' diameter in a volume of 100 voxels' edge
/// has as much.
const MIN_OBJECT_SHARE: f64 = 0.0005;

/// Half the width of the surface's opacity ramp, in voxels: a surface, not so sharp that voxels show.
const RAMP_HALF_WIDTH: f64 = 0.5;

/// Builds a function that shows one side of zero; `None` if values are no distances.
pub(super) fn find_distance_field(volume: &Volume) -> Option<FirstTransfer> {
    let voxel = voxel_distance(volume)?;
    let range = volume.value_range();
    // Without a sign, the surface itself is all there is.
    let level = if range.low < 0.0 { 0.0 } else { range.low + RAMP_HALF_WIDTH * voxel };
    let values = sample_values(volume, Some);
    let below = values.partition_point(|&value| value < level) as f64 / values.len().max(1) as f64;
    let touched = faces_touched(volume, level);
    // The inside touches no face; if neither side does, or both, it is the negative one.
    let is_below = touched[0] == 0 || touched[1] > 0;
    let share = if is_below { below } else { 1.0 - below };
    if !(MIN_OBJECT_SHARE..=1.0 - MIN_OBJECT_SHARE).contains(&share) {
        return None;
    }
    let (color, sign) = (srgb_from_lch(MASK_COLOR), if is_below { 1.0 } else { -1.0 });
    let point = |voxels: f64, opacity| ControlPoint::new(level + sign * voxels * voxel, color, opacity);
    let deepest = if is_below { range.low } else { range.high };
    let points = vec![
        ControlPoint::new(
            if is_below { deepest.min(level - voxel) } else { deepest.max(level + voxel) },
            color,
            0.95,
        ),
        point(-RAMP_HALF_WIDTH, 0.9),
        point(RAMP_HALF_WIDTH, 0.0),
    ];
    let found = FirstTransfer::from_values(transfer_from_points(points), DataDomain::Unknown);
    Some(FirstTransfer { style: TransferStyle::KnownObject, ..found })
}

/// Returns the distance in data units that corresponds to the smallest edge of a voxel, if the field's slope is 1
/// everywhere, per voxel or per unit of the spacing; `None` for other fields.
fn voxel_distance(volume: &Volume) -> Option<f64> {
    let dims = volume.dims();
    if dims.iter().any(|&n| n < 5) {
        return None;
    }
    let gradients = sampled_gradients(volume);
    if gradients.is_empty() {
        return None;
    }
    let spacing = volume.spacing_mm();
    let units = [DVec3::ONE, spacing, spacing / volume.length_unit().mm()];
    units.into_iter().find(|unit| has_unit_slope(&gradients, *unit)).map(DVec3::min_element)
}

/// Returns true if gradients, in values per voxel, have a length of 1 with this length of voxels, and no common
/// direction.
fn has_unit_slope(gradients: &[DVec3], voxel: DVec3) -> bool {
    let mut slopes: Vec<f64> = gradients.iter().map(|gradient| (*gradient / voxel).length()).collect();
    slopes.sort_unstable_by(f64::total_cmp);
    let [first, median, third] = [0.25, 0.5, 0.75].map(|share| quantile(&slopes, share));
    let sum: DVec3 = gradients.iter().map(|gradient| (*gradient / voxel).normalize_or_zero()).sum();
    (median - 1.0).abs() <= MAX_SLOPE_ERROR
        && third <= MAX_QUARTILE_RATIO * first
        && sum.length() / gradients.len() as f64 <= MAX_COMMON_DIRECTION
}

/// Returns gradients by central differences, in values per voxel, at evenly spread places whose neighbours are there.
fn sampled_gradients(volume: &Volume) -> Vec<DVec3> {
    let [nx, ny, nz] = volume.dims();
    let step = volume.voxel_count().div_ceil(SAMPLED_GRADIENTS).max(1);
    let at = |x: usize, y: usize, z: usize| {
        let voxel = (z * ny + y) * nx + x;
        let is_missing = volume.missing().is_some_and(|missing| missing.contains(voxel));
        (!is_missing).then(|| volume.samples().value(voxel))
    };
    let inner = [nx - 2, ny - 2, nz - 2];
    (0..inner.iter().product())
        .step_by(step)
        .filter_map(|place: usize| {
            let [x, y, z] =
                [place % inner[0] + 1, place / inner[0] % inner[1] + 1, place / (inner[0] * inner[1]) + 1];
            let along = [
                at(x + 1, y, z)? - at(x - 1, y, z)?,
                at(x, y + 1, z)? - at(x, y - 1, z)?,
                at(x, y, z + 1)? - at(x, y, z - 1)?,
            ];
            Some(DVec3::from(along) / 2.0)
        })
        .collect()
}

/// Returns the numbers of faces of the volume with values below a level, and with values from it on.
fn faces_touched(volume: &Volume, level: f64) -> [usize; 2] {
    let mut touched = [0; 2];
    for face in 0..6 {
        let mut has = [false; 2];
        for voxel in volume.face_voxels(face, usize::MAX) {
            has[usize::from(volume.samples().value(voxel) >= level)] = true;
        }
        touched.iter_mut().zip(has).for_each(|(count, has)| *count += usize::from(has));
    }
    touched
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TransferFunction;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Histogram, Samples};

    const N: usize = 32;

    fn field(spacing: DVec3, value: impl Fn(DVec3) -> f64) -> Volume {
        let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5));
        let samples = Samples::F32((0..N * N * N).map(|at| value(place(at) * spacing) as f32).collect());
        Volume::with_spacing("t", [N; 3], spacing, samples).unwrap()
    }

    fn transfer(volume: &Volume) -> TransferFunction {
        first_settings(volume, &Histogram::from_volume(volume)).layer().transfer.clone()
    }

    /// Returns the distance from a torus.
    fn torus(p: DVec3) -> f64 {
        glam::DVec2::new(p.truncate().length() - 9.0, p.z).length() - 4.0
    }

    #[test]
    fn distances_are_shown_at_zero_on_the_side_that_touches_no_face() {
        for sign in [1.0, -1.0] {
            let shown = transfer(&field(DVec3::ONE, |p| sign * torus(p)));
            let opacity = |distance: f64| shown.opacity_at(sign * distance);
            assert!(opacity(-2.0) > 0.85 && opacity(-3.9) > 0.85, "{sign}");
            assert!(opacity(1.0) == 0.0 && opacity(9.0) == 0.0, "{sign}");
            let surface = opacity(0.0);
            assert!((0.3..0.7).contains(&surface), "{sign}: {surface}");
        }
        // In millimetres, on a grid of other and of unequal distances.
        for spacing in [DVec3::splat(0.25), DVec3::new(0.5, 0.5, 1.0)] {
            let volume = field(spacing, |p| 0.3 * torus(p / 0.3));
            let shown = transfer(&volume);
            assert!(shown.opacity_at(-1.0) > 0.85 && shown.opacity_at(1.0) == 0.0, "{spacing}");
        }
        // Distances from the outside, without a sign.
        let unsigned = transfer(&field(DVec3::ONE, |p| torus(p).max(0.0)));
        assert!(unsigned.opacity_at(0.0) > 0.4 && unsigned.opacity_at(3.0) == 0.0);
    }

    #[test]
    fn other_smooth_fields_are_no_distances() {
        let fields: [(&str, &dyn Fn(DVec3) -> f64); 6] = [
            ("coordinate", &|p| p.x),
            ("squared distance", &|p| p.length_squared() / 20.0),
            ("distance from a point", &|p| p.length()),
            ("twice the distance", &|p| 2.0 * torus(p)),
            ("waves", &|p| 3.0 * (0.5 * p.x).sin() * (0.4 * p.y).cos()),
            ("hill", &|p| 20.0 * (-p.length_squared() / 120.0).exp()),
        ];
        for (name, value) in fields {
            assert!(find_distance_field(&field(DVec3::ONE, value)).is_none(), "{name}");
        }
    }
}
