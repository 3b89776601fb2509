//! Detection of the layout of raw files, by statistics of their bytes.
//!
//! Neighbouring voxels are similar. With a wrong number type or byte order they jump; at a wrong distance, the
//! supposed next row or slice is less similar than one shifted by a voxel. A few thousand voxels at several places
//! suffice, whatever the size of the file. Offsets and lengths are in bytes of the uncompressed file, distances
//! between neighbours in voxels.

mod autocorrelation;
mod evidence;
mod number_candidates;
mod numbers;
mod sample_blocks;
mod shapes;
#[cfg(test)]
mod tests;

use std::io;

use super::bytes::RawBytes;
use super::name_hints::RawNameHints;
use autocorrelation::LagDifferences;
use chiaroscuro_volume::CancelToken;
pub use evidence::{LayoutEvidence, LayoutProposal};
use number_candidates::NumberCandidate;
pub(super) use numbers::for_each_value;
use sample_blocks::SampleBlocks;
use shapes::{RawFileLength, ScoredShape};

/// Maximum number of proposals.
const MAX_PROPOSALS: usize = 8;

/// Number of interpretations that are examined more closely: those ranked lower are never right.
const MAX_CANDIDATES: usize = 4;

/// Maximum cost of an interpretation, relative to the best.
const MAX_RELATIVE_COST: f64 = 1.6;

/// Proposes layouts of a file, most likely first; empty if `cancel` was cancelled meanwhile.
///
/// # Errors
/// When the file cannot be read.
pub fn propose_layouts(
    bytes: &mut RawBytes,
    said: RawNameHints,
    cancel: &CancelToken,
) -> io::Result<Vec<LayoutProposal>> {
    if bytes.is_empty() {
        return Ok(Vec::new());
    }
    let spots = SampleBlocks::read(bytes)?;
    let codes = number_candidates::rank_candidates(&spots, said);
    let mut found: Vec<LayoutProposal> = Vec::new();
    let best = codes.first().map_or(0.0, |code| code.cost);
    for code in codes.iter().take(MAX_CANDIDATES).filter(|code| code.cost <= MAX_RELATIVE_COST * best) {
        if cancel.is_cancelled() {
            return Ok(Vec::new());
        }
        let size = RawFileLength::new(bytes, code);
        // Unaligned numbers count only where they are by far the best.
        if found.is_empty() || size.fits_usual_header() {
            found.extend(proposals_for_candidate(bytes, &spots, code, said, cancel)?);
        }
    }
    found.sort_by(|a, b| b.evidence.score.total_cmp(&a.evidence.score));
    found.dedup_by(|later, first| later.layout == first.layout);
    found.truncate(MAX_PROPOSALS);
    evidence::mark_clear(&mut found);
    Ok(found)
}

/// Most likely shapes of a file for one interpretation.
fn proposals_for_candidate(
    bytes: &mut RawBytes,
    spots: &SampleBlocks,
    code: &NumberCandidate,
    said: RawNameHints,
    cancel: &CancelToken,
) -> io::Result<Vec<LayoutProposal>> {
    let size = RawFileLength::new(bytes, code);
    let lags = LagDifferences::new(bytes, spots, code)?;
    let rows = shapes::rows(&size, &lags, said);
    let agreeing = shapes::agreeing_slice_lengths(&lags, &rows);
    let mut shapes: Vec<ScoredShape> = Vec::new();
    for row in rows {
        shapes.extend(shapes::slices(bytes, &size, &lags, row, &agreeing, said)?);
        if cancel.is_cancelled() {
            return Ok(Vec::new());
        }
    }
    shapes.sort_by(|a, b| b.score.total_cmp(&a.score));
    shapes.truncate(MAX_PROPOSALS);
    Ok(shapes.iter().flat_map(|shape| evidence::proposals_from_shape(code, shape, said)).collect())
}
