//! Heaps of a file: names in local ones, lists of any length in global ones, links and attributes in fractal ones.

mod fractal;

use super::Hdf5File;
use chiaroscuro_volume::LoadError;
pub(super) use fractal::FractalHeap;

/// Heap with the names of an old group's members (section III.D).
#[derive(Debug)]
pub(super) struct LocalHeap {
    pub(super) bytes: Vec<u8>,
}

impl LocalHeap {
    /// Reads the heap at an address.
    pub(super) fn open(file: &Hdf5File<'_>, address: u64) -> Result<Self, LoadError> {
        const FIELD: &str = "local heap";
        let count = 8 + 2 * file.widths().length + file.widths().address;
        let head = file.read_block(address, count as u64, FIELD)?;
        let (length, at) = file.parse(&head, FIELD, |cursor| {
            cursor.require_signature(*b"HEAP")?;
            cursor.take(4)?;
            let length = cursor.length()?;
            cursor.length()?;
            Ok((length, cursor.present_address()?))
        })?;
        Ok(Self { bytes: file.read_block(at, length, FIELD)? })
    }
}

/// Reads an object of a global heap by its index (section III.E).
pub(super) fn global_object(file: &Hdf5File<'_>, address: u64, index: u64) -> Result<Vec<u8>, LoadError> {
    const FIELD: &str = "global heap";
    let width = file.widths().length;
    let head = file.read_block(address, 8 + width as u64, FIELD)?;
    let length = file.parse(&head, FIELD, |cursor| {
        cursor.require_signature(*b"GCOL")?;
        cursor.take(4)?;
        cursor.length()
    })?;
    let rest = length.saturating_sub(head.len() as u64);
    let bytes = file.read_block(address.saturating_add(head.len() as u64), rest, FIELD)?;
    file.parse(&bytes, FIELD, |cursor| {
        while cursor.rest().len() >= 8 + width {
            let number = cursor.number(2)?;
            cursor.take(6)?;
            let size = cursor.length()?;
            // The object of number 0 is the free space at the end.
            if number == 0 {
                break;
            }
            if number == index {
                return Ok(cursor.take_stored(size)?.to_vec());
            }
            cursor.take_stored(size.checked_next_multiple_of(8).unwrap_or(u64::MAX))?;
        }
        Err("an object is missing in it".into())
    })
}
