//! Pictures in the order in which they lie, and where they lie.
//!
//! The order is that of their positions across the pictures, never that of their numbers, unless nothing else is said.
//! Several that lie at each place are phases, of which each is a volume.

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

/// A volume: its slices, and the layers of an even grid that are made of them.
#[derive(Debug)]
pub(crate) struct StackedVolume {
    /// What sets it apart from others of the same series; empty where there are none.
    pub(crate) name: String,
    pub(crate) slices: Vec<Slice>,
    pub(crate) layers: Vec<Layer>,
    pub(crate) placement: Placement,
}

/// The volumes of a series: one, or one for each phase.
#[derive(Debug)]
pub(crate) struct Stack {
    /// At least one.
    pub(crate) volumes: Vec<StackedVolume>,
    /// What users should know of all of them.
    pub(crate) remarks: Vec<String>,
    /// Slices lie at places of their own: it is no film.
    pub(crate) has_depth: bool,
}

/// What says where pictures lie along the line across them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    /// Positions, across the pictures.
    Positions,
    /// Positions, along the axis along which they differ most: which way pictures lie is not said.
    Axis,
    /// Slice Location.
    Locations,
}

impl Stack {
    /// Puts pictures that lie in parallel in order. There is at least one.
    ///
    /// `has_masks` says that they are masks of segments; `image_types` are the texts that [`Attribute::ImageType`] counts.
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
    /// Where pictures lie, millimetres; `None` where it is not said of all of them.
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

    /// The volume of a phase's pictures.
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

/// Leaves out the few pictures that do not say where they lie, where most do.
fn drop_unplaced(slices: &mut Vec<Slice>, remarks: &mut Vec<String>) {
    let total = slices.len();
    let placed = slices.iter().filter(|slice| slice.plane.position.is_some()).count();
    if placed < total && 2 * placed > total {
        slices.retain(|slice| slice.plane.position.is_some());
        let left_out = total - placed;
        remarks.push(format!("{left_out} of {total} pictures do not say where they lie: they are left out"));
    }
}

/// The axis of space along which positions differ most.
fn longest_axis(slices: &[Slice]) -> Option<DVec3> {
    let positions = slices.iter().filter_map(|slice| slice.plane.position);
    let first = slices.first()?.plane.position?;
    let (low, high) = positions.fold((first, first), |(low, high), at| (low.min(at), high.max(at)));
    let span = high - low;
    let axes = [(span.x, DVec3::X), (span.y, DVec3::Y), (span.z, DVec3::Z)];
    axes.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
}

/// Slices so far apart, with the pixels that a picture has.
fn spaced(plane: &Plane, distance_mm: f64) -> Placement {
    match plane.spacing {
        Some([between_rows, between_columns]) => {
            Placement::spaced([between_columns, between_rows, distance_mm])
        }
        None => Placement::unknown(),
    }
}

/// Every picture is a layer.
fn as_layers(slices: Vec<Slice>, placement: Placement) -> StackedVolume {
    let layers = (0..slices.len()).map(Layer::Picture).collect();
    StackedVolume { name: String::new(), slices, layers, placement }
}

/// Pictures that lie all at one place, taken one after the other.
fn film(mut slices: Vec<Slice>) -> StackedVolume {
    slices.sort_by(|a, b| by_time(&a.plane.taken, &b.plane.taken));
    let remark = format!(
        "its {} pictures lie all at one place: they are stacked in the order in which they were taken",
        slices.len()
    );
    as_layers(slices, Placement::unknown().remarked(Some(remark)))
}

/// Pictures of which it is not said where each lies: in the order of their numbers, or else of their files' names.
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
    // Frames that follow each other in time do not lie above each other.
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
        // How pixels compare is known.
        let [between_rows, between_columns] = plane.spacing.unwrap_or([1.0; 2]);
        let placement = match plane.spacing {
            Some(_) => Placement::spaced([between_columns, between_rows, between_rows]).of_unknown_scale(),
            None => Placement::unknown(),
        };
        return as_layers(slices, placement.remarked(remark));
    };
    let placement = match plane.normal() {
        Some(normal) if plane.position.is_some() && plane.spacing.is_some() => {
            // Some say the direction by the sign.
            let sign = plane.between.map_or(1.0, f64::signum);
            placed(&plane, Some(normal * depth.depth_mm * sign))
        }
        _ => spaced(&plane, depth.depth_mm),
    };
    let placement = placement.remarked(spacing_remark(&plane)).remarked(depth.remark);
    as_layers(slices, placement)
}
