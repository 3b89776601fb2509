//! Placement of MRC voxels: from the unit cell of a crystal, or the box that takes its place.

use glam::{DAffine3, DMat3, DVec3};

use super::super::placement::GridPlacement;
use super::header::MrcHeader;
use chiaroscuro_volume::is_usable_spacing;

/// Millimetres per Å, the unit of the file's lengths.
const MM_PER_ANGSTROM: f64 = 1e-7;

/// Returns the placement of the voxels from cell, axis order and origin.
pub(super) fn placement(header: &MrcHeader) -> GridPlacement {
    let (lengths, intervals) = (header.floats(11), header.ints(8));
    let steps: [f64; 3] = std::array::from_fn(|axis| lengths[axis] / f64::from(intervals[axis]));
    let is_usable = |step: &f64| is_usable_spacing(step * MM_PER_ANGSTROM);
    // An unusable step is taken to equal the others, as steps nearly always do.
    let first_usable = steps.into_iter().find(is_usable);
    let used_steps = steps.map(|step| if is_usable(&step) { step } else { first_usable.unwrap_or(1.0) });
    let unit = if first_usable.is_some() { MM_PER_ANGSTROM } else { 1.0 };

    let cell = cell_axes(header.floats(14));
    let (order, is_order_bad) = axis_order(header.ints(17));
    let columns = order.map(|axis| cell[axis] * used_steps[axis] * unit);
    // Crystallography states where a map begins in grid steps (`NXSTART` …), microscopy in Å (`ORIGIN`).
    let starts = header.ints(5);
    let origin = match header.origin() {
        Some(origin) => DVec3::from(origin) * unit,
        None => (0..3).map(|axis| columns[axis] * f64::from(starts[axis])).sum(),
    };
    let matrix = DMat3::from_cols(columns[0], columns[1], columns[2]);
    let placed =
        GridPlacement::from_ras_affine(DAffine3 { matrix3: matrix, translation: origin }).without_anatomy();
    let [a, b, c] = steps;
    let mended = (first_usable.is_some() && used_steps != steps).then(|| {
        format!(
            "a voxel spacing of {a} x {b} x {c} Å is unusable: that of a usable axis is used for the others"
        )
    });
    let reordered = is_order_bad.then_some("the order of its axes is invalid: x, y, z is assumed");
    let placed = placed.with_remark(mended).with_remark(reordered);
    if first_usable.is_some() { placed } else { placed.with_unknown_scale() }
}

/// Returns the cell axes that columns, rows and sections follow, and true if the stated order is invalid.
fn axis_order(stated: [i32; 3]) -> ([usize; 3], bool) {
    let mut sorted = stated;
    sorted.sort_unstable();
    if sorted == [1, 2, 3] {
        (stated.map(|axis| (axis - 1) as usize), false)
    } else {
        // Zeros mean that the order is not stated.
        ([0, 1, 2], stated != [0; 3])
    }
}

/// Computes the unit directions of the cell axes from the angles between them, in degrees: the first along x, the
/// second in the plane of x and y.
fn cell_axes(angles: [f64; 3]) -> [DVec3; 3] {
    let right = [DVec3::X, DVec3::Y, DVec3::Z];
    if !angles.iter().all(|angle| (1.0..=179.0).contains(angle)) {
        return right;
    }
    // Exactly 0 for right angles, whose computed cosine is not quite zero.
    let cosine = |angle: f64| if angle == 90.0 { 0.0 } else { angle.to_radians().cos() };
    let [alpha, beta, gamma] = angles.map(cosine);
    let sine = (1.0 - gamma * gamma).sqrt();
    let y = (alpha - beta * gamma) / sine;
    let height = 1.0 - beta * beta - y * y;
    // Three angles need not be geometrically possible.
    if height < 1e-6 {
        return right;
    }
    [DVec3::X, DVec3::new(gamma, sine, 0.0), DVec3::new(beta, y, height.sqrt())]
}
