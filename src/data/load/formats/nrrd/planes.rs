//! Planar components: each component is a whole volume behind the previous one, as some programs write vectors and
//! colours.

use std::io::Read;

use super::super::LoadControl;
use super::super::number::Stored;
use super::super::samples::{Fault, fill};

/// Number of voxels interleaved at a time, about 64 KiB.
const VOXELS: usize = 1 << 14;

/// Reads planar components into interleaved order, as [`Stored`] expects them.
///
/// # Errors
/// `Fault::Short` if the data end early, `Fault::NoMemory` if they do not fit in memory.
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
