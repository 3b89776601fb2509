//! Fixed arrays of chunks (section VII.C): a record for each chunk, in pages if there are many.

use std::ops::Range;

use super::super::super::container::Hdf5File;
use super::{ChunkGrid, ChunkIndex, FIELD, StoredChunk};
use chiaroscuro_volume::LoadError;

/// Block of records that was read last: neighbouring chunks have records in one block.
#[derive(Debug, Default)]
pub(super) struct LastBlock {
    address: Option<u64>,
    bytes: Vec<u8>,
}

impl LastBlock {
    /// Reads a block, unless it was read last.
    pub(super) fn read(&mut self, file: &Hdf5File<'_>, address: u64, count: u64) -> Result<&[u8], LoadError> {
        if self.address != Some(address) {
            self.bytes = file.read_block(address, count, FIELD)?;
            self.address = Some(address);
        }
        Ok(&self.bytes)
    }
}

/// Returns the chunks of a fixed array that lie in a box.
pub(super) fn chunks(
    file: &Hdf5File<'_>,
    header: u64,
    index: &ChunkIndex,
    grid: &ChunkGrid<'_>,
    range: &[Range<u64>],
) -> Result<Vec<StoredChunk>, LoadError> {
    let width = file.widths().address as u64;
    let head = file.read_block(header, 8 + width + file.widths().length as u64, FIELD)?;
    let record = index.record_bytes(file, grid);
    let (page_bits, count, block) = file.parse(&head, FIELD, |cursor| {
        cursor.require_signature(*b"FAHD")?;
        cursor.take(2)?;
        let (found, page_bits) = (usize::from(cursor.byte()?), cursor.byte()?);
        if found != record || page_bits > 32 {
            return Err(format!("records of {record} bytes were expected, they have {found}").into());
        }
        Ok((page_bits, cursor.length()?, cursor.address()?))
    })?;
    let Some(block) = block else { return Ok(Vec::new()) };
    let record = record as u64;
    let page = 1u64 << page_bits;
    // After signature, version, kind, and the address of the header.
    let start = block.saturating_add(6 + width);
    let pages = if count > page { count.div_ceil(page) } else { 0 };
    let used_pages = file.read_block(start, pages.div_ceil(8), FIELD)?;
    // Before the pages of a block lies a checksum, and after each one.
    let first_page = start.saturating_add(pages.div_ceil(8) + 4);
    let page_bytes = page.saturating_mul(record).saturating_add(4);
    let mut last = LastBlock::default();
    let mut found = Vec::new();
    for place in ChunkGrid::places(range) {
        let number = grid.number(&place);
        if number >= count {
            continue;
        }
        let (address, records, at) = if pages == 0 {
            (start, count, number)
        } else {
            let (of, at) = (number / page, number % page);
            if used_pages[(of / 8) as usize] & (0x80 >> (of % 8)) == 0 {
                continue;
            }
            (first_page.saturating_add(of.saturating_mul(page_bytes)), page.min(count - of * page), at)
        };
        let bytes = last.read(file, address, records.saturating_mul(record))?;
        let at = (at * record) as usize;
        let bytes = bytes.get(at..at + record as usize).unwrap_or_default();
        found.extend(file.parse(bytes, FIELD, |cursor| index.parse_record(cursor, grid, place))?);
    }
    Ok(found)
}
