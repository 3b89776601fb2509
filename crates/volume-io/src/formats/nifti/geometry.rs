//! Placement of `NIfTI` voxels: from the matrix (`sform`), else the quaternion (`qform`), else the spacings
//! (`pixdim`) alone.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::super::placement::GridPlacement;
use super::header::{NiftiHeader, NiftiVersion};
use chiaroscuro_volume::is_usable_spacing;

/// Returns the placement of a grid's voxels, in right-anterior-superior millimetres, with remarks on what the header
/// leaves open.
pub(super) fn placement(header: &NiftiHeader, dims: [u64; 3]) -> GridPlacement {
    let unit_mm = unit_mm(header);
    // Programs that write a position but no unit mean millimetres.
    let mm = unit_mm.unwrap_or(1.0);
    let spacing = spacing(header, dims);
    let mut remarks = Vec::new();
    for (name, code, affine) in
        [("sform", header.sform_code, sform(header)), ("qform", header.qform_code, qform(header, spacing))]
    {
        if code <= 0 {
            continue;
        }
        let placed = GridPlacement::from_ras_affine(DAffine3::from_scale(DVec3::splat(mm)) * affine);
        if placed.is_anatomical {
            return GridPlacement { remarks, ..placed }.with_length_unit(mm);
        }
        remarks.push(format!("the header's {name} is unusable"));
    }
    remarks.push(if header.version == NiftiVersion::Analyze {
        "Analyze files do not state the orientation of the body: left and right are unknown".to_owned()
    } else {
        "the header does not state the orientation of the body: left and right are unknown".to_owned()
    });
    // Values that programs write by default: no unit, and spacings of 0 or 1.
    let is_default = unit_mm.is_none() && spacing.iter().all(|&length| length == 0.0 || length == 1.0);
    let placed = if is_default {
        GridPlacement::unknown()
    } else {
        GridPlacement::from_spacing(spacing.map(|n| n * mm))
    };
    remarks.extend(placed.remarks);
    GridPlacement { remarks, ..placed }.with_length_unit(mm)
}

/// Millimetres per unit of length, if the header names a known one (`NIFTI_UNITS_METER`, `_MM`, `_MICRON`; Analyze:
/// text).
fn unit_mm(header: &NiftiHeader) -> Option<f64> {
    match (header.units & 7, header.analyze_units[0].trim().to_lowercase().as_str()) {
        (1, _) | (_, "m") => Some(1e3),
        (2, _) | (_, "mm") => Some(1.0),
        (3, _) | (_, "um" | "µm") => Some(1e-3),
        (_, "cm") => Some(10.0),
        _ => None,
    }
}

/// Returns the spacings of the three axes, unsigned; an axis of a single voxel without a usable spacing takes that of
/// another axis.
fn spacing(header: &NiftiHeader, dims: [u64; 3]) -> [f64; 3] {
    let said = [1, 2, 3].map(|axis: usize| header.pixdim[axis].abs());
    let other = said.into_iter().find(|&length| is_usable_spacing(length));
    std::array::from_fn(|axis| match other {
        Some(other) if dims[axis] == 1 && !is_usable_spacing(said[axis]) => other,
        _ => said[axis],
    })
}

/// Returns the affine of the matrix (`srow_x`, `srow_y`, `srow_z`).
fn sform(header: &NiftiHeader) -> DAffine3 {
    let [x, y, z] = header.srow;
    let column = |at: usize| DVec3::new(x[at], y[at], z[at]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// Returns the affine of the quaternion (`nifti1.h`, "method 2"): its real part follows from the three stored
/// numbers, and a negative `pixdim[0]` (`qfac`) mirrors the third axis.
fn qform(header: &NiftiHeader, spacing: [f64; 3]) -> DAffine3 {
    let vector = DVec3::from_array(header.quatern);
    let rest = 1.0 - vector.length_squared();
    // Rounding can make the vector of a half turn longer than 1.
    let turn = if rest < 1e-7 {
        let DVec3 { x, y, z } = vector.normalize_or_zero();
        DQuat::from_xyzw(x, y, z, 0.0)
    } else {
        DQuat::from_xyzw(vector.x, vector.y, vector.z, rest.sqrt())
    };
    let mirror = if header.pixdim[0] < 0.0 { -1.0 } else { 1.0 };
    let lengths = DVec3::from_array(spacing) * DVec3::new(1.0, 1.0, mirror);
    // Composed from matrices, not by quaternion operations: an invalid quaternion then gives a matrix that is not
    // finite, which is refused.
    let matrix3 = DMat3::from_quat(turn) * DMat3::from_diagonal(lengths);
    DAffine3 { matrix3, translation: DVec3::from_array(header.qoffset) }
}
