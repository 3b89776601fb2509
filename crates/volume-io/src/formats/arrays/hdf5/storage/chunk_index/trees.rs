//! Trees of chunks, sorted by their offsets: those of version 1 (section III.A.1), and of version 2.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::ops::Range;

use super::super::super::container::{FieldCursor, Hdf5File, ParseResult, RecordTree};
use super::{ChunkGrid, ChunkIndex, FIELD, StoredChunk};
use chiaroscuro_volume::LoadError;

/// Maximum number of chunks that are found at a time.
const MAX_CHUNKS: usize = 1 << 22;

/// Key of a node of a tree of version 1.
struct ChunkKey {
    bytes: u64,
    skipped_filters: u32,
    place: Vec<u64>,
}

/// Parses a key: bytes, filters, and offsets in elements, of which the last is that of bytes in an element.
fn parse_key(cursor: &mut FieldCursor<'_>, chunk: &[u64]) -> ParseResult<ChunkKey> {
    let (bytes, skipped_filters) = (cursor.number(4)?, cursor.number(4)? as u32);
    let place = chunk.iter().map(|&n| Ok(cursor.number(8)? / n)).collect::<ParseResult<Vec<u64>>>()?;
    cursor.take(8)?;
    Ok(ChunkKey { bytes, skipped_filters, place })
}

/// Order of a place relative to a box, in the order of the file.
fn place_order(place: &[u64], range: &[Range<u64>]) -> Ordering {
    let first = range.iter().map(|range| range.start);
    let last = range.iter().map(|range| range.end.saturating_sub(1));
    if place.iter().copied().lt(first) {
        Ordering::Less
    } else if place.iter().copied().gt(last) {
        Ordering::Greater
    } else {
        Ordering::Equal
    }
}

/// Returns the chunks of a tree of version 1 that lie between the corners of a box, in the order of the file.
pub(super) fn old_chunks(
    file: &Hdf5File<'_>,
    root: u64,
    grid: &ChunkGrid<'_>,
    range: &[Range<u64>],
) -> Result<Vec<StoredChunk>, LoadError> {
    let width = file.widths().address;
    let key_bytes = 8 * (grid.chunk.len() + 2);
    let (mut found, mut visited) = (Vec::new(), BTreeSet::new());
    let mut waiting = vec![(root, u8::MAX)];
    while let Some((node, level)) = waiting.pop() {
        if !visited.insert(node) {
            return Err(file.broken(FIELD, "the tree of chunks refers to itself"));
        }
        let head = file.read_block(node, 8, FIELD)?;
        let (depth, children) = file.parse(&head, FIELD, |cursor| {
            cursor.require_signature(*b"TREE")?;
            let (kind, depth) = (cursor.byte()?, cursor.byte()?);
            if kind != 1 || depth >= level {
                return Err("a node of a tree has another kind or level than its parent states".into());
            }
            Ok((depth, cursor.number(2)? as usize))
        })?;
        let start = node.saturating_add(8 + 2 * width as u64);
        let bytes = file.read_block(start, (children * (key_bytes + width) + key_bytes) as u64, FIELD)?;
        let (keys, below) = file.parse(&bytes, FIELD, |cursor| {
            let (mut keys, mut below) = (vec![parse_key(cursor, grid.chunk)?], Vec::new());
            for _ in 0..children {
                below.push(cursor.present_address()?);
                keys.push(parse_key(cursor, grid.chunk)?);
            }
            Ok((keys, below))
        })?;
        for (at, address) in below.into_iter().enumerate() {
            let ChunkKey { bytes, skipped_filters, place } = &keys[at];
            let order = place_order(place, range);
            if depth == 0 {
                if order.is_eq() && found.len() < MAX_CHUNKS {
                    let (bytes, skipped_filters) = (Some(*bytes), *skipped_filters);
                    found.push(StoredChunk { place: place.clone(), address, bytes, skipped_filters });
                }
            } else if !order.is_gt() && !place_order(&keys[at + 1].place, range).is_lt() {
                waiting.push((address, depth));
            }
        }
    }
    Ok(found)
}

/// Returns the chunks of a tree of version 2 that lie between the corners of a box, in the order of the file.
pub(super) fn chunks(
    file: &Hdf5File<'_>,
    root: u64,
    index: &ChunkIndex,
    grid: &ChunkGrid<'_>,
    range: &[Range<u64>],
) -> Result<Vec<StoredChunk>, LoadError> {
    let tree = RecordTree::open(file, root)?;
    let head = index.record_bytes(file, grid);
    let expected = head + 8 * grid.chunk.len();
    if tree.record_bytes != expected || tree.kind != if index.are_filtered { 11 } else { 10 } {
        let why = format!("records of {expected} bytes were expected, they have {}", tree.record_bytes);
        return Err(file.broken(FIELD, why));
    }
    let place_of = |record: &[u8]| -> Vec<u64> {
        let numbers = record[head..].chunks_exact(8);
        numbers.map(|bytes| bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte))).collect()
    };
    let records = tree.records(file, MAX_CHUNKS, &|record| place_order(&place_of(record), range))?;
    let mut found = Vec::new();
    for record in records {
        let place = place_of(&record);
        found.extend(file.parse(&record, FIELD, |cursor| index.parse_record(cursor, grid, place))?);
    }
    Ok(found)
}
