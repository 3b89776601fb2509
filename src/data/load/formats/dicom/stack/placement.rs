//! Placement of ordered slices in the world, with remarks on spacing and tilt.

use glam::{DAffine3, DMat3, DVec3};

use crate::data::load::formats::dicom::header::plane::Plane;
use crate::data::load::formats::dicom::layer::Slice;
use crate::data::load::reading::placement::Placement;

/// Maximum sideways offset of slices from a line, as a share of their spacing, without a remark.
const ASIDE: f64 = 0.05;

/// Sideways offset per slice, as a share of the spacing, above which the gantry was tilted.
const ASLANT: f64 = 0.05;

/// Returns the placement of `layers` layers whose slices have positions, lowest first; a single layer is as thick as
/// the header says.
pub(crate) fn of_positions(slices: &[Slice], layers: usize) -> Placement {
    let [Some(first), Some(last)] = [slices.first(), slices.last()] else { return Placement::unknown() };
    let ([Some(origin), Some(end)], Some(normal)) =
        ([first, last].map(|slice| slice.plane.position), first.plane.normal())
    else {
        return Placement::unknown();
    };
    let mut remarks = Vec::new();
    let across = if layers > 1 {
        (end - origin) / (layers - 1) as f64
    } else {
        match thickness(&first.plane) {
            Some(Depth { depth_mm, remark }) => {
                remarks.extend(remark);
                normal * depth_mm
            }
            None => return Placement::unknown(),
        }
    };
    remarks.extend(spacing_remark(&first.plane));
    remarks.extend(sideways_remark(slices, origin, across, normal));
    let placement = placed(&first.plane, Some(across));
    let placement = if first.plane.is_in_volume_frame { placement.of_no_body() } else { placement };
    Placement { remarks: [placement.remarks.clone(), remarks].concat(), ..placement }
}

/// Returns a remark for the user on the source of the pixel spacing.
pub(crate) fn spacing_remark(plane: &Plane) -> Option<String> {
    match (plane.spacing, plane.spacing_source) {
        (None, _) => Some("the file does not say how far its pixels lie apart".to_owned()),
        (Some(_), Some(source)) => Some(format!("how far its pixels lie apart is taken from {source}")),
        (Some(_), None) => None,
    }
}

/// Returns the placement of slices, given the plane of the lowest and the step from each to the next.
pub(crate) fn placed(lowest: &Plane, across: Option<DVec3>) -> Placement {
    let (Some(origin), Some([along_row, along_column]), Some([between_rows, between_columns]), Some(across)) =
        (lowest.position, lowest.orientation, lowest.spacing, across)
    else {
        return Placement::unknown();
    };
    // An invalid negative spacing does not mirror the images.
    let remark = (between_rows < 0.0 || between_columns < 0.0).then(|| {
        format!("distances of {between_columns} x {between_rows} mm between pixels cannot be: they are taken without signs")
    });
    let along_row = along_row * between_columns.abs();
    let axes = DMat3::from_cols(along_row, along_column * between_rows.abs(), across);
    Placement::lps(DAffine3 { matrix3: axes, translation: origin }).remarked(remark)
}

/// Spacing of slices in millimetres, and a remark on its source.
pub(crate) struct Depth {
    pub(crate) depth_mm: f64,
    pub(crate) remark: Option<String>,
}

/// Returns the thickness of a single slice, or else the pixel spacing in its place.
pub(crate) fn thickness(plane: &Plane) -> Option<Depth> {
    if let Some(Depth { depth_mm, .. }) = distance(plane) {
        return Some(Depth { depth_mm, remark: None });
    }
    let [between_rows, _] = plane.spacing?;
    let remark = "the file does not say how thick its slice is: it is taken for as thick as pixels are";
    Some(Depth { depth_mm: between_rows, remark: Some(remark.to_owned()) })
}

/// Returns the spacing of slices without distinct positions: as stated, or else their thickness.
pub(crate) fn distance(plane: &Plane) -> Option<Depth> {
    let is_usable = |depth: &f64| *depth != 0.0;
    let of = |depth: Option<f64>, element: &str| {
        let depth_mm = depth.filter(is_usable)?.abs();
        let remark = format!("how far its slices lie apart, {depth_mm} mm, is taken from {element}");
        Some(Depth { depth_mm, remark: Some(remark) })
    };
    of(plane.between, "Spacing Between Slices").or_else(|| of(plane.thickness, "Slice Thickness"))
}

/// Returns a remark on slices that are shifted sideways or tilted.
fn sideways_remark(slices: &[Slice], origin: DVec3, across: DVec3, normal: DVec3) -> Option<String> {
    let distance = across.length();
    let aside = across - normal * across.dot(normal);
    if aside.length() > ASLANT * distance {
        return Some("its slices lie aslant above each other, as a tilted scanner takes them".to_owned());
    }
    let line = across / across.dot(normal);
    let off = |slice: &Slice| {
        let from_origin = slice.plane.position? - origin;
        Some((from_origin - line * from_origin.dot(normal)).length())
    };
    let furthest = slices.iter().filter_map(off).fold(0.0, f64::max);
    (furthest > ASIDE * distance)
        .then(|| format!("its slices lie up to {furthest:.4} mm aside of each other: they are shown in line"))
}
