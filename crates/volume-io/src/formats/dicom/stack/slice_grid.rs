//! Regular grid of layers for slices along a line: every slice keeps its position, whatever is missing.

use crate::formats::dicom::slice_layer::{GapFill, SliceLayer};

/// Tolerance of a slice's position on an even grid, as a share of the spacing.
const POSITION_TOLERANCE: f64 = 0.05;

/// Maximum deviation of a grid's fitted spacing from the candidate spacing, as a share.
const SPACING_TOLERANCE: f64 = 0.1;

/// Maximum number of layers per slice of an even grid: beyond it, more would be interpolated than was measured.
const MAX_LAYERS_PER_SLICE: usize = 4;

/// Additional layers, so that the few slices of a small volume may be far apart.
const EXTRA_LAYERS: usize = 256;

/// Maximum number of layers of a segmentation, which stores only non-empty slices: four times the longest scans.
const MAX_SEGMENT_LAYERS: usize = 1 << 14;

/// Maximum number of consecutive missing slices that are interpolated; linear interpolation across longer gaps is
/// meaningless.
const MAX_INTERPOLATED_SLICES: f64 = 3.0;

/// Layers with constant spacing, made from slices.
#[derive(Debug)]
pub(crate) struct SliceGrid {
    pub(crate) layers: Vec<SliceLayer>,
    /// Spacing of the layers, in the unit of the slices' positions.
    pub(crate) spacing: f64,
    pub(crate) remark: Option<String>,
}

impl SliceGrid {
    /// Builds the grid of slices at ascending positions, in millimetres; at least two.
    ///
    /// `distance_mm` is the spacing that the header states, used for segments only.
    pub(crate) fn new(places_mm: &[f64], filling: GapFill, distance_mm: Option<f64>) -> Self {
        let (first, last) = (places_mm[0], places_mm[places_mm.len() - 1]);
        let span = last - first;
        let distances: Vec<f64> = places_mm.windows(2).map(|two| two[1] - two[0]).collect();
        let mut sorted = distances.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |share: usize| sorted[(sorted.len() - 1) * share / 4];
        let (shortest, quarter, median, longest) = (sorted[0], at(1), at(2), sorted[sorted.len() - 1]);
        let most = match filling {
            GapFill::NoSegment => MAX_SEGMENT_LAYERS.max(places_mm.len()),
            _ => MAX_LAYERS_PER_SLICE * places_mm.len() + EXTRA_LAYERS,
        };
        let stated_spacing = distance_mm.filter(|_| filling == GapFill::NoSegment);
        let mean = span / distances.len() as f64;
        let candidates = stated_spacing.into_iter().chain([mean, median, quarter, shortest]);
        for candidate in candidates {
            if let Some(steps) = whole_steps(places_mm, candidate, most) {
                return Self::from_steps(&steps, span, filling);
            }
        }
        let spacing_text =
            format!("its slices are {} to {} apart", format_length(shortest), format_length(longest));
        let intervals = (span / quarter).round().max(1.0);
        let has_room = intervals < most as f64;
        if !has_room {
            let layers = (0..places_mm.len()).map(SliceLayer::Slice).collect();
            let remark = format!(
                "{spacing_text}, too unevenly to show each at its position: they are shown {} apart",
                format_length(mean)
            );
            return Self { layers, spacing: mean, remark: Some(remark) };
        }
        let distance = span / intervals;
        let is_bridged = interpolated_gaps(&distances, median, filling);
        let layers: Vec<SliceLayer> = (0..=intervals as usize)
            .map(|step| layer_at(places_mm, first + step as f64 * distance, distance, &is_bridged))
            .collect();
        let empty = layers.iter().filter(|layer| **layer == SliceLayer::Empty).count();
        let how = match filling {
            GapFill::Interpolate => "interpolated to layers",
            GapFill::Nearest | GapFill::NoSegment => "resampled (nearest slice) to layers",
        };
        let left = if empty > 0 { format!(", {empty} in long gaps are left empty") } else { String::new() };
        Self {
            layers,
            spacing: distance,
            remark: Some(format!("{spacing_text}: they are {how} {} apart{left}", format_length(distance))),
        }
    }

    /// Builds the grid of slices that lie at these whole steps of it.
    fn from_steps(steps: &[usize], span: f64, filling: GapFill) -> Self {
        let last = steps[steps.len() - 1];
        let distance = span / last as f64;
        let mut layers = Vec::with_capacity(last + 1);
        let distances: Vec<f64> = steps.windows(2).map(|two| (two[1] - two[0]) as f64).collect();
        let is_bridged = interpolated_gaps(&distances, 1.0, filling);
        let (mut interpolated, mut empty) = (0, 0);
        for (slice, two) in steps.windows(2).enumerate() {
            layers.push(SliceLayer::Slice(slice));
            let missing = two[1] - two[0] - 1;
            let is_bridged = is_bridged[slice];
            *(if is_bridged { &mut interpolated } else { &mut empty }) += missing;
            for step in 1..=missing {
                let share = step as f64 / (missing + 1) as f64;
                layers.push(if is_bridged {
                    SliceLayer::Blend { pictures: [slice, slice + 1], share, is_missing: true }
                } else {
                    SliceLayer::Empty
                });
            }
        }
        layers.push(SliceLayer::Slice(steps.len() - 1));
        let missing = interpolated + empty;
        let remark = (missing > 0 && filling != GapFill::NoSegment).then(|| {
            let fill_text = match (filling, interpolated, empty) {
                (GapFill::Interpolate, _, 0) => "interpolated between their neighbours".to_owned(),
                (GapFill::Interpolate, 0, _) => "left empty".to_owned(),
                (GapFill::Interpolate, ..) => {
                    format!("{interpolated} interpolated between their neighbours, {empty} in longer gaps left empty")
                }
                _ => "filled with the nearest slice".to_owned(),
            };
            let are = if missing == 1 { "slice is" } else { "slices are" };
            format!("{missing} {are} missing of {}, {} apart: {fill_text}", last + 1, format_length(distance))
        });
        Self { layers, spacing: distance, remark }
    }
}

/// Formats a length for the user, however large.
fn format_length(length_mm: f64) -> String {
    let is_usual = (1e-3..1e6).contains(&length_mm);
    if is_usual { format!("{length_mm:.4} mm") } else { format!("{length_mm:e} mm") }
}

/// Returns the step index of each slice, if all lie on an even grid of about this spacing.
fn whole_steps(places: &[f64], distance: f64, most: usize) -> Option<Vec<usize>> {
    let first = places[0];
    let span = places[places.len() - 1] - first;
    if !(distance > 0.0 && span.is_finite() && span / distance < most as f64) {
        return None;
    }
    // Step by step, so that an error of the spacing does not accumulate.
    let mut steps = vec![0];
    for two in places.windows(2) {
        let step = ((two[1] - two[0]) / distance).round();
        if step < 1.0 {
            return None;
        }
        steps.push(steps[steps.len() - 1] + step as usize);
    }
    let last = steps[steps.len() - 1];
    let is_about_said = |found: f64| (found / distance - 1.0).abs() <= SPACING_TOLERANCE;
    let distance = Some(span / last as f64).filter(|&found| is_about_said(found))?;
    let is_near = |(place, step): (&f64, &usize)| {
        (place - first - *step as f64 * distance).abs() <= POSITION_TOLERANCE * distance
    };
    (last < most && places.iter().zip(&steps).all(is_near)).then_some(steps)
}

/// Returns for each gap if values are interpolated across it: unless it is much longer than the usual spacing and
/// than both adjacent gaps.
fn interpolated_gaps(distances: &[f64], usual: f64, filling: GapFill) -> Vec<bool> {
    if filling != GapFill::Interpolate {
        return vec![true; distances.len()];
    }
    let longest = MAX_INTERPOLATED_SLICES + 1.5;
    let is_bridged = |at: usize| {
        let beside =
            [at.checked_sub(1), Some(at + 1)].into_iter().flatten().filter_map(|at| distances.get(at));
        let beside = beside.copied().fold(usual, f64::max);
        distances[at] < longest * beside
    };
    (0..distances.len()).map(is_bridged).collect()
}

/// Returns the layer at a position between the first and the last slice.
fn layer_at(places: &[f64], place: f64, distance: f64, is_bridged: &[bool]) -> SliceLayer {
    let above = places.partition_point(|slice| *slice < place).clamp(1, places.len() - 1);
    let [low, high] = [places[above - 1], places[above]];
    // A slice close enough is used as it is, which is sharper than a blend.
    if place - low <= POSITION_TOLERANCE * distance {
        return SliceLayer::Slice(above - 1);
    } else if high - place <= POSITION_TOLERANCE * distance {
        return SliceLayer::Slice(above);
    } else if !is_bridged[above - 1] {
        return SliceLayer::Empty;
    }
    SliceLayer::Blend { pictures: [above - 1, above], share: (place - low) / (high - low), is_missing: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(places: &[f64]) -> SliceGrid {
        SliceGrid::new(places, GapFill::Interpolate, None)
    }

    fn between(low: usize, share: f64, is_missing: bool) -> SliceLayer {
        SliceLayer::Blend { pictures: [low, low + 1], share, is_missing }
    }

    #[test]
    fn even_slices_are_layers() {
        let even = grid(&[1.0, 3.0, 5.04, 7.0]);
        assert_eq!(even.layers, [0, 1, 2, 3].map(SliceLayer::Slice));
        assert_eq!((even.spacing, even.remark), (2.0, None));
        assert_eq!(grid(&[1.0, 4.0]).spacing, 3.0);
    }

    #[test]
    fn a_missing_slice_keeps_the_others_at_their_places() {
        let found = grid(&[0.0, 2.0, 4.0, 8.0, 10.0]);
        let picture = SliceLayer::Slice;
        let expected = [picture(0), picture(1), picture(2), between(2, 0.5, true), picture(3), picture(4)];
        assert_eq!((found.layers, found.spacing), (expected.to_vec(), 2.0));
        assert!(found.remark.unwrap().starts_with("1 slice is missing of 6, 2.0000 mm apart: interpolated"));
        // Of three slices the shorter distance is the spacing.
        assert_eq!(
            grid(&[0.0, 4.0, 6.0]).layers,
            [picture(0), between(0, 0.5, true), picture(1), picture(2)]
        );
    }

    #[test]
    fn long_gaps_are_left_empty() {
        let places: Vec<f64> = (0..5).chain(12..15).chain(17..20).map(f64::from).collect();
        let found = grid(&places);
        assert_eq!(found.layers.len(), 20);
        for (at, layer) in found.layers.iter().enumerate() {
            let is_there = places.contains(&(at as f64));
            assert_eq!(matches!(layer, SliceLayer::Slice(_)), is_there, "{at}");
            assert_eq!(*layer == SliceLayer::Empty, (5..12).contains(&at), "{at}");
        }
        assert!(found.remark.unwrap().contains("9 slices are missing of 20"));
        // If all slices of a region lie far apart, there is no gap.
        let thick = grid(&[0.0, 1.0, 2.0, 3.0, 4.0, 10.0, 16.0, 22.0]);
        assert!(!thick.layers.contains(&SliceLayer::Empty), "{:?}", thick.layers);
        assert_eq!(thick.layers.len(), 23);
    }

    #[test]
    fn uneven_slices_are_interpolated() {
        let found = grid(&[0.0, 1.0, 2.4]);
        assert_eq!(found.spacing, 1.2);
        assert_eq!(found.layers[0], SliceLayer::Slice(0));
        let SliceLayer::Blend { pictures: [1, 2], share, .. } = found.layers[1] else {
            panic!("{:?}", found.layers)
        };
        assert!((share - 0.2 / 1.4).abs() < 1e-12);
        assert!(found.remark.unwrap().contains("1.0000 mm to 1.4000 mm apart"));
    }

    #[test]
    fn grids_are_bounded() {
        for places in
            [&[0.0, 1.0, 1e9][..], &[0.0, 1e-300, 1.0], &[-1e308, 0.0, 1e308], &[0.0, 1e308, 1.7e308]]
        {
            let found = grid(places);
            assert!(found.layers.len() <= 4 * 3 + EXTRA_LAYERS, "{places:?}: {}", found.layers.len());
            assert!(found.spacing > 0.0);
        }
        let segments = SliceGrid::new(&[0.0, 1.0, 1e9], GapFill::NoSegment, Some(1e-9));
        assert!(segments.layers.len() <= MAX_SEGMENT_LAYERS);
    }

    #[test]
    fn segments_lie_at_the_distance_that_is_said() {
        let found = SliceGrid::new(&[3.0, 9.0], GapFill::NoSegment, Some(2.0));
        assert_eq!((found.layers.len(), found.spacing, found.remark), (4, 2.0, None));
        let wrong = SliceGrid::new(&[3.0, 9.0], GapFill::NoSegment, Some(3.5));
        assert_eq!((wrong.layers.len(), wrong.spacing), (2, 6.0));
    }
}
