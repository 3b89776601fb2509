//! Voxel spacing by the resolution of the first page, a unit of length, and the distance between slices.

use super::super::file::TiffFile;
use super::super::file::page::tag;
use crate::length_unit::{INCH_MM, millimetres};
use crate::reading::placement::{GridPlacement, is_plausible_assumption};

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
    let [wide, high, _] = lengths;
    match unit.and_then(millimetres) {
        // The resolution of prints and screens, which programs write unasked: it says no more than how wide pixels are
        // relative to their height.
        Some(INCH_MM) if across.is_some() && deep.is_none() => {
            let placement = GridPlacement::from_spacing([1.0, high / wide, 1.0]).with_unknown_scale();
            placement.with_remark(Some(format!(
                "its resolution is that of prints ({} pixels per inch), and the slice spacing is not stated: voxels \
                 are taken as cubes of unknown size",
                (1.0 / wide).round()
            )))
        }
        Some(unit) if across.is_some() => {
            let is_cube = deep.is_none() && !is_plausible_assumption(1.0, wide);
            let lengths = if is_cube { [wide, high, wide] } else { lengths };
            let assumed = if is_cube {
                "the slice spacing is not stated, and 1 unit of length is more than ten times as long or short as \
                 pixels are wide: slices are taken to be as far apart as pixels"
            } else {
                "the slice spacing is not stated: 1 unit of length is used, as in ImageJ"
            };
            GridPlacement::from_spacing(lengths.map(|length| length * unit))
                .with_length_unit(unit)
                .with_remark(deep.is_none().then_some(assumed))
        }
        // Pixels, or an unknown unit: only the ratio of the lengths is known.
        _ if deep.is_some() => GridPlacement {
            is_scale_known: false,
            ..GridPlacement::from_spacing([lengths[0], lengths[1], lengths[2]])
        },
        _ => GridPlacement::unknown(),
    }
}
