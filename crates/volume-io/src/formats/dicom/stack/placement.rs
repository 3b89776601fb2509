//! Placement of ordered slices in the world, with remarks on spacing and tilt.

use glam::{DAffine3, DMat3, DVec3};

use crate::formats::dicom::header::image_plane::ImagePlane;
use crate::formats::dicom::slice_layer::DicomSlice;
use crate::reading::placement::GridPlacement;

/// Maximum sideways offset of slices from a line, as a share of their spacing, without a remark.
const MAX_SIDEWAYS_OFFSET: f64 = 0.05;

/// Sideways offset per slice, as a share of the spacing, above which the gantry was tilted.
const MAX_TILT: f64 = 0.05;

/// Returns the placement of `layers` layers whose slices have positions, lowest first; a single layer is as thick as
/// the header says.
pub(crate) fn placement_from_positions(slices: &[DicomSlice], layers: usize) -> GridPlacement {
    let [Some(first), Some(last)] = [slices.first(), slices.last()] else { return GridPlacement::unknown() };
    let ([Some(origin), Some(end)], Some(normal)) =
        ([first, last].map(|slice| slice.plane.position), first.plane.normal())
    else {
        return GridPlacement::unknown();
    };
    let mut remarks = Vec::new();
    let slice_step = if layers > 1 {
        (end - origin) / (layers - 1) as f64
    } else {
        match slice_thickness(&first.plane) {
            Some(SliceSpacing { depth_mm, remark }) => {
                remarks.extend(remark);
                normal * depth_mm
            }
            None => return GridPlacement::unknown(),
        }
    };
    remarks.extend(spacing_remark(&first.plane));
    remarks.extend(sideways_remark(slices, origin, slice_step, normal));
    let placement = placement_from_plane(&first.plane, Some(slice_step));
    let placement = if first.plane.is_in_volume_frame { placement.without_anatomy() } else { placement };
    GridPlacement { remarks: [placement.remarks.clone(), remarks].concat(), ..placement }
}

/// Returns a remark for the user on the source of the pixel spacing.
pub(crate) fn spacing_remark(plane: &ImagePlane) -> Option<String> {
    match (plane.spacing, plane.spacing_source) {
        (None, _) => Some("the file does not state its pixel spacing".to_owned()),
        (Some(_), Some(source)) => Some(format!("the pixel spacing is taken from {source}")),
        (Some(_), None) => None,
    }
}

/// Returns the placement of slices, given the plane of the lowest and the step from each to the next.
pub(crate) fn placement_from_plane(lowest: &ImagePlane, across: Option<DVec3>) -> GridPlacement {
    let (Some(origin), Some([along_row, along_column]), Some([between_rows, between_columns]), Some(across)) =
        (lowest.position, lowest.orientation, lowest.spacing, across)
    else {
        return GridPlacement::unknown();
    };
    // An invalid negative spacing does not mirror the images.
    let remark = (between_rows < 0.0 || between_columns < 0.0).then(|| {
        format!("a pixel spacing of {between_columns} x {between_rows} mm is impossible: signs are ignored")
    });
    let along_row = along_row * between_columns.abs();
    let axes = DMat3::from_cols(along_row, along_column * between_rows.abs(), across);
    GridPlacement::from_lps_affine(DAffine3 { matrix3: axes, translation: origin }).with_remark(remark)
}

/// Spacing of slices in millimetres, and a remark on its source.
pub(crate) struct SliceSpacing {
    pub(crate) depth_mm: f64,
    pub(crate) remark: Option<String>,
}

/// Returns the thickness of a single slice, or else the pixel spacing in its place.
pub(crate) fn slice_thickness(plane: &ImagePlane) -> Option<SliceSpacing> {
    if let Some(SliceSpacing { depth_mm, .. }) = slice_spacing(plane) {
        return Some(SliceSpacing { depth_mm, remark: None });
    }
    let [between_rows, _] = plane.spacing?;
    let remark = "the file does not state its slice thickness: the pixel spacing is used";
    Some(SliceSpacing { depth_mm: between_rows.abs(), remark: Some(remark.to_owned()) })
}

/// Returns the spacing of slices without distinct positions: as stated, or else their thickness.
pub(crate) fn slice_spacing(plane: &ImagePlane) -> Option<SliceSpacing> {
    let is_usable = |depth: &f64| *depth != 0.0;
    let of = |depth: Option<f64>, element: &str| {
        let depth_mm = depth.filter(is_usable)?.abs();
        let remark = format!("the slice spacing, {depth_mm} mm, is taken from {element}");
        Some(SliceSpacing { depth_mm, remark: Some(remark) })
    };
    of(plane.slice_spacing_mm, "Spacing Between Slices").or_else(|| of(plane.thickness_mm, "Slice Thickness"))
}

/// Returns a remark on slices that are shifted sideways or tilted.
fn sideways_remark(slices: &[DicomSlice], origin: DVec3, across: DVec3, normal: DVec3) -> Option<String> {
    let distance = across.length();
    let aside = across - normal * across.dot(normal);
    if aside.length() > MAX_TILT * distance {
        return Some("its slices are sheared against each other, as with a tilted gantry".to_owned());
    }
    let line = across / across.dot(normal);
    let sideways_offset = |slice: &DicomSlice| {
        let from_origin = slice.plane.position? - origin;
        Some((from_origin - line * from_origin.dot(normal)).length())
    };
    let furthest = slices.iter().filter_map(sideways_offset).fold(0.0, f64::max);
    (furthest > MAX_SIDEWAYS_OFFSET * distance)
        .then(|| format!("its slices are shifted sideways by up to {furthest:.4} mm: they are shown in line"))
}
