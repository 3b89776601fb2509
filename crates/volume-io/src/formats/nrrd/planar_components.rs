//! Planar components: each component is a whole volume behind the previous one, as some programs write vectors and
//! colours.

use std::io::Read;

use super::super::LoadControl;
use super::super::number::VoxelEncoding;
use super::super::samples::{ReadFault, read_until_full};

/// Number of voxels interleaved at a time, about 64 KiB.
const BLOCK_VOXELS: usize = 1 << 14;

/// Reads planar components into interleaved order, as [`VoxelEncoding`] expects them.
///
/// # Errors
/// `ReadFault::Short` if the data end early, `ReadFault::NoMemory` if they do not fit in memory.
pub(super) fn read_interleaved(
    data: &mut impl Read,
    stored: &VoxelEncoding,
    voxels: usize,
    control: &LoadControl,
) -> Result<Vec<u8>, ReadFault> {
    let (size, voxel) = (stored.number.bytes(), stored.voxel_bytes() as usize);
    let length = voxels.checked_mul(voxel).ok_or(ReadFault::NoMemory)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length).map_err(|_none| ReadFault::NoMemory)?;
    bytes.resize(length, 0);
    let mut block = vec![0; BLOCK_VOXELS * size];
    let mut bytes_read = 0;
    for plane in 0..stored.components {
        for some in bytes.chunks_mut(BLOCK_VOXELS * voxel) {
            let numbers = &mut block[..some.len() / voxel * size];
            let got = read_until_full(data, numbers, control)?;
            bytes_read += got as u64;
            if got < numbers.len() {
                return Err(ReadFault::Short { got: bytes_read });
            }
            for (number, into) in numbers.chunks_exact(size).zip(some.chunks_exact_mut(voxel)) {
                into[plane * size..][..size].copy_from_slice(number);
            }
        }
    }
    Ok(bytes)
}
