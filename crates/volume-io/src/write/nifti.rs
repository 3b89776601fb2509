//! `NIfTI` writer: a binary header, an extension with the program mark, and the voxels, uncompressed or in gzip.
//!
//! Format: `nifti1.h` and `nifti2.h` (<https://nifti.nimh.nih.gov>): NIfTI-1, or NIfTI-2 if an axis has more voxels
//! than 16 bits can count. World space is right-anterior-superior millimetres; without an anatomical orientation,
//! only distances are written.

use std::io::{Result, Write};

use flate2::Compression;
use flate2::write::GzEncoder;
use glam::{DMat3, DQuat, DVec3};

use super::export_volume::ExportVolume;
use chiaroscuro_files::provenance_mark;
use chiaroscuro_volume::{Modality, ValueMeaning, VoxelType};

/// Extension code of plain text (`NIFTI_ECODE_COMMENT`).
const COMMENT_CODE: u32 = 6;

/// Sizes of the NIfTI-1 and NIfTI-2 headers in bytes, which are also their first field.
const NIFTI_1_HEADER_BYTES: usize = 348;
const NIFTI_2_HEADER_BYTES: usize = 540;

/// Bytes between a header and its first extension; the first byte is non-zero if there is one.
const EXTENDER_BYTES: usize = 4;

/// Bytes before the text of an extension: its size and its code.
const EXTENSION_HEADER_BYTES: usize = 8;

/// Unit code of millimetres (`NIFTI_UNITS_MM`).
const UNITS_MM: u8 = 2;

/// Transform code of scanner coordinates (`NIFTI_XFORM_SCANNER_ANAT`).
const XFORM_SCANNER: u8 = 1;

/// Intent code of label maps (`NIFTI_INTENT_LABEL`).
const INTENT_LABEL: i16 = 1002;

/// Largest cosine between axes at which a quaternion is written beside the matrix, for programs that read nothing
/// else: a shear of a thousandth amounts to half a voxel after five hundred.
const MAX_SHEAR_COSINE: f64 = 1e-3;

/// Maximum length of the description in bytes, without the terminating zero.
const MAX_DESCRIPTION_BYTES: usize = 79;

/// Writes a volume as `NIfTI`.
pub(super) fn write(out: &mut dyn Write, volume: &ExportVolume<'_>, is_gzip: bool) -> Result<()> {
    if !is_gzip {
        out.write_all(&header_and_extension(volume))?;
        return volume.write_voxels(out);
    }
    let mut encoder = GzEncoder::new(out, Compression::default());
    encoder.write_all(&header_and_extension(volume))?;
    volume.write_voxels(&mut encoder)?;
    encoder.finish().map(drop)
}

/// Returns everything that precedes the voxels.
fn header_and_extension(volume: &ExportVolume<'_>) -> Vec<u8> {
    let comment = mark_extension();
    let is_long = volume.dims().iter().any(|&n| i16::try_from(n).is_err());
    let header = if is_long { NIFTI_2_HEADER_BYTES } else { NIFTI_1_HEADER_BYTES };
    // NIfTI-1 requires voxels to begin at a multiple of 16; sizes of extensions are multiples of 16 too.
    let start = (header + EXTENDER_BYTES + comment.len()).next_multiple_of(16);
    let mut bytes = if is_long { nifti2_header(volume, start) } else { nifti1_header(volume, start) };
    bytes.extend([1, 0, 0, 0]);
    bytes.extend(comment);
    bytes.resize(start, 0);
    bytes
}

/// Returns the extension with the program mark.
fn mark_extension() -> Vec<u8> {
    let text = provenance_mark();
    let length = (EXTENSION_HEADER_BYTES + text.len()).next_multiple_of(16);
    let mut bytes = (length as u32).to_le_bytes().to_vec();
    bytes.extend(COMMENT_CODE.to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.resize(length, 0);
    bytes
}

/// Contents common to both headers, which store them in different widths.
struct NiftiExportHeader {
    /// Code of the voxel type.
    kind: i16,
    bits: i16,
    /// True if the volume has an anatomical orientation.
    is_anatomical: bool,
    /// True if its axes are nearly orthogonal, so that a quaternion describes the orientation as well.
    is_orthogonal: bool,
    /// Determinant sign (`qfac`): -1 for a mirrored grid, otherwise 1.
    qfac: f64,
    spacing: [f64; 3],
    quaternion: [f64; 3],
    /// Rows of the affine matrix.
    rows: [[f64; 4]; 3],
    units: u8,
    intent: i16,
    window: [f64; 2],
    description: Vec<u8>,
}

impl NiftiExportHeader {
    fn from_volume(volume: &ExportVolume<'_>) -> Self {
        let world = volume.world_from_index();
        let axes = world.matrix3;
        let directions = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize);
        let [x, y, z] = directions;
        let across = x.cross(y).normalize();
        let mirror = if across.dot(z) < 0.0 { -1.0 } else { 1.0 };
        let is_square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|cosine| cosine.abs() < MAX_SHEAR_COSINE);
        let turn = DQuat::from_mat3(&DMat3::from_cols(x, across.cross(x), across));
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let is_placed = volume.is_anatomical();
        let of_unknown_size = volume.has_unknown_scale();
        let row = |at: usize| {
            [axes.x_axis[at], axes.y_axis[at], axes.z_axis[at], world.translation[at]].map(|n| n + 0.0)
        };
        let [kind, bits] = type_code(volume.voxel_type());
        Self {
            kind,
            bits,
            is_anatomical: is_placed,
            is_orthogonal: is_square,
            qfac: if is_placed { mirror } else { 1.0 },
            spacing: volume.spacing_mm(),
            quaternion: [turn.x, turn.y, turn.z],
            rows: [row(0), row(1), row(2)],
            units: if of_unknown_size { 0 } else { UNITS_MM },
            intent: if volume.hints().meaning == ValueMeaning::Labels { INTENT_LABEL } else { 0 },
            window: volume.hints().window.unwrap_or_default(),
            description: description(volume),
        }
    }

    fn turn_code(&self) -> u8 {
        if self.is_anatomical && self.is_orthogonal { XFORM_SCANNER } else { 0 }
    }

    fn matrix_code(&self) -> u8 {
        if self.is_anatomical { XFORM_SCANNER } else { 0 }
    }
}

/// Returns the format's code of a voxel type, and its number of bits.
fn type_code(voxel_type: VoxelType) -> [i16; 2] {
    match voxel_type {
        VoxelType::U8 => [2, 8],
        VoxelType::I8 => [256, 8],
        VoxelType::U16 => [512, 16],
        VoxelType::I16 => [4, 16],
        VoxelType::U32 => [768, 32],
        VoxelType::I32 => [8, 32],
        VoxelType::F32 => [16, 32],
        VoxelType::F64 => [64, 64],
    }
}

/// Returns the description of the acquisition, including the modality, truncated to the field's length.
fn description(volume: &ExportVolume<'_>) -> Vec<u8> {
    let hints = volume.hints();
    let acquisition = hints.acquisition().unwrap_or_default();
    let word = match hints.modality {
        Modality::Ct => "CT",
        Modality::Mr => "MR",
        Modality::Pet => "PET",
        Modality::Nuclear => "SPECT",
        _ => "",
    };
    let is_said = word.is_empty() || Modality::from_description(acquisition) == hints.modality;
    let text = match (is_said, acquisition) {
        (true, said) => said.to_owned(),
        (false, "") => word.to_owned(),
        (false, said) => format!("{word}, {said}"),
    };
    text.as_bytes()[..text.floor_char_boundary(MAX_DESCRIPTION_BYTES)].to_vec()
}

/// Header buffer with fields at fixed offsets.
struct HeaderBuffer(Vec<u8>);

impl HeaderBuffer {
    fn put(&mut self, at: usize, bytes: impl AsRef<[u8]>) {
        let bytes = bytes.as_ref();
        self.0[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn put_f32s(&mut self, at: usize, numbers: &[f64]) {
        let bytes: Vec<u8> = numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
        self.put(at, bytes);
    }

    fn put_f64s(&mut self, at: usize, numbers: &[f64]) {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.put(at, bytes);
    }
}

/// Returns the NIfTI-1 header; `start` is the offset of the voxels.
fn nifti1_header(volume: &ExportVolume<'_>, start: usize) -> Vec<u8> {
    let facts = NiftiExportHeader::from_volume(volume);
    let [x, y, z] = facts.spacing;
    let mut header = HeaderBuffer(vec![0; NIFTI_1_HEADER_BYTES]);
    header.put(0, (NIFTI_1_HEADER_BYTES as i32).to_le_bytes());
    header.put(38, b"r");
    let [nx, ny, nz] = volume.dims().map(|n| n as i16);
    header.put(40, [3, nx, ny, nz, 1, 1, 1, 1].map(i16::to_le_bytes).concat());
    header.put(68, facts.intent.to_le_bytes());
    header.put(70, facts.kind.to_le_bytes());
    header.put(72, facts.bits.to_le_bytes());
    header.put_f32s(76, &[facts.qfac, x, y, z]);
    header.put_f32s(108, &[start as f64, 1.0, 0.0]);
    header.put(123, [facts.units]);
    let [low, high] = facts.window;
    header.put_f32s(124, &[high, low]);
    header.put(148, &facts.description);
    header.put(252, i16::from(facts.turn_code()).to_le_bytes());
    header.put(254, i16::from(facts.matrix_code()).to_le_bytes());
    if facts.is_anatomical {
        let origin = facts.rows.map(|row| row[3]);
        header.put_f32s(256, &[facts.quaternion, origin].concat());
        header.put_f32s(280, &facts.rows.concat());
    }
    header.put(344, b"n+1\0");
    header.0
}

/// Returns the NIfTI-2 header; `start` is the offset of the voxels.
fn nifti2_header(volume: &ExportVolume<'_>, start: usize) -> Vec<u8> {
    let facts = NiftiExportHeader::from_volume(volume);
    let [x, y, z] = facts.spacing;
    let mut header = HeaderBuffer(vec![0; NIFTI_2_HEADER_BYTES]);
    header.put(0, (NIFTI_2_HEADER_BYTES as i32).to_le_bytes());
    header.put(4, b"n+2\0\r\n\x1a\n");
    header.put(12, facts.kind.to_le_bytes());
    header.put(14, facts.bits.to_le_bytes());
    let [nx, ny, nz] = volume.dims().map(|n| n as i64);
    header.put(16, [3, nx, ny, nz, 1, 1, 1, 1].map(i64::to_le_bytes).concat());
    header.put_f64s(104, &[facts.qfac, x, y, z]);
    header.put(168, (start as i64).to_le_bytes());
    header.put_f64s(176, &[1.0, 0.0]);
    let [low, high] = facts.window;
    header.put_f64s(192, &[high, low]);
    header.put(240, &facts.description);
    header.put(344, i32::from(facts.turn_code()).to_le_bytes());
    header.put(348, i32::from(facts.matrix_code()).to_le_bytes());
    if facts.is_anatomical {
        let origin = facts.rows.map(|row| row[3]);
        header.put_f64s(352, &[facts.quaternion, origin].concat());
        header.put_f64s(400, &facts.rows.concat());
    }
    header.put(500, i32::from(facts.units).to_le_bytes());
    header.put(504, i32::from(facts.intent).to_le_bytes());
    header.0
}
