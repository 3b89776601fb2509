//! Extensible arrays of chunks (section VII.D): records in blocks that double in size, found through further blocks.

use std::ops::Range;

use super::super::super::container::{FieldCursor, Hdf5File};
use super::arrays::LastBlock;
use super::{ChunkGrid, ChunkIndex, FIELD, StoredChunk};
use chiaroscuro_volume::LoadError;

/// Header of an extensible array.
#[derive(Debug, Clone, Copy)]
struct ArrayHeader {
    /// Bytes of a record.
    record: u64,
    /// Records in the index block.
    in_index: u64,
    /// Records in the smallest block, and pointers of the smallest block of pointers.
    smallest: u64,
    pointers: u64,
    /// Records of a page of a large block.
    page: u64,
    /// Width of offsets in blocks.
    offset_width: u64,
    /// Width of addresses.
    width: u64,
    index_block: u64,
}

/// Place of a record: a block with so many records, and the number of the record in it.
struct RecordPlace {
    block: u64,
    records: u64,
    at: u64,
}

/// Returns the chunks of an extensible array that lie in a box.
pub(super) fn chunks(
    file: &Hdf5File<'_>,
    address: u64,
    index: &ChunkIndex,
    grid: &ChunkGrid<'_>,
    range: &[Range<u64>],
) -> Result<Vec<StoredChunk>, LoadError> {
    let Some((header, count)) = ArrayHeader::read(file, address, index.record_bytes(file, grid))? else {
        return Ok(Vec::new());
    };
    let mut blocks = [LastBlock::default(), LastBlock::default()];
    let mut found = Vec::new();
    for place in ChunkGrid::places(range) {
        let number = grid.number(&place);
        if number >= count {
            continue;
        }
        let [pointers, records] = &mut blocks;
        let Some(record) = header.locate(file, pointers, number)? else { continue };
        let bytes = records.read(file, record.block, record.records.saturating_mul(header.record))?;
        let at = (record.at * header.record) as usize;
        let bytes = bytes.get(at..at + header.record as usize).unwrap_or_default();
        found.extend(file.parse(bytes, FIELD, |cursor| index.parse_record(cursor, grid, place))?);
    }
    Ok(found)
}

impl ArrayHeader {
    /// Reads the header; returns it with the number of records in use, or `None` where nothing was written.
    fn read(file: &Hdf5File<'_>, address: u64, record: usize) -> Result<Option<(Self, u64)>, LoadError> {
        let width = file.widths().address as u64;
        let head = file.read_block(address, 12 + 6 * file.widths().length as u64 + width, FIELD)?;
        file.parse(&head, FIELD, |cursor| {
            cursor.require_signature(*b"EAHD")?;
            cursor.take(2)?;
            let found = usize::from(cursor.byte()?);
            if found != record {
                return Err(format!("records of {record} bytes were expected, they have {found}").into());
            }
            let bits = cursor.byte()?;
            let [in_index, smallest, pointers] =
                [cursor.byte()?, cursor.byte()?, cursor.byte()?].map(u64::from);
            let page_bits = cursor.byte()?;
            if !smallest.is_power_of_two() || !pointers.is_power_of_two() || page_bits > 32 || bits > 64 {
                return Err("the sizes of its blocks are impossible".into());
            }
            for _ in 0..4 {
                cursor.length()?;
            }
            let count = cursor.length()?;
            cursor.length()?;
            let (page, record) = (1 << page_bits, record as u64);
            let offset_width = u64::from(bits).div_ceil(8);
            let index_block = cursor.address()?;
            let header = |index_block| Self {
                record,
                in_index,
                smallest,
                pointers,
                page,
                offset_width,
                width,
                index_block,
            };
            Ok(index_block.map(|index_block| (header(index_block), count)))
        })
    }

    /// Finds the record of a chunk by its number; `None` where its block was never written.
    fn locate(
        &self,
        file: &Hdf5File<'_>,
        blocks: &mut LastBlock,
        number: u64,
    ) -> Result<Option<RecordPlace>, LoadError> {
        // After signature, version, kind, and the address of the header.
        let start = self.index_block.saturating_add(6 + self.width);
        let Some(number) = number.checked_sub(self.in_index) else {
            return Ok(Some(RecordPlace { block: start, records: self.in_index, at: number }));
        };
        // Super block n has 2^n times the records of the smallest block, in 2^(n/2) blocks.
        let group = (number / self.smallest + 1).ilog2();
        let in_group = number - ((1 << group) - 1) * self.smallest;
        let blocks_in_group = 1u64 << (group / 2);
        let records = (1u64 << group.div_ceil(2)).saturating_mul(self.smallest);
        let (of, at) = (in_group / records, in_group % records);
        let pointer_start = start.saturating_add(self.in_index * self.record);
        let direct_groups = 2 * self.pointers.ilog2();
        let direct_blocks = 2 * (self.pointers - 1);
        let address_at = |at: u64| {
            let bytes = file.read_block(at, self.width, FIELD)?;
            file.parse(&bytes, FIELD, FieldCursor::address)
        };
        let pages = if records > self.page { records / self.page } else { 0 };
        let block = if group < direct_groups {
            // Blocks before this group: 1, 2, 4, 6, 10, 14 and so on.
            let before: u64 = (0..group).map(|group| 1u64 << (group / 2)).sum();
            address_at(pointer_start.saturating_add((before + of) * self.width))?
        } else {
            let pointer = direct_blocks + u64::from(group - direct_groups);
            let pointer = pointer_start.saturating_add(pointer.saturating_mul(self.width));
            let Some(group_block) = address_at(pointer)? else {
                return Ok(None);
            };
            let bits = pages.div_ceil(8);
            let head = 6 + self.width + self.offset_width;
            let length = head.saturating_add(blocks_in_group.saturating_mul(bits + self.width));
            let bytes = blocks.read(file, group_block, length)?;
            if pages > 0 {
                // One bit for each page, in whole bytes for each block.
                let page = at / self.page;
                let byte = bytes
                    .get(head.saturating_add(of.saturating_mul(bits)).saturating_add(page / 8) as usize)
                    .copied()
                    .unwrap_or(0);
                if byte & (0x80 >> (page % 8)) == 0 {
                    return Ok(None);
                }
            }
            let pointers = head.saturating_add(blocks_in_group.saturating_mul(bits));
            let bytes =
                bytes.get(pointers.saturating_add(of * self.width) as usize..).unwrap_or_default().to_vec();
            file.parse(&bytes, FIELD, FieldCursor::address)?
        };
        let Some(block) = block else { return Ok(None) };
        let first = block.saturating_add(6 + self.width + self.offset_width);
        if pages == 0 {
            return Ok(Some(RecordPlace { block: first, records, at }));
        }
        // Before the pages of a block lies a checksum, and after each one.
        let page_bytes = self.page.saturating_mul(self.record).saturating_add(4);
        let block = first.saturating_add(4).saturating_add((at / self.page).saturating_mul(page_bytes));
        Ok(Some(RecordPlace { block, records: self.page, at: at % self.page }))
    }
}
