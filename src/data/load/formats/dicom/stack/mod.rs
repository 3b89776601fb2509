//! Stacks of slices: order and placement of the images of a series.
//!
//! Slices are ordered by their positions along the normal, never by their numbers, unless no position is stated.
//! Several images at each position are phases, each of which is a volume.

mod grid;
mod phases;
mod placement;
mod places;
mod ranks;
mod segments;

use glam::DVec3;

use super::layer::{Filling, Layer, Slice};
use crate::data::load::reading::placement::Placement;
use grid::SliceGrid;
use phases::{Phase, Phases};
use placement::{distance, of_positions, placed, spacing_remark, thickness};
use places::{Places, Pose};
use ranks::by_time;
use segments::of_segments;

use super::header::plane::Plane;
use super::header::taken::Attribute;

/// Volume of a series: its slices, and the layers of a regular grid made from them.
#[derive(Debug)]
pub(crate) struct StackedVolume {
    /// Name that distinguishes the volume from others of the series; empty if it is the only one.
    pub(crate) name: String,
    pub(crate) slices: Vec<Slice>,
    pub(crate) layers: Vec<Layer>,
    pub(crate) placement: Placement,
}

/// Volumes of a series: one, or one per phase.
#[derive(Debug)]
pub(crate) struct Stack {
    /// Volumes, at least one of them.
    pub(crate) volumes: Vec<StackedVolume>,
    /// Remarks for the user that apply to all volumes.
    pub(crate) remarks: Vec<String>,
    /// True if slices have distinct positions, so that they are no image sequence.
    pub(crate) has_depth: bool,
}

/// Source of the images' positions along their common line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    /// Image positions, projected to the normal.
    Positions,
    /// Image positions, along the axis in which they differ most, if no orientation is stated.
    Axis,
    /// Slice Location, which has no known direction.
    Locations,
}

impl Stack {
    /// Orders parallel images, at least one, and splits them into volumes.
    ///
    /// `has_masks` tells that they are masks of segments; `image_types` holds the texts that [`Attribute::ImageType`]
    /// indexes.
    pub(crate) fn new(
        mut slices: Vec<Slice>,
        filling: Filling,
        has_masks: bool,
        image_types: &[String],
    ) -> Self {
        let mut remarks = Vec::new();
        drop_unplaced(&mut slices, &mut remarks);
        if has_masks {
            return Self { volumes: vec![of_segments(slices)], remarks, has_depth: true };
        }
        for line in [Line::Positions, Line::Axis, Line::Locations] {
            let Some(places_mm) = line.places_mm(&slices) else { continue };
            let pose = |(slice, place_mm): (&Slice, f64)| Pose { place_mm, taken: slice.plane.taken };
            let poses: Vec<Pose> = slices.iter().zip(places_mm).map(pose).collect();
            let mut order: Vec<usize> = (0..poses.len()).collect();
            order.sort_by(|&a, &b| poses[a].place_mm.total_cmp(&poses[b].place_mm));
            let tolerance_mm = Places::tolerance_mm(&poses, &order);
            if slices.len() > 1 && Places::new(&poses, &order, tolerance_mm).len() == 1 {
                continue;
            }
            let Phases { phases, remark } = Phases::new(&poses, image_types);
            let volumes = phases.into_iter().map(|phase| line.volume(&slices, &poses, phase, filling));
            remarks.extend(remark);
            return Self { volumes: volumes.collect(), remarks, has_depth: true };
        }
        let is_film = |slice: &Slice| slice.plane.position.is_some() && slice.plane.has_own_position;
        let volume = if slices.iter().all(is_film) { film(slices) } else { unplaced(slices) };
        Self { volumes: vec![volume], remarks, has_depth: false }
    }
}

impl Line {
    /// Returns the positions of the images in millimetres; `None` if any of them lacks one.
    fn places_mm(self, slices: &[Slice]) -> Option<Vec<f64>> {
        let first = slices.first()?.plane;
        let direction = match self {
            Self::Positions => first.normal(),
            Self::Axis if first.normal().is_none() && slices.len() > 1 => longest_axis(slices),
            Self::Axis | Self::Locations => None,
        };
        let place = |slice: &Slice| match self {
            Self::Positions | Self::Axis => Some(slice.plane.position?.dot(direction?)),
            Self::Locations if slices.len() > 1 => slice.plane.location_mm,
            Self::Locations => None,
        };
        let is_finite = |place: &f64| place.is_finite();
        slices.iter().map(|slice| place(slice).filter(is_finite)).collect()
    }

    /// Builds the volume of a phase's images.
    fn volume(self, slices: &[Slice], poses: &[Pose], phase: Phase, filling: Filling) -> StackedVolume {
        let Phase { name, pictures } = phase;
        let places_mm: Vec<f64> = pictures.iter().map(|&picture| poses[picture].place_mm).collect();
        let slices: Vec<Slice> = pictures.iter().map(|&picture| slices[picture]).collect();
        let plane = slices.first().map(|slice| slice.plane).unwrap_or_default();
        if slices.len() < 2 {
            let placement =
                if self == Self::Positions { of_positions(&slices, 1) } else { Placement::unknown() };
            return StackedVolume { name, slices, layers: vec![Layer::Picture(0)], placement };
        }
        let distance_mm = plane.between.map(f64::abs).or(plane.thickness);
        let SliceGrid { layers, distance, remark } = SliceGrid::new(&places_mm, filling, distance_mm);
        let placement = match self {
            Self::Positions => of_positions(&slices, layers.len()),
            Self::Axis | Self::Locations => {
                let from =
                    if self == Self::Axis { "positions, whatever their direction" } else { "Slice Location" };
                spaced(&plane, distance).remarked(spacing_remark(&plane)).remarked(Some(format!(
                    "where its slices lie, {distance:.4} mm apart, is taken from {from}"
                )))
            }
        };
        StackedVolume { name, slices, layers, placement: placement.remarked(remark) }
    }
}

/// Drops the few images without a position, if most have one.
fn drop_unplaced(slices: &mut Vec<Slice>, remarks: &mut Vec<String>) {
    let total = slices.len();
    let placed = slices.iter().filter(|slice| slice.plane.position.is_some()).count();
    if placed < total && 2 * placed > total {
        slices.retain(|slice| slice.plane.position.is_some());
        let left_out = total - placed;
        remarks.push(format!("{left_out} of {total} pictures do not say where they lie: they are left out"));
    }
}

/// Returns the coordinate axis along which positions differ most.
fn longest_axis(slices: &[Slice]) -> Option<DVec3> {
    let positions = slices.iter().filter_map(|slice| slice.plane.position);
    let first = slices.first()?.plane.position?;
    let (low, high) = positions.fold((first, first), |(low, high), at| (low.min(at), high.max(at)));
    let span = high - low;
    let axes = [(span.x, DVec3::X), (span.y, DVec3::Y), (span.z, DVec3::Z)];
    axes.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
}

/// Returns the placement of slices with this spacing, and the pixel spacing of an image.
fn spaced(plane: &Plane, distance_mm: f64) -> Placement {
    match plane.spacing {
        Some([between_rows, between_columns]) => {
            Placement::spaced([between_columns, between_rows, distance_mm])
        }
        None => Placement::unknown(),
    }
}

/// Builds a volume in which every image is a layer.
fn as_layers(slices: Vec<Slice>, placement: Placement) -> StackedVolume {
    let layers = (0..slices.len()).map(Layer::Picture).collect();
    StackedVolume { name: String::new(), slices, layers, placement }
}

/// Builds a volume of images at one position, in order of time.
fn film(mut slices: Vec<Slice>) -> StackedVolume {
    slices.sort_by(|a, b| by_time(&a.plane.taken, &b.plane.taken));
    let remark = format!(
        "its {} pictures lie all at one place: they are stacked in the order in which they were taken",
        slices.len()
    );
    as_layers(slices, Placement::unknown().remarked(Some(remark)))
}

/// Builds a volume of images without distinct positions, in order of their numbers, or else of their file names.
fn unplaced(mut slices: Vec<Slice>) -> StackedVolume {
    let order = |slice: &Slice| {
        [Attribute::Acquisition, Attribute::Instance, Attribute::AcquisitionTime]
            .map(|attribute| slice.plane.taken.get(attribute).unwrap_or(0.0))
    };
    slices.sort_by(|a, b| {
        let both = order(a).into_iter().zip(order(b));
        both.map(|(a, b)| a.total_cmp(&b)).fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
    let plane = slices.first().map(|slice| slice.plane).unwrap_or_default();
    // Frames that follow each other in time have no spatial distance.
    let count = slices.len();
    let depth = match count {
        1 => thickness(&plane),
        _ if plane.is_of_film => None,
        _ => distance(&plane),
    };
    let Some(depth) = depth else {
        let how = "the file does not say how its";
        let remark =
            (count > 1).then(|| format!("{how} {count} pictures lie: they are stacked in their order"));
        // The aspect ratio of pixels is known.
        let [between_rows, between_columns] = plane.spacing.unwrap_or([1.0; 2]);
        let placement = match plane.spacing {
            Some(_) => Placement::spaced([between_columns, between_rows, between_rows]).of_unknown_scale(),
            None => Placement::unknown(),
        };
        return as_layers(slices, placement.remarked(remark));
    };
    let placement = match plane.normal() {
        Some(normal) if plane.position.is_some() && plane.spacing.is_some() => {
            // Some programs encode the direction in the sign.
            let sign = plane.between.map_or(1.0, f64::signum);
            placed(&plane, Some(normal * depth.depth_mm * sign))
        }
        _ => spaced(&plane, depth.depth_mm),
    };
    let placement = placement.remarked(spacing_remark(&plane)).remarked(depth.remark);
    as_layers(slices, placement)
}
