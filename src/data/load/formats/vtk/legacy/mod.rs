//! VTK images in the legacy format: lines of text, each followed by the values that it announces, as text or as
//! big-endian bytes.
//!
//! The format does not give the length of the values in the file: all are skipped in turn to find the arrays.

mod lines;
mod scan;
#[cfg(test)]
mod tests;

use super::super::reader::{Source, Start};
use super::super::text_numbers::TextNumbers;
use super::super::{Endian, LoadError};
use super::image::{check_room, choose, content_from};
use crate::data::Volume;
use crate::data::attempt::Attempt;
use lines::Lines;
use scan::{Place, Scan};

/// Returns true if a file with this beginning is legacy VTK.
pub(super) fn is_legacy(start: &Start) -> bool {
    start.has(b"# vtk DataFile Version", 0)
}

pub(super) fn load(mut source: Source<'_>) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "read the VTK image", path: source.path };
    let (control, options) = (source.control, source.options);
    let lines = Lines::new(attempt, content_from(attempt, &mut source, 0)?, control);
    let Scan { title, is_text, grid, arrays, .. } = Scan::of(attempt, lines)?;
    let chosen = choose(attempt, &grid, arrays, options, control)?;
    let name = chosen.array.name.as_str();
    let Place { start, are_shares } = chosen.array.place;
    let room = if source.start.is_gzip() { u64::MAX } else { source.input.len.saturating_sub(start) };
    let voxels = if is_text {
        // At least a digit and a space each.
        check_room(attempt, name, chosen.numbers(), room.div_ceil(2), "numbers")?;
        let text = content_from(attempt, &mut source, start)?;
        let mut numbers = if are_shares {
            TextNumbers::of_shares(text, chosen.numbers())
        } else {
            TextNumbers::new(text, chosen.array.number, chosen.numbers())
        };
        chosen.read(attempt, &mut numbers, Endian::Little, control)?
    } else {
        check_room(attempt, name, chosen.stored_bytes(), room, "bytes")?;
        let mut bytes = content_from(attempt, &mut source, start)?;
        chosen.read(attempt, &mut bytes, Endian::Big, control)?
    };
    chosen.volume(attempt, &grid, voxels, &title)
}
