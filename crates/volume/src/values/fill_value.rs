//! Detection of fill values that a file does not declare: numbers that programs write where nothing was measured.

use super::robust::{has_few_distinct, sampled_values, sorted_samples};
use crate::{Samples, ValueRanges, VoxelType};

/// Smallest share of voxels that hold a fill value, and smallest share of others; fewer are outliers.
const MIN_FILL_SHARE: f64 = 0.01;
const MIN_OTHER_SHARE: f64 = 0.05;

/// Smallest distance of a conventional fill value from all others, in their range: air is nearer to the tissues of a
/// scan, and so is the padding of scanners (−3024 beside −1000 … 3071).
const MIN_CONVENTIONAL_GAP: f64 = 1.0;

/// Smallest distance of any other fill value. A background of one value is a few ranges away from an object without
/// edges; beyond a thousand, nothing that is measured shows beside it.
const MIN_OTHER_GAP: f64 = 1000.0;

/// Share of the other values at either end that count as outliers when their range is measured.
const OUTLIER_SHARE: f64 = 0.001;

/// Default fill value of netCDF for floats, 15 · 2¹¹⁹.
const NETCDF_FILL: f64 = 9.969_209_968_386_869e36;

/// Returns the value at an end of the range that stands for nothing: many voxels hold it, and it is far from all
/// others. `None` if there is none; 0 is never one, and 8 bits have no room for one.
pub fn find_fill_value(samples: &Samples, ranges: &ValueRanges) -> Option<f64> {
    if matches!(samples.voxel_type(), VoxelType::U8 | VoxelType::I8) {
        return None;
    }
    let (all, robust) = (ranges.all, ranges.robust);
    // The robust range is without it, and cheap to know.
    let low = (all.low < robust.low).then_some(all.low);
    let high = (all.high > robust.high).then_some(all.high);
    low.into_iter().chain(high).find(|&value| is_fill_value(samples, value))
}

fn is_fill_value(samples: &Samples, value: f64) -> bool {
    let others = sorted_samples(samples, value);
    let count = sampled_values(samples, f64::NAN).len() as f64;
    let share = others.len() as f64 / count.max(1.0);
    // Values of masks and labels have no distances.
    if value == 0.0 || !(MIN_OTHER_SHARE..=1.0 - MIN_FILL_SHARE).contains(&share) || has_few_distinct(&others)
    {
        return false;
    }
    let outliers = (OUTLIER_SHARE * others.len() as f64) as usize;
    let (low, high) = (others[outliers], others[others.len() - 1 - outliers]);
    let gap = if value < low { low - value } else { value - high };
    let least = if is_conventional(value) { MIN_CONVENTIONAL_GAP } else { MIN_OTHER_GAP };
    gap >= least * (high - low)
}

/// Returns true for numbers that programs write for nothing: ends of number types, 999 and longer rows of nines, high
/// powers of ten, and the fill value of netCDF.
fn is_conventional(value: f64) -> bool {
    let magnitude = value.abs();
    let is_near = |other: f64| (magnitude - other).abs() <= 1e-6 * other;
    let ends = [32767.0, 32768.0, 65535.0, 2_147_483_647.0, 2_147_483_648.0, 4_294_967_295.0];
    let is_end = ends.contains(&magnitude) || is_near(f64::from(f32::MAX)) || is_near(NETCDF_FILL);
    let are_nines = (3..=9).any(|digits| magnitude == 10f64.powi(digits) - 1.0);
    is_end || are_nines || (5..=38).any(|exponent| is_near(10f64.powi(exponent)))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Volume;

    const N: usize = 20;

    /// Returns two blobs in a ball, and a value outside it.
    fn blobs(fill: f64) -> Vec<f64> {
        let blob = |p: DVec3, x: f64| 200.0 * (-(p - x * DVec3::X).length_squared() / 0.05).exp();
        let place = |at: usize| DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 / 9.5 - 1.0));
        let value = |p: DVec3| if p.length() > 0.95 { fill } else { blob(p, 0.4) + blob(p, -0.4) };
        (0..N.pow(3)).map(|at| value(place(at))).collect()
    }

    fn found(samples: Samples) -> Option<f64> {
        let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        find_fill_value(volume.samples(), &volume.ranges())
    }

    #[test]
    fn numbers_for_nothing_are_found_on_either_side() {
        let largest = f64::from(f32::MAX);
        for fill in [1e20, -1e30, NETCDF_FILL, largest, -largest, 99999.0, -999.0, -9999.0, 32767.0, -32768.0]
        {
            assert_eq!(found(Samples::F64(blobs(fill))), Some(fill), "{fill}");
            let floats = blobs(fill).iter().map(|&value| value as f32).collect();
            assert_eq!(found(Samples::F32(floats)), Some(f64::from(fill as f32)), "{fill}");
        }
        for (fill, whole) in [(-999.0, -999), (32767.0, 32767), (-32768.0, -32768)] {
            let words = blobs(fill).iter().map(|&value| value.round() as i16).collect();
            assert_eq!(found(Samples::I16(words)), Some(f64::from(whole)));
        }
        let words = blobs(65535.0).iter().map(|&value| value.round() as u16).collect();
        assert_eq!(found(Samples::U16(words)), Some(65535.0));
        // Nobody's convention, but a million times as far as all others.
        assert_eq!(found(Samples::F64(blobs(-3.3e8))), Some(-3.3e8));
    }

    #[test]
    fn backgrounds_air_and_bright_objects_are_measured() {
        // Zero, air, the padding of scanners, and numbers nearer than the range of the others.
        for background in [0.0, -1000.0, -1024.0, -250.0, 999.0 / 8.0, 700.0] {
            assert_eq!(found(Samples::F64(blobs(background))), None, "{background}");
        }
        // Tissues in Hounsfield units beside the padding of a scanner.
        let scan = |value: &f64| if *value == -1.0 { -3024.0 } else { value * 12.0 - 1000.0 };
        assert_eq!(found(Samples::F64(blobs(-1.0).iter().map(scan).collect())), None);
        // An object without edges in a background of one value, and zero far below.
        let solid = |value: &f64| if *value == 0.0 { 0.0 } else { 60_000.0 + value };
        assert_eq!(found(Samples::F64(blobs(0.0).iter().map(solid).collect())), None);
        let object = |value: &f64| if *value == -1.0 { -1000.0 } else { 1200.0 + value };
        assert_eq!(found(Samples::F64(blobs(-1.0).iter().map(object).collect())), None);
        // Few voxels are outliers; of few values, they are labels.
        let mut hot = blobs(0.0);
        hot[N * N * N / 2] = 1e20;
        assert_eq!(found(Samples::F64(hot)), None);
        let labels =
            blobs(65535.0).into_iter().map(|value| if value > 1e4 { 65535 } else { (value / 50.0) as u16 });
        assert_eq!(found(Samples::U16(labels.collect())), None);
    }
}
