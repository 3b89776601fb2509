//! Placement of `MetaImage` voxels: spacing, matrix or orientation letters, and offset.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::super::placement::GridPlacement;
use super::header::MetaImageHeader;
use super::layout::MetaImageGrid;
use chiaroscuro_volume::LoadContext;

/// Returns the placement of a grid's voxels. A matrix gives the anatomical orientation, or else three letters do.
pub(super) fn placement(
    context: LoadContext<'_>,
    header: &MetaImageHeader,
    grid: &MetaImageGrid,
) -> Result<GridPlacement, LoadError> {
    let count = grid.sizes.len();
    let spacing = header.numbers(context, &["ElementSpacing", "ElementSize"], count)?;
    let origin = header.numbers(context, &["Offset", "Position", "Origin"], count)?;
    let matrix = header.numbers(context, &["TransformMatrix", "Rotation", "Orientation"], count * count)?;
    // MetaIO's values for "unknown".
    let is_scale_known = header.get("DistanceUnits") != Some("?");
    let is_of_a_body = header.get("AnatomicalOrientation") != Some("???");
    let mm = header.get("DistanceUnits").and_then(mm_per_unit).unwrap_or(1.0);

    // Without spacings the file may still give the directions of its axes.
    let is_scale_known = is_scale_known && spacing.is_some();
    if spacing.is_none() && matrix.is_none() {
        return Ok(GridPlacement::unknown());
    }
    let spacing = spacing.unwrap_or_else(|| vec![1.0; count]);
    let length = |axis: usize| spacing.get(axis).or(spacing.get(1)).map_or(1.0, |length| length * mm);
    let mut axis_aligned = GridPlacement::from_spacing([length(0), length(1), length(2)]);
    axis_aligned.is_scale_known = is_scale_known;
    // A two-dimensional image has no anatomical orientation.
    let directions = if count < 3 { None } else { matrix.map(|matrix| directions_from_rows(&matrix, count)) };
    let from_letters =
        || header.get("AnatomicalOrientation").filter(|_| count > 2).and_then(directions_from_letters);
    let Some(directions) = directions.or_else(from_letters) else {
        return Ok(axis_aligned);
    };
    let origin = origin.map_or(DVec3::ZERO, |origin| DVec3::new(origin[0], origin[1], origin[2]) * mm);
    if directions.determinant() == 0.0 {
        return Ok(axis_aligned
            .with_remark(Some("the file's axis directions are unusable: the axes of the grid are used")));
    }
    // Uses the spacing after unusable distances were replaced.
    let matrix3 = directions * axis_aligned.world_from_index.matrix3;
    let mut placed = GridPlacement::from_lps_affine(DAffine3 { matrix3, translation: origin });
    placed.remarks.extend(axis_aligned.remarks);
    placed.is_scale_known = is_scale_known;
    placed.is_anatomical &= is_of_a_body;
    Ok(placed)
}

/// Returns millimetres per unit of length; `None` for an unknown unit.
fn mm_per_unit(unit: &str) -> Option<f64> {
    match unit.to_lowercase().as_str() {
        "nm" => Some(1e-6),
        "um" | "µm" => Some(1e-3),
        "mm" => Some(1.0),
        "cm" => Some(10.0),
        "m" => Some(1e3),
        _ => None,
    }
}

/// Returns the directions of the first three axes, each a row of the header's matrix.
fn directions_from_rows(matrix: &[f64], count: usize) -> DMat3 {
    let row = |axis: usize| DVec3::from_array(std::array::from_fn(|at| matrix[axis * count + at]));
    DMat3::from_cols(row(0), row(1), row(2))
}

/// Parses axis directions from the sides that they come from, as in `RAI`; `None` for other letters, or if two axes
/// are parallel.
fn directions_from_letters(letters: &str) -> Option<DMat3> {
    let axis = |letter: char| match letter {
        'R' => Some(DVec3::X),
        'L' => Some(-DVec3::X),
        'A' => Some(DVec3::Y),
        'P' => Some(-DVec3::Y),
        'I' => Some(DVec3::Z),
        'S' => Some(-DVec3::Z),
        _ => None,
    };
    let axes: Option<Vec<DVec3>> = letters.chars().take(4).map(axis).collect();
    let [x, y, z] = axes?.try_into().ok()?;
    let matrix = DMat3::from_cols(x, y, z);
    (matrix.determinant() != 0.0).then_some(matrix)
}
