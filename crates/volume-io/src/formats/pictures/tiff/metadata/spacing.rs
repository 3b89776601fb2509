//! Voxel spacing by the resolution of the first page, a unit of length, and the distance between slices.

use super::super::file::TiffFile;
use super::super::file::page::tag;
use super::length_unit::millimetres;
use crate::reading::placement::GridPlacement;

/// Placement by the name of a unit of length, and the distance between slices in it.
pub(super) fn placement_from_resolution(
    tiff: &mut TiffFile,
    unit: Option<&str>,
    spacing: Option<f64>,
) -> GridPlacement {
    let per_unit = |number: Option<f64>| {
        number.filter(|number| number.is_finite() && *number > 0.0).map(|number| 1.0 / number)
    };
    let across = per_unit(tiff.number_entry(tag::X_RESOLUTION));
    let down = per_unit(tiff.number_entry(tag::Y_RESOLUTION));
    let deep = spacing.filter(|spacing| spacing.is_finite());
    // A length of 1 unit is omitted.
    let lengths = [across.unwrap_or(1.0), down.or(across).unwrap_or(1.0), deep.unwrap_or(1.0)];
    match unit.and_then(millimetres) {
        Some(unit) if across.is_some() => {
            let mut placement =
                GridPlacement::from_spacing(lengths.map(|length| length * unit)).with_length_unit(unit);
            if deep.is_none() {
                placement.remarks.push(
                    "the slice spacing is not stated: 1 unit of length is used, as in ImageJ".to_owned(),
                );
            }
            placement
        }
        // Pixels, or an unknown unit: only the ratio of the lengths is known.
        _ if deep.is_some() => GridPlacement {
            is_scale_known: false,
            ..GridPlacement::from_spacing([lengths[0], lengths[1], lengths[2]])
        },
        _ => GridPlacement::unknown(),
    }
}
