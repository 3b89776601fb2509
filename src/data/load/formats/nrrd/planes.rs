//! Components that lie behind each other, a whole volume of each, as some programs write vectors and colours.

use std::io::Read;

use super::super::LoadControl;
use super::super::number::Stored;
use super::super::samples::{Fault, fill};

/// Voxels that are moved at a time: some 64 KiB.
const VOXELS: usize = 1 << 14;

/// The numbers of each of so many voxels beside each other, as [`Stored`] reads them.
///
/// # Errors
/// Where the data end too early, or there is no memory for all of them.
pub(super) fn side_by_side(
    data: &mut impl Read,
    stored: &Stored,
    voxels: usize,
    control: &LoadControl,
) -> Result<Vec<u8>, Fault> {
    let (size, voxel) = (stored.number.bytes(), stored.bytes_of_voxel() as usize);
    let length = voxels.checked_mul(voxel).ok_or(Fault::NoMemory)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length).map_err(|_none| Fault::NoMemory)?;
    bytes.resize(length, 0);
    let mut block = vec![0; VOXELS * size];
    let mut passed = 0;
    for plane in 0..stored.components {
        for some in bytes.chunks_mut(VOXELS * voxel) {
            let numbers = &mut block[..some.len() / voxel * size];
            let got = fill(data, numbers, control)?;
            passed += got as u64;
            if got < numbers.len() {
                return Err(Fault::Short { got: passed });
            }
            for (number, into) in numbers.chunks_exact(size).zip(some.chunks_exact_mut(voxel)) {
                into[plane * size..][..size].copy_from_slice(number);
            }
        }
    }
    Ok(bytes)
}
