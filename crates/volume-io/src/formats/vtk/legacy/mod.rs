//! VTK images in the legacy format: lines of text, each followed by the values that it announces, as text or as
//! big-endian bytes.
//!
//! The format does not give the length of the values in the file: all are skipped in turn to find the arrays.

mod lines;
mod scan;
#[cfg(test)]
mod tests;

use super::super::reader::{FileStart, VolumeSource};
use super::super::text_numbers::TextNumbers;
use super::super::{Endian, LoadError};
use super::image::{check_available, choose_array, open_content_at};
use chiaroscuro_volume::{LoadContext, Volume};
use lines::LegacyLines;
use scan::{LegacyScan, LegacyValueLocation};

/// Returns true if a file with this beginning is legacy VTK.
pub(super) fn is_legacy(start: &FileStart) -> bool {
    start.has_at(b"# vtk DataFile Version", 0)
}

pub(super) fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the VTK image", path: source.path };
    let (control, options) = (source.control, source.options);
    let lines = LegacyLines::new(context, open_content_at(context, &mut source, 0)?, control);
    let LegacyScan { title, is_text, grid, arrays, .. } = LegacyScan::read(context, lines)?;
    let chosen = choose_array(context, &grid, arrays, options, control)?;
    let name = chosen.array.name.as_str();
    let LegacyValueLocation { start, are_fractions: are_shares } = chosen.array.location;
    let room = if source.start.is_gzip() { u64::MAX } else { source.input.len.saturating_sub(start) };
    let voxels = if is_text {
        // At least a digit and a space each.
        check_available(context, name, chosen.numbers(), room.div_ceil(2), "numbers")?;
        let text = open_content_at(context, &mut source, start)?;
        let mut numbers = if are_shares {
            TextNumbers::new_fractions(text, chosen.numbers())
        } else {
            TextNumbers::new(text, chosen.array.number, chosen.numbers())
        };
        chosen.read(context, &mut numbers, Endian::Little, control)?
    } else {
        check_available(context, name, chosen.stored_bytes(), room, "bytes")?;
        let mut bytes = open_content_at(context, &mut source, start)?;
        chosen.read(context, &mut bytes, Endian::Big, control)?
    };
    chosen.volume(context, &grid, voxels, &title, control)
}
