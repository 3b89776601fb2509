//! NRRD writer: a text header, followed by the voxels, uncompressed or in gzip.
//!
//! Format: <https://teem.sourceforge.net/nrrd/format.html>. World space is right-anterior-superior millimetres if the
//! orientation is anatomical, otherwise unnamed. Metadata of the values are stored in standard fields and key/value
//! pairs.

use std::fmt::Write as _;
use std::io::{Result, Write};

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::{DAffine3, DVec3};

use super::export_volume::ExportVolume;
use chiaroscuro_files::provenance_mark;
use chiaroscuro_volume::{ValueMeaning, ValueMetadata, VoxelType};

/// Contents of an NRRD header.
pub(super) struct NrrdFileHeader<'a> {
    /// Name of the volume.
    pub(super) content: &'a str,
    pub(super) voxel_type: VoxelType,
    pub(super) dims: [usize; 3],
    /// Transform from voxel indices to world space; `None` if it is unknown.
    pub(super) world_from_index: Option<DAffine3>,
    pub(super) is_anatomical: bool,
    /// True if lengths are in voxels.
    pub(super) has_unknown_scale: bool,
    pub(super) is_gzip: bool,
}

impl NrrdFileHeader<'_> {
    /// Returns the header's lines, without the empty line at its end.
    pub(super) fn text(&self) -> String {
        let number = match self.voxel_type {
            VoxelType::F32 => "float",
            VoxelType::F64 => "double",
            whole => whole.name(),
        };
        let [nx, ny, nz] = self.dims;
        let mut text = format!("NRRD0005\n# {}\n", provenance_mark());
        let mut add = |field: &str, value: &str| {
            if !value.is_empty() {
                text.push_str(field);
                text.push_str(": ");
                text.push_str(value);
                text.push('\n');
            }
        };
        add("content", self.content);
        add("type", number);
        add("dimension", "3");
        if self.is_anatomical {
            add("space", "right-anterior-superior");
        } else if self.world_from_index.is_some() {
            add("space dimension", "3");
        }
        add("sizes", &format!("{nx} {ny} {nz}"));
        if let Some(DAffine3 { matrix3, translation }) = self.world_from_index {
            let vector = |v: DVec3| format!("({},{},{})", v.x, v.y, v.z);
            let axes = [matrix3.x_axis, matrix3.y_axis, matrix3.z_axis].map(vector);
            add("space directions", &axes.join(" "));
            let unit = if self.has_unknown_scale { "\"voxel\"" } else { "\"mm\"" };
            add("space units", &[unit; 3].join(" "));
            add("space origin", &vector(translation));
        }
        add("kinds", "domain domain domain");
        if self.voxel_type.bytes() > 1 {
            add("endian", "little");
        }
        add("encoding", if self.is_gzip { "gzip" } else { "raw" });
        text
    }
}

/// Writes a volume as NRRD.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>, is_gzip: bool) -> Result<()> {
    let header = NrrdFileHeader {
        content: volume.name(),
        voxel_type: volume.voxel_type(),
        dims: volume.dims(),
        world_from_index: (!volume.has_unknown_geometry()).then_some(volume.world_from_index()),
        is_anatomical: volume.is_anatomical(),
        has_unknown_scale: volume.has_unknown_scale(),
        is_gzip,
    };
    out.write_all(header.text().as_bytes())?;
    out.write_all(value_metadata(volume.hints(), volume.unit()).as_bytes())?;
    out.write_all(b"\n")?;
    if !is_gzip {
        return volume.write_voxels(out);
    }
    let mut encoder = GzEncoder::new(out, Compression::default());
    volume.write_voxels(&mut encoder)?;
    encoder.finish().map(drop)
}

/// Returns the header's lines with metadata of the values.
fn value_metadata(hints: &ValueMetadata, unit: Option<&str>) -> String {
    let mut text = String::new();
    let mut add = |line: std::fmt::Arguments<'_>| {
        // Writing to a string cannot fail.
        text.write_fmt(line).ok();
        text.push('\n');
    };
    if let Some(unit) = unit {
        add(format_args!("sample units: \"{unit}\""));
    }
    if hints.is_rescaled {
        // Records that the values were rescaled; the original range is unknown.
        add(format_args!("old min: nan"));
    }
    if let Some(code) = hints.modality.code() {
        add(format_args!("modality:={code}"));
    }
    if let Some(padding) = hints.padding {
        add(format_args!("padding value:={padding}"));
    }
    if let Some([low, high]) = hints.window {
        add(format_args!("DICOM_0028_1050:={}", f64::midpoint(low, high)));
        add(format_args!("DICOM_0028_1051:={}", high - low));
    }
    if let Some(acquisition) = hints.acquisition() {
        add(format_args!("acquisition:={acquisition}"));
    }
    if hints.meaning == ValueMeaning::Labels {
        // Key by which 3D Slicer recognises segmentations.
        add(format_args!("Segmentation_ContainedRepresentationNames:=Binary labelmap|"));
    }
    for (at, (number, label)) in hints.labels.iter().enumerate() {
        add(format_args!("Segment{at}_ID:=Segment_{number}"));
        add(format_args!("Segment{at}_LabelValue:={number}"));
        add(format_args!("Segment{at}_Layer:=0"));
        add(format_args!("Segment{at}_Name:={}", label.name));
        if let Some([red, green, blue]) = label.color {
            add(format_args!("Segment{at}_Color:={red} {green} {blue}"));
        }
    }
    text
}
