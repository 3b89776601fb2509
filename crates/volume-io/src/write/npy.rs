//! `NumPy` array writer (NPY): type, shape, and voxels. The format supports no other metadata.
//!
//! Format: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, version 1.

use std::io::{Result, Write};

use super::export_volume::ExportVolume;
use chiaroscuro_volume::VoxelType;

/// Alignment of the voxels in bytes, as required by the format.
const ALIGNMENT: usize = 64;

/// Bytes before the header text: magic bytes, version, and the text's length.
const PREAMBLE_BYTES: usize = 10;

/// Writes a volume as an array indexed by z, y, x.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>) -> Result<()> {
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
    // The text ends with a line feed.
    let length = (PREAMBLE_BYTES + text.len() + 1).next_multiple_of(ALIGNMENT) - PREAMBLE_BYTES;
    text.extend(std::iter::repeat_n(' ', length - 1 - text.len()));
    text.push('\n');
    out.write_all(b"\x93NUMPY\x01\x00")?;
    // Three numbers of twenty digits are far shorter than a 16-bit length allows.
    out.write_all(&(length as u16).to_le_bytes())?;
    out.write_all(text.as_bytes())?;
    volume.write_voxels(out)
}
