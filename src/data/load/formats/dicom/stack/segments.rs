//! Stack of segmentation frames: groups masks by position, and restores the empty slices that files omit.

use std::ops::Range;

use super::StackedVolume;
use super::grid::SliceGrid;
use super::placement::{distance, of_positions};
use super::places::{Places, Pose};
use crate::data::load::formats::dicom::layer::{Filling, Layer, Slice};
use crate::data::load::reading::placement::Placement;

/// Builds the volume of masks, each of one segment at one position; without positions every mask is a layer.
pub(super) fn of_segments(slices: Vec<Slice>) -> StackedVolume {
    let name = String::new();
    let normal = slices.first().and_then(|slice| slice.plane.normal());
    let pose = |slice: &Slice| {
        let place_mm = Some(slice.plane.position?.dot(normal?)).filter(|place| place.is_finite())?;
        Some(Pose { place_mm, taken: slice.plane.taken })
    };
    let Some(poses) = slices.iter().map(pose).collect::<Option<Vec<Pose>>>() else {
        let remark =
            (slices.len() > 1).then_some("the file does not say where the masks of its segments lie");
        let layers = (0..slices.len()).map(|mask| Layer::Masks(mask..mask + 1)).collect();
        return StackedVolume { name, slices, layers, placement: Placement::unknown().remarked(remark) };
    };
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by(|&a, &b| poses[a].place_mm.total_cmp(&poses[b].place_mm));
    let Places(places) = Places::new(&poses, &order, Places::tolerance_mm(&poses, &order));
    let slices: Vec<Slice> = order.iter().map(|&picture| slices[picture]).collect();
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for place in &places {
        let start = ranges.last().map_or(0, |range| range.end);
        ranges.push(start..start + place.len());
    }
    if places.len() < 2 {
        let placement = of_positions(&slices, 1);
        return StackedVolume {
            name,
            slices,
            layers: ranges.into_iter().map(Layer::Masks).collect(),
            placement,
        };
    }
    let places_mm: Vec<f64> = places.iter().map(|place| poses[place[0]].place_mm).collect();
    let said = slices.first().and_then(|slice| distance(&slice.plane)).map(|depth| depth.depth_mm);
    let SliceGrid { layers, remark, .. } = SliceGrid::new(&places_mm, Filling::NoSegment, said);
    let masks = |layer| match layer {
        Layer::Picture(place) => Layer::Masks(ranges[place].clone()),
        Layer::Between { pictures: [low, high], share, is_missing: false } => {
            Layer::Masks(ranges[if share < 0.5 { low } else { high }].clone())
        }
        Layer::Between { .. } | Layer::Masks(_) | Layer::Empty => Layer::Empty,
    };
    let layers: Vec<Layer> = layers.into_iter().map(masks).collect();
    let placement = of_positions(&slices, layers.len()).remarked(remark);
    StackedVolume { name, slices, layers, placement }
}
