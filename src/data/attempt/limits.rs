//! Sizes checked before anything is allocated.

use glam::DAffine3;

use super::error::{Attempt, LoadError};
use super::free_memory::free_bytes;
use crate::data::VoxelType;

/// The budget where the system does not say how much memory it has.
const FALLBACK_BUDGET_BYTES: u64 = 4 << 30;

/// Distances between voxels outside this range are mistakes, and would upset every computation.
const SPACING_RANGE_MM: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// How much longer one distance between voxels may be than another: that of slices a millimetre apart to pixels of 0.1 µm.
/// Steps through the volume are as short as the shortest, so that their number grows with this.
const MAX_SPACING_RATIO: f64 = 1e4;

/// The size of a grid that fits into the memory budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data) struct Extent {
    /// Voxels along x, y, z, none of them 0.
    pub(in crate::data) dims: [usize; 3],
    /// Their product.
    pub(in crate::data) voxels: usize,
    /// Bytes of all voxels.
    pub(in crate::data) bytes: u64,
}

impl Extent {
    /// Checks `dims`, which `field` gave, against zero, overflow and the budget.
    pub(in crate::data) fn checked(
        attempt: Attempt<'_>,
        field: &str,
        dims: [u64; 3],
        voxel_type: VoxelType,
        budget_bytes: u64,
    ) -> Result<Self, LoadError> {
        let [x, y, z] = dims;
        if dims.contains(&0) {
            return Err(attempt.bad_input(
                field,
                format!("{x} x {y} x {z} voxels are an empty volume"),
                "every dimension must be at least 1",
            ));
        }
        // Three 64-bit factors can leave even 128 bits; saturated they still are over any budget.
        let voxels = dims.iter().fold(1u128, |product, &n| product.saturating_mul(u128::from(n)));
        let bytes = voxels.saturating_mul(voxel_type.bytes() as u128);
        let too_large = || {
            attempt.limit(
                field,
                format!(
                    "{x} x {y} x {z} voxels of {} need {}, {} are allowed",
                    voxel_type.name(),
                    human_bytes(bytes),
                    human_bytes(u128::from(budget_bytes))
                ),
                "check the dimensions, close other programs, or load a smaller or cropped volume",
            )
        };
        if bytes > u128::from(budget_bytes) {
            return Err(too_large());
        }
        // On a 32-bit system the budget may be larger than what can be addressed.
        let narrow = |n: u64| usize::try_from(n).ok();
        match (narrow(x), narrow(y), narrow(z), usize::try_from(voxels).ok(), u64::try_from(bytes).ok()) {
            (Some(x), Some(y), Some(z), Some(voxels), Some(bytes)) => {
                Ok(Self { dims: [x, y, z], voxels, bytes })
            }
            _ => Err(too_large()),
        }
    }
}

/// Whether a distance between voxels can be used.
pub(in crate::data) fn is_usable_spacing(spacing_mm: f64) -> bool {
    SPACING_RANGE_MM.contains(&spacing_mm)
}

/// Why the distances between voxels along three axes cannot be used together.
pub(in crate::data) fn unlike_spacings(spacings_mm: [f64; 3]) -> Option<String> {
    let shortest = spacings_mm.into_iter().fold(f64::INFINITY, f64::min);
    let longest = spacings_mm.into_iter().fold(0.0, f64::max);
    (longest > MAX_SPACING_RATIO * shortest).then(|| {
        format!("{longest} mm is more than {MAX_SPACING_RATIO} times {shortest} mm between voxels along another axis")
    })
}

/// Whether an affine has usable, independent axes and a finite origin.
pub(in crate::data) fn is_usable_affine(world_from_index: &DAffine3) -> bool {
    let axes = world_from_index.matrix3;
    let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(glam::DVec3::length);
    let flatness = axes.determinant().abs() / lengths.iter().product::<f64>();
    world_from_index.is_finite() && lengths.into_iter().all(is_usable_spacing) && flatness > 1e-6
}

/// Three quarters of the memory that may still be taken, or 4 GiB where that is not known.
pub(crate) fn default_budget_bytes() -> u64 {
    free_bytes().map_or(FALLBACK_BUDGET_BYTES, |free| free / 4 * 3)
}

/// A number of bytes for a message: exact when small, else in the largest unit that fits.
pub(in crate::data) fn human_bytes(bytes: u128) -> String {
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
    use std::path::Path;

    use super::super::error::LoadErrorKind;
    use super::*;

    fn kind_of(dims: [u64; 3], budget: u64) -> Result<Extent, LoadErrorKind> {
        let attempt = Attempt { what: "test", path: Path::new("t") };
        Extent::checked(attempt, "sizes", dims, VoxelType::U16, budget).map_err(|error| error.kind())
    }

    #[test]
    fn sizes_are_checked_without_overflow() {
        let ok = Extent { dims: [2, 3, 4], voxels: 24, bytes: 48 };
        assert_eq!(kind_of([2, 3, 4], 48), Ok(ok));
        assert_eq!(kind_of([2, 3, 4], 47), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([2, 0, 4], 48), Err(LoadErrorKind::BadInput));
        assert_eq!(kind_of([u64::MAX; 3], u64::MAX), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([1 << 32, 1 << 32, 1], u64::MAX), Err(LoadErrorKind::Limit));
        assert_eq!(kind_of([1_000_000; 3], u64::MAX / 16), Err(LoadErrorKind::Limit));
    }

    #[test]
    fn the_budget_follows_the_free_memory() {
        assert!(default_budget_bytes() > 0);
    }

    #[test]
    fn distances_between_voxels_are_alike() {
        assert_eq!(unlike_spacings([1e-3, 10.0, 1.0]), None);
        assert!(unlike_spacings([1e-9, 1e9, 1.0]).is_some_and(|why| why.contains("10000 times")));
    }

    #[test]
    fn bytes_read_well() {
        assert_eq!(human_bytes(100), "100 bytes");
        assert_eq!(human_bytes(3 << 29), "1.5 GiB");
        assert_eq!(human_bytes(2_000_000_000_000_000_000), "1.7 EiB");
        assert_eq!(human_bytes(u128::MAX), "more than 1000000 EiB");
    }
}
