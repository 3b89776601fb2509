//! How a file of bare voxels may be stored, by what its bytes are like.
//!
//! Neighbours in a volume are alike. In a wrong number type or byte order they jump; at a wrong distance, what is taken
//! for the next row or slice is less like this one than what lies a voxel further on. A few thousand voxels at several
//! places of the file tell, whatever its size; positions and lengths are in bytes of the file after inflating, distances
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

/// Proposals that are given, the likeliest first.
const MOST: usize = 8;

/// Number types that are looked at more closely: of those behind these, none is ever right.
const CODES: usize = 4;

/// Number types that take so many times the bits of the best are not looked at.
const HOPELESS: f64 = 1.6;

/// How a file may be stored, the likeliest first; nothing if the work was given up.
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
        // Numbers that begin at odd places are believed where they are by far the best.
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

/// The likeliest shapes of a file of such numbers.
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
