//! Fractal heap (section III.G): blocks that double in size from row to row of a table, addressed by one offset.

use super::super::{FieldCursor, Hdf5File};
use chiaroscuro_volume::LoadError;

const FIELD: &str = "fractal heap";

/// Maximum depth of tables within tables: their sizes double at least.
const MAX_DEPTH: usize = 64;

/// Heap of links or attributes.
#[derive(Debug)]
pub(crate) struct FractalHeap {
    /// Width of the offset and of the length in an object's place, in bytes.
    offset_bytes: usize,
    length_bytes: usize,
    table_width: u64,
    first_block: u64,
    max_direct: u64,
    root: Option<u64>,
    root_rows: u64,
}

impl FractalHeap {
    /// Reads the header of a heap.
    pub(crate) fn open(file: &Hdf5File<'_>, address: u64) -> Result<Self, LoadError> {
        let count = 22 + 12 * file.widths().length + 3 * file.widths().address;
        let bytes = file.read_block(address, count as u64, FIELD)?;
        file.parse(&bytes, FIELD, |cursor| {
            cursor.require_signature(*b"FRHP")?;
            cursor.take(3)?;
            if cursor.number(2)? != 0 {
                return Err("compressed heaps are not supported".into());
            }
            cursor.byte()?;
            let max_managed = cursor.number(4)?;
            // Huge objects, free space, and statistics.
            cursor.length()?;
            cursor.address()?;
            cursor.length()?;
            cursor.address()?;
            for _ in 0..8 {
                cursor.length()?;
            }
            let (table_width, first_block) = (cursor.number(2)?, cursor.length()?);
            let (max_direct, heap_bits) = (cursor.length()?, cursor.number(2)?);
            cursor.take(2)?;
            let (root, root_rows) = (cursor.address()?, cursor.number(2)?);
            let are_powers = [table_width, first_block, max_direct].iter().all(|size| size.is_power_of_two());
            if !are_powers || max_direct < first_block || max_direct > 1 << 32 || heap_bits > 64 {
                return Err("the sizes of its blocks are impossible".into());
            }
            let width = |most: u64| most.max(1).ilog2() as usize / 8 + 1;
            let offset_bytes = (heap_bits as usize).div_ceil(8);
            let length_bytes = (max_direct.ilog2() as usize).div_ceil(8).min(width(max_managed));
            Ok(Self { offset_bytes, length_bytes, table_width, first_block, max_direct, root, root_rows })
        })
    }

    /// Reads an object by its place; `None` for those that are too large to be in the heap.
    pub(crate) fn object(&self, file: &Hdf5File<'_>, place: &[u8]) -> Result<Option<Vec<u8>>, LoadError> {
        let (flags, offset, length) = file.parse(place, FIELD, |cursor| {
            let flags = cursor.byte()?;
            Ok(match flags >> 4 & 3 {
                0 => (flags, cursor.number(self.offset_bytes)?, cursor.number(self.length_bytes)?),
                _ => (flags, 0, 0),
            })
        })?;
        match flags >> 4 & 3 {
            0 => self.managed_object(file, offset, length).map(Some),
            2 => Ok(place.get(1..usize::from(flags & 0x0f) + 2).map(<[u8]>::to_vec)),
            _ => Ok(None),
        }
    }

    fn managed_object(&self, file: &Hdf5File<'_>, offset: u64, length: u64) -> Result<Vec<u8>, LoadError> {
        let missing = || file.broken(FIELD, "an object lies beyond the blocks of its heap");
        let mut block = self.root.ok_or_else(missing)?;
        let (mut rows, mut left) = (self.root_rows, offset);
        let row_bytes = self.first_block.saturating_mul(self.table_width);
        let direct_rows = u64::from(self.max_direct.ilog2() - self.first_block.ilog2()) + 2;
        for _ in 0..MAX_DEPTH {
            if rows == 0 {
                return file.read_block(block.saturating_add(left), length, FIELD);
            }
            // The first two rows have blocks of equal size, and each later one blocks that are twice as large.
            let doubled = left.checked_div(row_bytes).and_then(u64::checked_ilog2);
            let row = doubled.map_or(0, |doubled| u64::from(doubled) + 1);
            let size = self.first_block.checked_mul(1 << doubled.unwrap_or(0)).filter(|_| row < rows);
            let size = size.ok_or_else(missing)?;
            let begin = if row == 0 { 0 } else { size.saturating_mul(self.table_width) };
            let in_row = left.checked_sub(begin).ok_or_else(missing)?;
            let column = in_row / size;
            left = in_row % size;
            let width = file.widths().address as u64;
            let head = 5 + width + self.offset_bytes as u64;
            let entry = (row * self.table_width + column).saturating_mul(width).saturating_add(head);
            let bytes = file.read_block(block.saturating_add(entry), width, FIELD)?;
            block = file.parse(&bytes, FIELD, FieldCursor::present_address)?;
            // Larger blocks are tables again.
            rows = if row < direct_rows {
                0
            } else {
                u64::from(size.checked_div(row_bytes).and_then(u64::checked_ilog2).unwrap_or(0)) + 1
            };
        }
        Err(missing())
    }
}
