//! Stack of segmentation frames: groups masks by position, and restores the empty slices that files omit.

use std::ops::Range;

use super::StackedVolume;
use super::placement::{placement_from_positions, slice_spacing};
use super::positions::{ImagePose, PositionGroups};
use super::slice_grid::SliceGrid;
use crate::formats::dicom::slice_layer::{DicomSlice, GapFill, SliceLayer};
use crate::reading::placement::GridPlacement;

/// Builds the volume of masks, each of one segment at one position; without positions every mask is a layer.
pub(super) fn segment_volume(slices: Vec<DicomSlice>) -> StackedVolume {
    let name = String::new();
    let normal = slices.first().and_then(|slice| slice.plane.normal());
    let pose = |slice: &DicomSlice| {
        let place_mm = Some(slice.plane.position?.dot(normal?)).filter(|place| place.is_finite())?;
        Some(ImagePose { position_mm: place_mm, attributes: slice.plane.attributes })
    };
    let Some(poses) = slices.iter().map(pose).collect::<Option<Vec<ImagePose>>>() else {
        let remark =
            (slices.len() > 1).then_some("the file does not state the positions of its segment masks");
        let layers = (0..slices.len()).map(|mask| SliceLayer::Masks(mask..mask + 1)).collect();
        return StackedVolume {
            name,
            slices,
            layers,
            placement: GridPlacement::unknown().with_remark(remark),
        };
    };
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by(|&a, &b| poses[a].position_mm.total_cmp(&poses[b].position_mm));
    let PositionGroups(places) =
        PositionGroups::new(&poses, &order, PositionGroups::tolerance_mm(&poses, &order));
    let slices: Vec<DicomSlice> = order.iter().map(|&picture| slices[picture]).collect();
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for place in &places {
        let start = ranges.last().map_or(0, |range| range.end);
        ranges.push(start..start + place.len());
    }
    if places.len() < 2 {
        let placement = placement_from_positions(&slices, 1);
        return StackedVolume {
            name,
            slices,
            layers: ranges.into_iter().map(SliceLayer::Masks).collect(),
            placement,
        };
    }
    let places_mm: Vec<f64> = places.iter().map(|place| poses[place[0]].position_mm).collect();
    let stated_spacing =
        slices.first().and_then(|slice| slice_spacing(&slice.plane)).map(|depth| depth.depth_mm);
    let SliceGrid { layers, remark, .. } = SliceGrid::new(&places_mm, GapFill::NoSegment, stated_spacing);
    let masks = |layer| match layer {
        SliceLayer::Slice(place) => SliceLayer::Masks(ranges[place].clone()),
        SliceLayer::Blend { pictures: [low, high], share, is_missing: false } => {
            SliceLayer::Masks(ranges[if share < 0.5 { low } else { high }].clone())
        }
        SliceLayer::Blend { .. } | SliceLayer::Masks(_) | SliceLayer::Empty => SliceLayer::Empty,
    };
    let layers: Vec<SliceLayer> = layers.into_iter().map(masks).collect();
    let placement = placement_from_positions(&slices, layers.len()).with_remark(remark);
    StackedVolume { name, slices, layers, placement }
}
