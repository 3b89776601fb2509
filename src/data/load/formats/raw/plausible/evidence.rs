//! What speaks for a way of storing a file.

use super::super::layout::RawLayout;
use super::super::said::Said;
use super::codes::Code;
use super::shapes::{HEADERS, Shape};

/// Deviations beyond which agreement is no chance, whatever the number of distances that were tried.
const SURE: f64 = 4.0;

/// Numbers whose differences take so many bits a byte are hardly told from noise, of which each takes 8.
const NOISE_BITS: f64 = 7.5;

/// A score that is so much higher than the next is clear: above what a usual header costs (0.15), which a slice more or
/// less can imitate, it would never be.
const CLEAR: f64 = 0.1;

/// So much less likely is the other sign.
const TWIN: f64 = 0.05;

/// What speaks for a proposal. Differences are shares of the range of the values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Mean difference of neighbours along x, y and z.
    pub neighbours: [f64; 3],
    /// Mean difference of voxels that have nothing to do with each other.
    pub strangers: f64,
    /// How much nearer the next row is than what lies beside it, as a share of that.
    pub row_depth: f64,
    /// The same of the next slice.
    pub slice_depth: f64,
    /// Whether rows agree more than by chance.
    pub rows_agree: bool,
    /// Whether slices agree more than by chance.
    pub slices_agree: bool,
    /// Whether the file's name says these dimensions.
    pub is_named: bool,
    /// Bits that a byte of the file takes when told as differences.
    pub bits: f64,
    /// Whether this is far likelier than all others.
    pub is_clear: bool,
    pub(super) score: f64,
}

/// A way of storing a file, and what speaks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proposal {
    /// How the file would be stored.
    pub layout: RawLayout,
    /// What speaks for it.
    pub evidence: Evidence,
}

/// A proposal, and the same with or without a sign if that makes another picture.
pub(super) fn of(code: &Code, shape: &Shape, said: Said) -> impl Iterator<Item = Proposal> {
    let layout = RawLayout {
        dims: shape.dims,
        voxel_type: code.voxel_type,
        spacing_mm: None,
        endian: code.endian,
        offset: shape.header,
    };
    let evidence = Evidence {
        neighbours: [shape.across, shape.row.difference, shape.slice.difference],
        strangers: shape.unlike,
        row_depth: shape.row.depth,
        slice_depth: shape.slice.depth,
        rows_agree: shape.row.sigmas > SURE,
        slices_agree: shape.slice.sigmas > SURE,
        is_named: said.dims == Some(shape.dims),
        bits: code.bits,
        is_clear: false,
        score: shape.score - 3.0 * (code.cost + 0.05).ln(),
    };
    let twin = code.twin.map(|voxel_type| Proposal {
        layout: RawLayout { voxel_type, ..layout },
        evidence: Evidence { score: evidence.score - TWIN, ..evidence },
    });
    std::iter::once(Proposal { layout, evidence }).chain(twin)
}

/// Says of the first whether it is far likelier than all others: whether its rows and slices agree beyond chance, its
/// numbers are not noise, and nothing else comes near, but for the sign of the numbers.
pub(super) fn judge(found: &mut [Proposal]) {
    let Some((first, others)) = found.split_first_mut() else { return };
    let Evidence { rows_agree, slices_agree, bits, score, .. } = first.evidence;
    let is_other = |other: &&Proposal| {
        let (a, b) = (first.layout, other.layout);
        a.dims != b.dims || a.offset != b.offset || a.voxel_type.bytes() != b.voxel_type.bytes()
    };
    let next = others.iter().find(is_other).map_or(f64::NEG_INFINITY, |other| other.evidence.score);
    // A header that nobody has may be something else.
    let is_usual = HEADERS.contains(&first.layout.offset);
    first.evidence.is_clear =
        is_usual && rows_agree && slices_agree && bits < NOISE_BITS && score > next + CLEAR;
}
