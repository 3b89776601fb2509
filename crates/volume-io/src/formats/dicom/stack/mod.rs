//! Stacks of slices: order and placement of the images of a series.
//!
//! Slices are ordered by their positions along the normal, never by their numbers, unless no position is stated.
//! Several images at each position are phases, each of which is a volume.

mod coincident_phases;
mod phases;
mod placement;
mod positions;
mod segments;
mod slice_grid;

use glam::DVec3;

use super::slice_layer::{DicomSlice, GapFill, SliceLayer};
use crate::reading::placement::GridPlacement;
use coincident_phases::compare_acquisition;
use phases::{PhaseImages, SeriesPhases};
use placement::{
    placement_from_plane, placement_from_positions, slice_spacing, slice_thickness, spacing_remark,
};
use positions::{ImagePose, PositionGroups};
use segments::segment_volume;
use slice_grid::SliceGrid;

use super::header::acquisition_attributes::AcquisitionAttribute;
use super::header::image_plane::ImagePlane;

/// Volume of a series: its slices, and the layers of a regular grid made from them.
#[derive(Debug)]
pub(crate) struct StackedVolume {
    /// Name that distinguishes the volume from others of the series; empty if it is the only one.
    pub(crate) name: String,
    pub(crate) slices: Vec<DicomSlice>,
    pub(crate) layers: Vec<SliceLayer>,
    pub(crate) placement: GridPlacement,
}

/// Volumes of a series: one, or one per phase.
#[derive(Debug)]
pub(crate) struct SliceStack {
    /// Volumes, at least one of them.
    pub(crate) volumes: Vec<StackedVolume>,
    /// Remarks for the user that apply to all volumes.
    pub(crate) remarks: Vec<String>,
    /// True if slices have distinct positions, so that they are no image sequence.
    pub(crate) has_depth: bool,
}

/// Source of the images' positions along their common line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PositionSource {
    /// Image positions, projected to the normal.
    Positions,
    /// Image positions, along the axis in which they differ most, if no orientation is stated.
    Axis,
    /// Slice Location, which has no known direction.
    Locations,
}

impl SliceStack {
    /// Orders parallel images, at least one, and splits them into volumes.
    ///
    /// `has_masks` tells that they are masks of segments; `image_types` holds the texts that
    /// [`AcquisitionAttribute::ImageType`] indexes.
    pub(crate) fn new(
        mut slices: Vec<DicomSlice>,
        filling: GapFill,
        has_masks: bool,
        image_types: &[String],
    ) -> Self {
        let mut remarks = Vec::new();
        drop_unplaced(&mut slices, &mut remarks);
        if has_masks {
            return Self { volumes: vec![segment_volume(slices)], remarks, has_depth: true };
        }
        for line in [PositionSource::Positions, PositionSource::Axis, PositionSource::Locations] {
            let Some(places_mm) = line.positions_mm(&slices) else { continue };
            let pose = |(slice, place_mm): (&DicomSlice, f64)| ImagePose {
                position_mm: place_mm,
                attributes: slice.plane.attributes,
            };
            let poses: Vec<ImagePose> = slices.iter().zip(places_mm).map(pose).collect();
            let mut order: Vec<usize> = (0..poses.len()).collect();
            order.sort_by(|&a, &b| poses[a].position_mm.total_cmp(&poses[b].position_mm));
            let tolerance_mm = PositionGroups::tolerance_mm(&poses, &order);
            if slices.len() > 1 && PositionGroups::new(&poses, &order, tolerance_mm).len() == 1 {
                continue;
            }
            let SeriesPhases { phases, remark } = SeriesPhases::new(&poses, image_types);
            let volumes = phases.into_iter().map(|phase| line.build_volume(&slices, &poses, phase, filling));
            remarks.extend(remark);
            return Self { volumes: volumes.collect(), remarks, has_depth: true };
        }
        let is_at_one_position =
            |slice: &DicomSlice| slice.plane.position.is_some() && slice.plane.has_own_position;
        let volume =
            if slices.iter().all(is_at_one_position) { cine_volume(slices) } else { unplaced_volume(slices) };
        Self { volumes: vec![volume], remarks, has_depth: false }
    }
}

impl PositionSource {
    /// Returns the positions of the images in millimetres; `None` if any of them lacks one.
    fn positions_mm(self, slices: &[DicomSlice]) -> Option<Vec<f64>> {
        let first = slices.first()?.plane;
        let direction = match self {
            Self::Positions => first.normal(),
            Self::Axis if first.normal().is_none() && slices.len() > 1 => axis_of_largest_extent(slices),
            Self::Axis | Self::Locations => None,
        };
        let place = |slice: &DicomSlice| match self {
            Self::Positions | Self::Axis => Some(slice.plane.position?.dot(direction?)),
            Self::Locations if slices.len() > 1 => slice.plane.location_mm,
            Self::Locations => None,
        };
        let is_finite = |place: &f64| place.is_finite();
        slices.iter().map(|slice| place(slice).filter(is_finite)).collect()
    }

    /// Builds the volume of a phase's images.
    fn build_volume(
        self,
        slices: &[DicomSlice],
        poses: &[ImagePose],
        phase: PhaseImages,
        filling: GapFill,
    ) -> StackedVolume {
        let PhaseImages { name, images: pictures } = phase;
        let places_mm: Vec<f64> = pictures.iter().map(|&picture| poses[picture].position_mm).collect();
        let slices: Vec<DicomSlice> = pictures.iter().map(|&picture| slices[picture]).collect();
        let plane = slices.first().map(|slice| slice.plane).unwrap_or_default();
        if slices.len() < 2 {
            let placement = if self == Self::Positions {
                placement_from_positions(&slices, 1)
            } else {
                GridPlacement::unknown()
            };
            return StackedVolume { name, slices, layers: vec![SliceLayer::Slice(0)], placement };
        }
        let distance_mm = plane.slice_spacing_mm.map(f64::abs).or(plane.thickness_mm);
        let SliceGrid { layers, spacing: distance, remark } =
            SliceGrid::new(&places_mm, filling, distance_mm);
        let placement = match self {
            Self::Positions => placement_from_positions(&slices, layers.len()),
            Self::Axis | Self::Locations => {
                let from = if self == Self::Axis {
                    "Image Position, as no orientation is stated"
                } else {
                    "Slice Location"
                };
                spaced_placement(&plane, distance).with_remark(spacing_remark(&plane)).with_remark(Some(
                    format!("the positions of its slices, {distance:.4} mm apart, are taken from {from}"),
                ))
            }
        };
        StackedVolume { name, slices, layers, placement: placement.with_remark(remark) }
    }
}

/// Drops the few images without a position, if most have one.
fn drop_unplaced(slices: &mut Vec<DicomSlice>, remarks: &mut Vec<String>) {
    let total = slices.len();
    let placed = slices.iter().filter(|slice| slice.plane.position.is_some()).count();
    if placed < total && 2 * placed > total {
        slices.retain(|slice| slice.plane.position.is_some());
        let left_out = total - placed;
        remarks.push(format!("{left_out} of {total} images have no position: they are left out"));
    }
}

/// Returns the coordinate axis along which positions differ most.
fn axis_of_largest_extent(slices: &[DicomSlice]) -> Option<DVec3> {
    let positions = slices.iter().filter_map(|slice| slice.plane.position);
    let first = slices.first()?.plane.position?;
    let (low, high) = positions.fold((first, first), |(low, high), at| (low.min(at), high.max(at)));
    let span = high - low;
    let axes = [(span.x, DVec3::X), (span.y, DVec3::Y), (span.z, DVec3::Z)];
    axes.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
}

/// Returns the placement of slices with this spacing, and the pixel spacing of an image.
fn spaced_placement(plane: &ImagePlane, distance_mm: f64) -> GridPlacement {
    match plane.spacing {
        Some([between_rows, between_columns]) => {
            GridPlacement::from_spacing([between_columns, between_rows, distance_mm])
        }
        None => GridPlacement::unknown(),
    }
}

/// Builds a volume in which every image is a layer.
fn layer_per_image(slices: Vec<DicomSlice>, placement: GridPlacement) -> StackedVolume {
    let layers = (0..slices.len()).map(SliceLayer::Slice).collect();
    StackedVolume { name: String::new(), slices, layers, placement }
}

/// Builds a volume of images at one position, in order of time.
fn cine_volume(mut slices: Vec<DicomSlice>) -> StackedVolume {
    slices.sort_by(|a, b| compare_acquisition(&a.plane.attributes, &b.plane.attributes));
    let remark = format!(
        "its {} images all have the same position: they are stacked in order of acquisition",
        slices.len()
    );
    layer_per_image(slices, GridPlacement::unknown().with_remark(Some(remark)))
}

/// Builds a volume of images without distinct positions, in order of their numbers, or else of their file names.
fn unplaced_volume(mut slices: Vec<DicomSlice>) -> StackedVolume {
    let order = |slice: &DicomSlice| {
        [
            AcquisitionAttribute::Acquisition,
            AcquisitionAttribute::Instance,
            AcquisitionAttribute::AcquisitionTime,
        ]
        .map(|attribute| slice.plane.attributes.get(attribute).unwrap_or(0.0))
    };
    slices.sort_by(|a, b| {
        let both = order(a).into_iter().zip(order(b));
        both.map(|(a, b)| a.total_cmp(&b)).fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
    let plane = slices.first().map(|slice| slice.plane).unwrap_or_default();
    // Frames that follow each other in time have no spatial distance.
    let count = slices.len();
    let depth = match count {
        1 => slice_thickness(&plane),
        _ if plane.is_cine => None,
        _ => slice_spacing(&plane),
    };
    let Some(depth) = depth else {
        let how = "the file does not state the positions of its";
        let remark = (count > 1).then(|| format!("{how} {count} images: they are stacked in their order"));
        // The aspect ratio of pixels is known.
        let [between_rows, between_columns] = plane.spacing.unwrap_or([1.0; 2]);
        let placement = match plane.spacing {
            Some(_) => GridPlacement::from_spacing([between_columns, between_rows, between_rows])
                .with_unknown_scale(),
            None => GridPlacement::unknown(),
        };
        return layer_per_image(slices, placement.with_remark(remark));
    };
    let placement = match plane.normal() {
        Some(normal) if plane.position.is_some() && plane.spacing.is_some() => {
            // Some programs encode the direction in the sign.
            let sign = plane.slice_spacing_mm.map_or(1.0, f64::signum);
            placement_from_plane(&plane, Some(normal * depth.depth_mm * sign))
        }
        _ => spaced_placement(&plane, depth.depth_mm),
    };
    let placement = placement.with_remark(spacing_remark(&plane)).with_remark(depth.remark);
    layer_per_image(slices, placement)
}
