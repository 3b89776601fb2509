//! The older form: lines of text, and values after those that announce them, as text or as big-endian bytes.
//!
//! Whoever writes it says nowhere how long the values are in the file: they are skipped one after the other to find all.

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

/// Whether a file that begins like this is one.
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
        // A digit each and a space between.
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
