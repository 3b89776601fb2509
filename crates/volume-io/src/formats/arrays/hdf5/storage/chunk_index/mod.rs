//! Indexes of an array's chunks (sections III.A and VII): where each is stored.

mod arrays;
mod extensible;
mod trees;

use std::ops::Range;

use super::super::container::{FieldCursor, Hdf5File, ParseResult};
use chiaroscuro_volume::LoadError;

pub(super) const FIELD: &str = "chunk index";

/// Chunk that is stored in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StoredChunk {
    /// Position in the grid of chunks, slowest dimension first.
    pub(crate) place: Vec<u64>,
    pub(crate) address: u64,
    /// Bytes in the file; `None` where they are those of a chunk without filters.
    pub(crate) bytes: Option<u64>,
    /// Filters that were left out for this chunk, one bit each.
    pub(crate) skipped_filters: u32,
}

/// Grid of an array's chunks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkGrid<'a> {
    /// Shape of the array.
    pub(crate) array: &'a [u64],
    /// Lengths to which its dimensions may grow; `None` without a limit.
    pub(crate) limits: &'a [Option<u64>],
    /// Shape of a chunk, none of its lengths 0.
    pub(crate) chunk: &'a [u64],
    /// Bytes of a chunk without filters.
    pub(crate) chunk_bytes: u64,
}

impl ChunkGrid<'_> {
    /// Number of a chunk in an array that grows along one dimension at most, which counts as the slowest.
    fn number(&self, place: &[u64]) -> u64 {
        let growing = self.limits.iter().position(Option::is_none);
        let others = (0..place.len()).filter(|&axis| growing != Some(axis));
        growing.into_iter().chain(others).fold(0, |number: u64, axis| {
            let count = self.limits[axis].map_or(0, |limit| limit.div_ceil(self.chunk[axis]));
            number.saturating_mul(count).saturating_add(place[axis])
        })
    }

    /// Places of the chunks in a box of the grid, in order.
    pub(crate) fn places(range: &[Range<u64>]) -> impl Iterator<Item = Vec<u64>> {
        let first = range.iter().map(|range| range.start).collect::<Vec<u64>>();
        let is_empty = range.iter().any(Range::is_empty);
        std::iter::successors((!is_empty).then_some(first), move |place| {
            let mut next = place.clone();
            for (at, range) in range.iter().enumerate().rev() {
                next[at] += 1;
                if next[at] < range.end {
                    return Some(next);
                }
                next[at] = range.start;
            }
            None
        })
    }
}

/// Kind of an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum IndexKind {
    /// Tree of version 1, by the offsets of chunks.
    OldTree,
    /// One chunk: its bytes and the filters that were left out, where there are filters.
    Single(Option<(u64, u32)>),
    /// All chunks one after another.
    Implicit,
    /// Array with an element for each chunk.
    FixedArray,
    /// Array that grows along one dimension.
    ExtensibleArray,
    /// Tree of version 2, for several dimensions that grow.
    Tree,
}

/// Index of an array's chunks.
#[derive(Debug, Clone)]
pub(crate) struct ChunkIndex {
    kind: IndexKind,
    /// Address of the index, or of the chunks; `None` where nothing was written.
    address: Option<u64>,
    /// True if chunks at the far ends of the array pass no filters.
    are_ends_plain: bool,
    /// Width of the numbers of bytes in records of version 5 of layouts; `None` where it follows from the chunk.
    size_width: Option<usize>,
    /// True if chunks pass filters.
    pub(super) are_filtered: bool,
}

impl ChunkIndex {
    /// Creates the index of layouts before version 4.
    pub(super) fn old_tree(address: Option<u64>) -> Self {
        let (are_ends_plain, are_filtered) = (false, false);
        Self { kind: IndexKind::OldTree, address, are_ends_plain, size_width: None, are_filtered }
    }

    /// Parses the rest of a layout of version 4 or 5, after the shape of chunks.
    pub(super) fn parse(cursor: &mut FieldCursor<'_>, version: u8, flags: u8) -> ParseResult<Self> {
        let kind = match cursor.byte()? {
            1 if flags & 2 != 0 => IndexKind::Single(Some((cursor.length()?, cursor.number(4)? as u32))),
            1 => IndexKind::Single(None),
            2 => IndexKind::Implicit,
            3 => {
                cursor.take(1)?;
                IndexKind::FixedArray
            }
            4 => {
                cursor.take(5)?;
                IndexKind::ExtensibleArray
            }
            5 => {
                cursor.take(6)?;
                IndexKind::Tree
            }
            other => return Err(format!("index {other} of chunks is unknown").into()),
        };
        let size_width = (version > 4).then_some(8);
        let (address, are_ends_plain) = (cursor.address()?, flags & 1 != 0);
        Ok(Self { kind, address, are_ends_plain, size_width, are_filtered: false })
    }

    /// Returns the chunks that are stored in a box of the grid of chunks.
    pub(super) fn chunks_in(
        &self,
        file: &Hdf5File<'_>,
        grid: &ChunkGrid<'_>,
        range: &[Range<u64>],
    ) -> Result<Vec<StoredChunk>, LoadError> {
        let Some(address) = self.address else { return Ok(Vec::new()) };
        let mut found = match self.kind {
            IndexKind::OldTree => trees::old_chunks(file, address, grid, range)?,
            IndexKind::Tree => trees::chunks(file, address, self, grid, range)?,
            IndexKind::FixedArray => arrays::chunks(file, address, self, grid, range)?,
            IndexKind::ExtensibleArray => extensible::chunks(file, address, self, grid, range)?,
            IndexKind::Single(stored) => {
                let (bytes, skipped_filters) = stored.unzip();
                let place = vec![0; range.len()];
                vec![StoredChunk { place, address, bytes, skipped_filters: skipped_filters.unwrap_or(0) }]
            }
            IndexKind::Implicit => {
                let held = range
                    .iter()
                    .fold(grid.chunk_bytes, |bytes, range| bytes.saturating_mul(range.end - range.start));
                if held > file.length() {
                    return Err(file
                        .broken(FIELD, format!("the file is truncated: it has no {held} bytes of chunks")));
                }
                let chunk = |place: Vec<u64>| {
                    let before = grid.number(&place).saturating_mul(grid.chunk_bytes);
                    let address = address.saturating_add(before);
                    StoredChunk { place, address, bytes: None, skipped_filters: 0 }
                };
                ChunkGrid::places(range).map(chunk).collect()
            }
        };
        found.retain(|chunk| chunk.place.iter().zip(range).all(|(place, range)| range.contains(place)));
        if self.are_ends_plain {
            for chunk in &mut found {
                let ends = chunk.place.iter().zip(grid.chunk).zip(grid.array);
                let is_end = |((place, chunk), array): ((&u64, &u64), &u64)| {
                    (place + 1).saturating_mul(*chunk) > *array
                };
                if ends.into_iter().any(is_end) {
                    (chunk.bytes, chunk.skipped_filters) = (None, u32::MAX);
                }
            }
        }
        Ok(found)
    }

    /// Width of the numbers of bytes in records of chunks that pass filters.
    fn size_width(&self, grid: &ChunkGrid<'_>) -> usize {
        let width = 1 + (grid.chunk_bytes.max(1).ilog2() as usize + 8) / 8;
        self.size_width.unwrap_or(width.min(8))
    }

    /// Bytes of a record without its place.
    fn record_bytes(&self, file: &Hdf5File<'_>, grid: &ChunkGrid<'_>) -> usize {
        let filtered = if self.are_filtered { self.size_width(grid) + 4 } else { 0 };
        file.widths().address + filtered
    }

    /// Parses a record: address, and bytes and filters where chunks pass filters. `None` where nothing was written.
    fn parse_record(
        &self,
        cursor: &mut FieldCursor<'_>,
        grid: &ChunkGrid<'_>,
        place: Vec<u64>,
    ) -> ParseResult<Option<StoredChunk>> {
        let address = cursor.address()?;
        let (mut bytes, mut skipped_filters) = (None, 0);
        if self.are_filtered {
            bytes = Some(cursor.number(self.size_width(grid))?);
            skipped_filters = cursor.number(4)? as u32;
        }
        Ok(address.map(|address| StoredChunk { place, address, bytes, skipped_filters }))
    }
}
