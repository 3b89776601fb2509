//! `MetaImage` writer: a text header, followed by the voxels, uncompressed or in zlib.
//!
//! Format: <https://itk.org/Wiki/MetaIO/Documentation>. World space is left-posterior-superior millimetres. Metadata
//! without a field in the format are named by their DICOM tags, as programs based on ITK do.

use std::io::{Result, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::{DAffine3, DMat3, DVec3};

use super::export_volume::ExportVolume;
use chiaroscuro_files::{provenance_mark, sanitised_line};
use chiaroscuro_volume::VoxelType;

/// Field with the name of the writing program: the tag of DICOM's Software Versions.
const MADE_BY_FIELD: &str = "0018|1020";

/// Length of the longest value that `MetaIO` reads, in characters.
const MAX_VALUE_CHARS: usize = 200;

/// Writer that only counts bytes.
struct ByteCounter(u64);

impl Write for ByteCounter {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Writes a volume as `MetaImage`.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>, is_compressed: bool) -> Result<()> {
    let size = if is_compressed {
        // The compressed size precedes the voxels; compressing twice avoids keeping them in memory.
        let mut count = ByteCounter(0);
        write_compressed(&mut count, volume)?;
        Some(count.0)
    } else {
        None
    };
    out.write_all(header(volume, size).as_bytes())?;
    if is_compressed { write_compressed(out, volume) } else { volume.write_voxels(out) }
}

fn write_compressed(out: &mut dyn Write, volume: &ExportVolume<'_>) -> Result<()> {
    let mut encoder = ZlibEncoder::new(out, Compression::default());
    volume.write_voxels(&mut encoder)?;
    encoder.finish().map(drop)
}

/// Returns the header; `compressed` is the size of the compressed voxels in bytes.
fn header(volume: &ExportVolume<'_>, compressed: Option<u64>) -> String {
    let mut text = String::new();
    let mut add = |field: &str, value: &str| {
        if !value.is_empty() {
            text.extend([field, " = ", &sanitised_line(value, MAX_VALUE_CHARS), "\n"]);
        }
    };
    add("ObjectType", "Image");
    add("NDims", "3");
    add(MADE_BY_FIELD, &provenance_mark());
    add("Name", volume.name());
    let hints = volume.hints();
    add("0008|0060", hints.modality.code().unwrap_or_default());
    add("0008|103e", hints.acquisition().unwrap_or_default());
    add("0028|1054", volume.unit().unwrap_or_default());
    if let Some(padding) = hints.padding {
        add("0028|0120", &padding.to_string());
    }
    if let Some([low, high]) = hints.window {
        add("0028|1050", &f64::midpoint(low, high).to_string());
        add("0028|1051", &(high - low).to_string());
    }
    add("BinaryData", "True");
    add("BinaryDataByteOrderMSB", "False");
    add("CompressedData", if compressed.is_some() { "True" } else { "False" });
    if let Some(size) = compressed {
        add("CompressedDataSize", &size.to_string());
    }
    if !volume.has_unknown_geometry() {
        add_geometry(&mut add, volume);
    }
    add("DimSize", &join_words(&volume.dims().map(|n| n.to_string())));
    add("ElementType", element_type(volume.voxel_type()));
    add("ElementDataFile", "LOCAL");
    text
}

/// Adds the fields for the position and orientation of the voxels. Unknown properties get the values that `MetaIO`
/// defines for that.
fn add_geometry(add: &mut impl FnMut(&str, &str), volume: &ExportVolume<'_>) {
    let lps_from_ras = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0)));
    let DAffine3 { matrix3, translation } = lps_from_ras * volume.world_from_index();
    let directions = [matrix3.x_axis, matrix3.y_axis, matrix3.z_axis]
        .map(|axis| join_words(&(axis / axis.length()).to_array().map(plus_zero)));
    add("TransformMatrix", &directions.join(" "));
    add("Offset", &join_words(&translation.to_array().map(plus_zero)));
    add("CenterOfRotation", "0 0 0");
    if !volume.is_anatomical() {
        add("AnatomicalOrientation", "???");
    }
    add("ElementSpacing", &join_words(&volume.spacing_mm().map(|length| length.to_string())));
    add("DistanceUnits", if volume.has_unknown_scale() { "?" } else { "mm" });
}

fn join_words(all: &[String; 3]) -> String {
    all.join(" ")
}

/// Formats a number, without the sign of a negative zero.
fn plus_zero(number: f64) -> String {
    (number + 0.0).to_string()
}

/// Returns the format's name of a voxel type.
fn element_type(voxel_type: VoxelType) -> &'static str {
    match voxel_type {
        VoxelType::U8 => "MET_UCHAR",
        VoxelType::I8 => "MET_CHAR",
        VoxelType::U16 => "MET_USHORT",
        VoxelType::I16 => "MET_SHORT",
        VoxelType::U32 => "MET_UINT",
        VoxelType::I32 => "MET_INT",
        VoxelType::F32 => "MET_FLOAT",
        VoxelType::F64 => "MET_DOUBLE",
    }
}
