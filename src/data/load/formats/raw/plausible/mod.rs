//! Detection of the layout of raw files, by statistics of their bytes.
//!
//! Neighbouring voxels are similar. With a wrong number type or byte order they jump; at a wrong distance, the
//! supposed next row or slice is less similar than one shifted by a voxel. A few thousand voxels at several places
//! suffice, whatever the size of the file. Offsets and lengths are in bytes of the uncompressed file, distances
//! between neighbours in voxels.

mod codes;
mod evidence;
mod lags;
mod numbers;
mod shapes;
mod spots;
#[cfg(test)]
mod tests;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

use super::bytes::RawBytes;
use super::said::Said;
use codes::Code;
pub use evidence::{Evidence, Proposal};
use lags::Lags;
pub(super) use numbers::each_value;
use shapes::{Shape, Size};
use spots::Spots;

/// Maximum number of proposals.
const MOST: usize = 8;

/// Number of interpretations that are examined more closely: those ranked lower are never right.
const CODES: usize = 4;

/// Maximum cost of an interpretation, relative to the best.
const HOPELESS: f64 = 1.6;

/// Proposes layouts of a file, most likely first; empty if `stop` was set meanwhile.
///
/// # Errors
/// When the file cannot be read.
pub fn proposals(bytes: &mut RawBytes, said: Said, stop: &AtomicBool) -> io::Result<Vec<Proposal>> {
    if bytes.is_empty() {
        return Ok(Vec::new());
    }
    let spots = Spots::read(bytes)?;
    let codes = codes::ranked(&spots, said);
    let mut found: Vec<Proposal> = Vec::new();
    let best = codes.first().map_or(0.0, |code| code.cost);
    for code in codes.iter().take(CODES).filter(|code| code.cost <= HOPELESS * best) {
        if stop.load(Ordering::Relaxed) {
            return Ok(Vec::new());
        }
        let size = Size::of(bytes, code);
        // Unaligned numbers count only where they are by far the best.
        if found.is_empty() || size.is_usual() {
            found.extend(of_code(bytes, &spots, code, said, stop)?);
        }
    }
    found.sort_by(|a, b| b.evidence.score.total_cmp(&a.evidence.score));
    found.dedup_by(|later, first| later.layout == first.layout);
    found.truncate(MOST);
    evidence::judge(&mut found);
    Ok(found)
}

/// Most likely shapes of a file for one interpretation.
fn of_code(
    bytes: &mut RawBytes,
    spots: &Spots,
    code: &Code,
    said: Said,
    stop: &AtomicBool,
) -> io::Result<Vec<Proposal>> {
    let size = Size::of(bytes, code);
    let lags = Lags::of(bytes, spots, code)?;
    let rows = shapes::rows(&size, &lags, said);
    let agreeing = shapes::agreeing(&lags, &rows);
    let mut shapes: Vec<Shape> = Vec::new();
    for row in rows {
        shapes.extend(shapes::slices(bytes, &size, &lags, row, &agreeing, said)?);
        if stop.load(Ordering::Relaxed) {
            return Ok(Vec::new());
        }
    }
    shapes.sort_by(|a, b| b.score.total_cmp(&a.score));
    shapes.truncate(MOST);
    Ok(shapes.iter().flat_map(|shape| evidence::of(code, shape, said)).collect())
}
