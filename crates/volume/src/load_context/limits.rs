//! Limits of volumes: the memory budget, and the range of usable voxel spacings.

use glam::DAffine3;

use super::free_memory::free_bytes;

/// Memory budget if the system does not report its free memory.
const FALLBACK_BUDGET_BYTES: u64 = 4 << 30;

/// Range of usable voxel spacings; values outside it are mistakes, and would upset every computation.
const SPACING_RANGE_MM: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// Maximum ratio of voxel spacings along two axes: slices 1 mm apart with pixels of 0.1 µm. Steps through the volume
/// are as short as the shortest spacing, so their number grows with this ratio.
const MAX_SPACING_RATIO: f64 = 1e4;

/// Returns true if a voxel spacing is within the usable range.
pub fn is_usable_spacing(spacing_mm: f64) -> bool {
    SPACING_RANGE_MM.contains(&spacing_mm)
}

/// Returns the reason why the voxel spacings along the three axes cannot be combined, if their ratio is too large.
pub fn spacing_ratio_error(spacings_mm: [f64; 3]) -> Option<String> {
    let shortest = spacings_mm.into_iter().fold(f64::INFINITY, f64::min);
    let longest = spacings_mm.into_iter().fold(0.0, f64::max);
    (longest > MAX_SPACING_RATIO * shortest).then(|| {
        format!("{longest} mm is more than {MAX_SPACING_RATIO} times {shortest} mm between voxels along another axis")
    })
}

/// Returns true if an affine transform has usable, linearly independent axes and a finite origin.
pub fn is_usable_affine(world_from_index: &DAffine3) -> bool {
    let axes = world_from_index.matrix3;
    let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(glam::DVec3::length);
    let flatness = axes.determinant().abs() / lengths.iter().product::<f64>();
    world_from_index.is_finite() && lengths.into_iter().all(is_usable_spacing) && flatness > 1e-6
}

/// Returns three quarters of the memory still available, or 4 GiB if that is unknown.
pub fn memory_budget_bytes() -> u64 {
    free_bytes().map_or(FALLBACK_BUDGET_BYTES, |free| free / 4 * 3)
}

/// Formats a number of bytes for a message: exact when small, otherwise in the largest unit that fits.
pub fn human_bytes(bytes: u128) -> String {
    const UNITS: [&str; 6] = ["KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    if bytes < 10 * 1024 {
        return format!("{bytes} bytes");
    }
    let mut value = bytes as f64 / 1024.0;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if value >= 1e6 {
        format!("more than 1000000 {}", UNITS[unit])
    } else {
        format!("{value:.1} {}", UNITS[unit])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_budget_follows_the_free_memory() {
        assert!(memory_budget_bytes() > 0);
    }

    #[test]
    fn distances_between_voxels_are_alike() {
        assert_eq!(spacing_ratio_error([1e-3, 10.0, 1.0]), None);
        assert!(spacing_ratio_error([1e-9, 1e9, 1.0]).is_some_and(|why| why.contains("10000 times")));
    }

    #[test]
    fn bytes_read_well() {
        assert_eq!(human_bytes(100), "100 bytes");
        assert_eq!(human_bytes(3 << 29), "1.5 GiB");
        assert_eq!(human_bytes(2_000_000_000_000_000_000), "1.7 EiB");
        assert_eq!(human_bytes(u128::MAX), "more than 1000000 EiB");
    }
}
