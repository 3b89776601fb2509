//! Object threshold: the density at which a volume's object begins, by Otsu's method and the level of the border.

use super::isosurfaces::IsosurfaceStatistics;
use chiaroscuro_volume::{Histogram, Volume};

/// Position of the threshold between the background level (0) and Otsu's split (1): thin shells and legs, blurred by
/// the scanner, do not reach the split.
const SPLIT_WEIGHT: f64 = 0.65;

/// Smallest distance of the threshold above the background: five steps of 8-bit data.
pub(super) const MIN_ABOVE_BACKGROUND: f64 = 0.02;

/// Returns the threshold for a background level `margin`, in data with Otsu's split at `split`.
pub(super) fn threshold_above_margin(margin: f64, split: f64) -> f64 {
    (margin + SPLIT_WEIGHT * (split - margin)).max(margin + MIN_ABOVE_BACKGROUND)
}

/// Boundary of an object in its values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ObjectThreshold {
    /// Density at which the object begins.
    pub(super) start: f64,
    /// Increase of density per voxel at the boundary.
    pub(super) slope: f64,
}

/// Finds the density at which the object begins, and its slope.
pub(super) fn object_threshold(volume: &Volume, histogram: &Histogram) -> ObjectThreshold {
    let isosurfaces = IsosurfaceStatistics::measure(volume);
    let start = isosurfaces.threshold_avoiding_box(background_threshold(volume, histogram));
    ObjectThreshold { start, slope: isosurfaces.slope(start).unwrap_or_default() }
}

/// Returns the threshold between the background and Otsu's split.
fn background_threshold(volume: &Volume, histogram: &Histogram) -> f64 {
    let split = otsu_threshold(histogram);
    let background = border_level(volume, |density| density);
    // An object that reaches the border on most sides has no margin to measure; nor has a volume whose border is
    // brighter than the split: that border belongs to the object.
    if split <= background && background < histogram.percentile(0.9) {
        return split;
    }
    let margin = if background < split { background } else { 0.0 };
    // The split lies halfway to the object's bulk; its thin parts are dimmer, down to the margin's noise. The ceiling
    // ensures that something is left.
    let ceiling = histogram.percentile(0.995).max(MIN_ABOVE_BACKGROUND);
    threshold_above_margin(margin, split).min(ceiling)
}

/// Number of voxels in the smaller class that must not affect Otsu's split.
const NEGLIGIBLE_VOXELS: f64 = 4.0;

/// Returns the density that splits the histogram into the two most compact classes (Otsu's method). Of splits that
/// are equally good but for a few voxels, as between two distant classes, the lowest.
pub(super) fn otsu_threshold(histogram: &Histogram) -> f64 {
    let bins = histogram.counts.len() as f64;
    let (total, sum) = histogram
        .counts
        .iter()
        .enumerate()
        .fold((0.0, 0.0), |(n, s), (bin, &count)| (n + count as f64, s + bin as f64 * count as f64));
    let (mut below, mut sum_below) = (0.0, 0.0);
    let (mut best, mut smaller, mut splits) = (0.0, 1.0, Vec::new());
    for (bin, &count) in histogram.counts.iter().enumerate() {
        below += count as f64;
        sum_below += bin as f64 * count as f64;
        let above = total - below;
        if below == 0.0 || above == 0.0 {
            continue;
        }
        let difference = sum_below / below - (sum - sum_below) / above;
        let between = below * above * difference * difference;
        splits.push((bin, between));
        if between > best {
            (best, smaller) = (between, f64::min(below, above));
        }
    }
    let accepted = best * (1.0 - (NEGLIGIBLE_VOXELS / smaller).min(1.0));
    let first = splits.into_iter().find(|(_, between)| *between >= accepted).map_or(0, |(bin, _)| bin);
    (first as f64 + 1.0) / bins
}

/// Returns the level of the volume's border, in densities transformed by `level`: the median of the six faces' 98th
/// percentiles. One or two faces that cut through the object do not matter. Missing voxels do not count, and a border
/// without any voxels has level 0.
pub(super) fn border_level(volume: &Volume, level: impl Fn(f64) -> f64) -> f64 {
    let [nx, ny, nz] = volume.dims();
    let face = |u: usize, v: usize, at: &dyn Fn(usize, usize) -> [usize; 3]| {
        // A sample of at most 128² voxels per face is enough.
        let (du, dv) = (u.div_ceil(128), v.div_ceil(128));
        let mut levels: Vec<f64> = (0..u)
            .step_by(du)
            .flat_map(|i| (0..v).step_by(dv).map(move |j| (i, j)))
            .filter_map(|(i, j)| volume.density_at(at(i, j)).map(&level))
            .collect();
        levels.sort_by(f64::total_cmp);
        let last = levels.len().checked_sub(1)?;
        Some(levels[last * 98 / 100])
    };
    let faces = [
        face(ny, nz, &|i, j| [0, i, j]),
        face(ny, nz, &|i, j| [nx - 1, i, j]),
        face(nx, nz, &|i, j| [i, 0, j]),
        face(nx, nz, &|i, j| [i, ny - 1, j]),
        face(nx, ny, &|i, j| [i, j, 0]),
        face(nx, ny, &|i, j| [i, j, nz - 1]),
    ];
    let mut levels: Vec<f64> = faces.into_iter().flatten().collect();
    levels.sort_by(f64::total_cmp);
    let Some(last) = levels.len().checked_sub(1) else { return 0.0 };
    f64::midpoint(levels[last / 2], levels[last.div_ceil(2)])
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::domain::roughness;
    use chiaroscuro_volume::Samples;

    /// Returns a ramp along x from 100 on, in a margin of padding that is two voxels wide.
    fn padded(n: usize, padding: i16) -> Volume {
        let value = |at: usize| {
            let place = [at % n, at / n % n, at / n / n];
            if place.iter().all(|&c| (2..n - 2).contains(&c)) { 100 + at as i16 % 20 } else { padding }
        };
        let samples = Samples::I16((0..n * n * n).map(value).collect());
        Volume::with_spacing("padded", [n; 3], DVec3::ONE, samples).unwrap()
    }

    #[test]
    fn what_is_missing_is_no_border_and_has_no_texture() {
        let whole = padded(20, -2000);
        let volume = whole.clone().with_padding(-2000.0).unwrap();
        // As bright as possible, if it counted.
        let bright = padded(20, 2000).with_padding(2000.0).unwrap();
        for volume in [&volume, &bright] {
            assert_eq!(border_level(volume, |density| density), 0.0);
            assert!(roughness(volume) < 1e-3, "{}", roughness(volume));
            assert!(IsosurfaceStatistics::measure(volume).threshold_avoiding_box(0.5) == 0.5);
        }
        assert!(roughness(&whole) > 0.1, "{}", roughness(&whole));
    }
}
