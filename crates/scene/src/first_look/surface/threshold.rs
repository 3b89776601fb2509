//! Object threshold: the density at which a volume's object begins, by Otsu's method and the level of the border.

use rayon::prelude::*;

use super::super::histogram_above;
use super::isosurfaces::IsosurfaceStatistics;
use chiaroscuro_volume::{Histogram, Volume};

/// Position of the threshold between the background level (0) and Otsu's split (1): thin shells and legs, blurred by
/// the scanner, do not reach the split.
const SPLIT_WEIGHT: f64 = 0.65;

/// Smallest distance of the threshold above the background: five steps of 8-bit data.
pub(crate) const MIN_ABOVE_BACKGROUND: f64 = 0.02;

/// Returns the threshold for a background level `margin`, in data with Otsu's split at `split`.
pub(crate) fn threshold_above_margin(margin: f64, split: f64) -> f64 {
    (margin + SPLIT_WEIGHT * (split - margin)).max(margin + MIN_ABOVE_BACKGROUND)
}

/// Smallest increase of compactness from an object to its brighter part that may come of a rim of noise: of 22 scans
/// and simulations all lose compactness but one with such a rim, which gains 0.09.
const MIN_COMPACTNESS_GAIN: f64 = 0.02;

/// Smallest difference of voxels in such a rim from the mean of their neighbours, as root mean square and share of the
/// step from the rim to the brighter part: rims of noise have 0.36 and more, thin skins with a soft edge 0.19 and less,
/// also in noise.
const MIN_RIM_NOISE: f64 = 0.3;

/// Number of places where the noise of a rim is measured; larger volumes are subsampled.
const RIM_SAMPLES: usize = 1 << 21;

/// Smallest share of the object in its brighter part: the rest is a rim around it, and not the object itself.
const MIN_BRIGHT_SHARE: f64 = 0.25;

/// Boundary of an object in its values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ObjectThreshold {
    /// Density at which the object begins.
    pub(crate) start: f64,
    /// Increase of density per voxel at the boundary.
    pub(crate) slope: f64,
}

/// Finds the density at which the object begins, and its slope.
pub(crate) fn object_threshold(volume: &Volume, histogram: &Histogram) -> ObjectThreshold {
    let isosurfaces = IsosurfaceStatistics::measure(volume);
    let start = isosurfaces.threshold_avoiding_box(background_threshold(volume, histogram));
    let start = threshold_above_rim(volume, &isosurfaces, histogram, start);
    ObjectThreshold { start, slope: isosurfaces.slope(start).unwrap_or_default() }
}

/// Returns Otsu's split of the object's own values where what lies below is a rim of noise, as around maps of
/// anisotropy: thin, speckled, and less compact than the object within. Otherwise the threshold itself.
fn threshold_above_rim(
    volume: &Volume,
    isosurfaces: &IsosurfaceStatistics,
    histogram: &Histogram,
    start: f64,
) -> f64 {
    let own = otsu_threshold(&histogram_above(histogram, start));
    let gain = isosurfaces.compactness(own) - isosurfaces.compactness(start);
    let is_most = isosurfaces.inside(own) >= MIN_BRIGHT_SHARE * isosurfaces.inside(start);
    let is_rim = own > start && gain >= MIN_COMPACTNESS_GAIN && is_most;
    if is_rim && noise_between(volume, start, own) >= MIN_RIM_NOISE { own } else { start }
}

/// Returns the root mean square of the differences of voxels between two densities from the mean of their six
/// neighbours, as a share of the distance of those densities.
fn noise_between(volume: &Volume, low: f64, high: f64) -> f64 {
    let [nx, ny, nz] = volume.dims();
    let step = volume.voxel_count().div_ceil(RIM_SAMPLES).max(1);
    let square = |voxel: usize| {
        let place = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
        let is_inner = place.iter().zip([nx, ny, nz]).all(|(&at, count)| at > 0 && at + 1 < count);
        let here = volume.density_at(place).filter(|here| is_inner && (low..high).contains(here))?;
        let mut sum = 0.0;
        for (axis, side) in (0..3).flat_map(|axis| [-1, 1].map(|side| (axis, side))) {
            let mut beside = place;
            beside[axis] = place[axis].wrapping_add_signed(side);
            sum += volume.density_at(beside)?;
        }
        Some((here - sum / 6.0).powi(2))
    };
    let squares: Vec<f64> =
        (0..volume.voxel_count()).into_par_iter().step_by(step).filter_map(square).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt() / (high - low)
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
pub(crate) fn otsu_threshold(histogram: &Histogram) -> f64 {
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
pub(crate) fn border_level(volume: &Volume, level: impl Fn(f64) -> f64) -> f64 {
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

    const N: usize = 48;

    /// Returns a pseudo-random number between 0 and 1.
    fn random(at: usize) -> f64 {
        let mut state = (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        state = (state ^ (state >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a volume of values at distances from the centre.
    fn shells(value: impl Fn(f64, usize) -> f64) -> Volume {
        let radius =
            |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 23.5)).length();
        let samples = Samples::F32((0..N * N * N).map(|at| value(radius(at), at) as f32).collect());
        Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
    }

    /// Returns the value at which the object begins.
    fn start(volume: &Volume) -> f64 {
        volume.value_of(object_threshold(volume, &Histogram::from_volume(volume)).start)
    }

    #[test]
    fn rims_of_noise_are_left_out() {
        // White matter, grey matter, and a rim of which half is above that, in nothing.
        for noise in [0.5, 0.6, 0.7] {
            let map = shells(|r, at| match r {
                r if r < 14.0 => 0.6 + 0.2 * random(at),
                r if r < 18.0 => 0.1 + 0.1 * random(at),
                r if r < 20.0 => noise * random(at),
                _ => 0.0,
            });
            let found = start(&map);
            assert!(found > 0.3, "{noise}: {found}");
        }
    }

    #[test]
    fn skins_of_smooth_objects_stay() {
        // A head of brain, a dark skull, and a skin; with soft edges, with noise in all of it, and thin.
        for (name, noise, thickness) in [("smooth", 0.0, 3.0), ("noisy", 0.1, 3.0), ("thin", 0.05, 1.5)] {
            let edge = |r: f64, at: f64| 1.0 / (1.0 + (2.0 * (r - at)).exp());
            let head = shells(|r, at| {
                let skin = 0.5 * (edge(r, 20.0) - edge(r, 20.0 - thickness));
                0.8 * edge(r, 14.0) + skin + noise * random(at)
            });
            let found = start(&head);
            assert!(found < 0.4, "{name}: {found}");
        }
        // A ball with a soft edge, and one of noise all through.
        assert!(start(&shells(|r, _| 1.0 / (1.0 + (r - 15.0).exp()))) < 0.6);
        let noise = start(&shells(|r, at| if r < 15.0 { 0.5 + 0.5 * random(at) } else { 0.0 }));
        assert!(noise < 0.65, "{noise}");
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
