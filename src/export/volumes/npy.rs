//! NumPy's array: its type and shape, and the voxels. There is no place in it for anything else.
//!
//! After <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, version 1.

use std::io::{Result, Write};

use super::outgoing::Outgoing;
use crate::data::VoxelType;

/// Voxels begin at a multiple of so many bytes, as the definition asks.
const ALIGNMENT: usize = 64;

/// Bytes before the text: the mark, the version, and the length of the text.
const BEFORE: usize = 10;

/// Writes a volume, as an array of z, y, x.
pub(super) fn write(out: &mut dyn Write, volume: &Outgoing<'_>) -> Result<()> {
    let kind = match volume.voxel_type() {
        VoxelType::U8 => "|u1",
        VoxelType::I8 => "|i1",
        VoxelType::U16 => "<u2",
        VoxelType::I16 => "<i2",
        VoxelType::U32 => "<u4",
        VoxelType::I32 => "<i4",
        VoxelType::F32 => "<f4",
        VoxelType::F64 => "<f8",
    };
    let [nx, ny, nz] = volume.dims();
    let mut text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({nz}, {ny}, {nx}), }}");
    // A line feed ends it.
    let length = (BEFORE + text.len() + 1).next_multiple_of(ALIGNMENT) - BEFORE;
    text.extend(std::iter::repeat_n(' ', length - 1 - text.len()));
    text.push('\n');
    out.write_all(b"\x93NUMPY\x01\x00")?;
    // Three numbers of twenty digits have not as much as 16 bits count.
    out.write_all(&(length as u16).to_le_bytes())?;
    out.write_all(text.as_bytes())?;
    volume.write_voxels(out)
}
