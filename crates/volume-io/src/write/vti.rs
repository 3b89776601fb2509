//! VTK image data writer (VTI): an XML header with point data, followed by the uncompressed voxels.
//!
//! Format: *VTK File Formats* (<https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>). World space is
//! that of the volume: the format cannot express anatomical directions.

use std::io::{Result, Write};

use glam::DVec3;

use super::export_volume::ExportVolume;
use chiaroscuro_files::provenance_mark;
use chiaroscuro_volume::VoxelType;

/// Text before and after the comment with the program mark.
const COMMENT: [&str; 2] = ["<?xml version=\"1.0\"?>\n<!-- ", " -->\n"];

/// Writes a volume as VTK image data.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>) -> Result<()> {
    let [before, after] = COMMENT;
    let kind = match volume.voxel_type() {
        VoxelType::U8 => "UInt8",
        VoxelType::I8 => "Int8",
        VoxelType::U16 => "UInt16",
        VoxelType::I16 => "Int16",
        VoxelType::U32 => "UInt32",
        VoxelType::I32 => "Int32",
        VoxelType::F32 => "Float32",
        VoxelType::F64 => "Float64",
    };
    let [x, y, z] = volume.dims().map(|n| n - 1);
    let extent = format!("0 {x} 0 {y} 0 {z}");
    let name = escape_xml(volume.name());
    let head = format!(
        "{before}{}{after}<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<ImageData WholeExtent=\"{extent}\"{}>\n<Piece Extent=\"{extent}\">\n\
         <PointData Scalars=\"{name}\">\n\
         <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"1\" format=\"appended\" offset=\"0\"/>\n\
         </PointData>\n<CellData/>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_",
        provenance_mark(),
        geometry_attributes(volume),
    );
    out.write_all(head.as_bytes())?;
    out.write_all(&volume.bytes().to_le_bytes())?;
    volume.write_voxels(out)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// Returns the attributes for position, spacing and orientation; empty if they are unknown.
fn geometry_attributes(volume: &ExportVolume<'_>) -> String {
    if volume.has_unknown_geometry() {
        return String::new();
    }
    let words = |v: DVec3| format!("{} {} {}", v.x, v.y, v.z);
    let world = volume.world_from_index();
    let spacing = DVec3::from(volume.spacing_mm());
    let axes = world.matrix3;
    let directions = [axes.x_axis / spacing.x, axes.y_axis / spacing.y, axes.z_axis / spacing.z];
    // Row by row, without the sign of a negative zero.
    let rows = [0, 1, 2].map(|row| words(DVec3::from(directions.map(|axis| axis[row] + 0.0))));
    format!(
        " Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\"",
        words(world.translation + DVec3::ZERO),
        words(spacing),
        rows.join(" ")
    )
}

/// Escapes text for an XML attribute.
fn escape_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
