//! Evidence for a proposed layout of a raw file, and the decision whether it is clear.

use super::super::layout::RawLayout;
use super::super::name_hints::RawNameHints;
use super::number_candidates::NumberCandidate;
use super::shapes::{HEADERS, ScoredShape};

/// Standard deviations beyond which agreement is not chance, whatever the number of lags that were tried.
const SURE_SIGMAS: f64 = 4.0;

/// Entropy, in bits per byte, from which numbers are hardly distinguishable from noise, which has 8.
const NOISE_BITS: f64 = 7.5;

/// Score difference to the next proposal that is clear. It is below the penalty of a usual header (0.15), which one
/// slice more or less can imitate, or no proposal would be clear.
const CLEAR_MARGIN: f64 = 0.1;

/// Deduction from the score for the opposite signedness.
const SIGNEDNESS_PENALTY: f64 = 0.05;

/// Evidence for a proposal. Differences are relative to the value range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayoutEvidence {
    /// Mean difference of neighbours along x, y and z.
    pub neighbour_differences: [f64; 3],
    /// Mean difference of unrelated voxels.
    pub unrelated_difference: f64,
    /// Relative depth of the dip at the next row.
    pub row_depth: f64,
    /// Relative depth of the dip at the next slice.
    pub slice_depth: f64,
    /// True if rows agree more than by chance.
    pub rows_agree: bool,
    /// True if slices agree more than by chance.
    pub slices_agree: bool,
    /// True if the file name gives these dimensions.
    pub is_named: bool,
    /// Estimated entropy of differences, in bits per byte of the file.
    pub bits: f64,
    /// True if this proposal is far more likely than all others.
    pub is_clear: bool,
    pub(super) score: f64,
}

/// Proposed layout of a raw file, with the evidence for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayoutProposal {
    /// Layout of the voxels in the file.
    pub layout: RawLayout,
    /// Evidence for the layout, for the user.
    pub evidence: LayoutEvidence,
}

/// Creates a proposal, and that of the opposite signedness if it gives a different image.
pub(super) fn proposals_from_shape(
    code: &NumberCandidate,
    shape: &ScoredShape,
    said: RawNameHints,
) -> impl Iterator<Item = LayoutProposal> {
    let layout = RawLayout {
        dims: shape.dims,
        voxel_type: code.voxel_type,
        spacing_mm: None,
        endian: code.endian,
        offset: shape.header,
    };
    let evidence = LayoutEvidence {
        neighbour_differences: [shape.neighbour_difference, shape.row.difference, shape.slice.difference],
        unrelated_difference: shape.unrelated_difference,
        row_depth: shape.row.depth,
        slice_depth: shape.slice.depth,
        rows_agree: shape.row.sigmas > SURE_SIGMAS,
        slices_agree: shape.slice.sigmas > SURE_SIGMAS,
        is_named: said.dims == Some(shape.dims),
        bits: code.bits,
        is_clear: false,
        score: shape.score - 3.0 * (code.cost + 0.05).ln(),
    };
    let twin = code.other_signedness.map(|voxel_type| LayoutProposal {
        layout: RawLayout { voxel_type, ..layout },
        evidence: LayoutEvidence { score: evidence.score - SIGNEDNESS_PENALTY, ..evidence },
    });
    std::iter::once(LayoutProposal { layout, evidence }).chain(twin)
}

/// Decides whether the first proposal is clear: its rows and slices agree beyond chance, its numbers are not noise,
/// and no other proposal comes near, except for the signedness.
pub(super) fn mark_clear(found: &mut [LayoutProposal]) {
    let Some((first, others)) = found.split_first_mut() else { return };
    let LayoutEvidence { rows_agree, slices_agree, bits, score, .. } = first.evidence;
    let is_other = |other: &&LayoutProposal| {
        let (a, b) = (first.layout, other.layout);
        a.dims != b.dims || a.offset != b.offset || a.voxel_type.bytes() != b.voxel_type.bytes()
    };
    let next = others.iter().find(is_other).map_or(f64::NEG_INFINITY, |other| other.evidence.score);
    // An unusual header may be something else.
    let is_usual = HEADERS.contains(&first.layout.offset);
    first.evidence.is_clear =
        is_usual && rows_agree && slices_agree && bits < NOISE_BITS && score > next + CLEAR_MARGIN;
}
