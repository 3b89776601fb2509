//! Round-trip tests of exported volumes: every format, number type and orientation; and conversions that are
//! rejected.

mod numbers;
mod round_trips;

use std::path::PathBuf;

use glam::{DAffine3, DMat3, DVec3};

use super::*;
use crate::{LoadOptions, load};
use chiaroscuro_volume::{LoadControl, Modality, Samples, ValueMeaning, ValueMetadata};

/// Dimensions of the test volumes: all different, so that no axis can be mistaken for another.
const DIMS: [usize; 3] = [5, 4, 3];

/// Exported file in a temporary folder.
struct ExportedFile {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

/// Writes a volume in a format to a temporary folder.
fn export_to_temporary_file(
    format: VolumeFormat,
    volume: &ExportVolume<'_>,
    is_compressed: bool,
) -> ExportedFile {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan").with_extension(format.extensions()[0]);
    write_volume(&path, format, volume, is_compressed).unwrap();
    ExportedFile { _folder: folder, path }
}

/// Reads a file that was exported.
fn read_back(written: &ExportedFile) -> Volume {
    load(&written.path, &LoadOptions::default(), &LoadControl::new()).unwrap()
}

/// Returns samples of a number type, including its lowest and highest number.
fn samples(voxel_type: VoxelType) -> Samples {
    let count = DIMS.iter().product::<usize>();
    // Values without a pattern that a permutation of axes would preserve.
    let mixed = |at: usize| (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 16;
    macro_rules! whole {
        ($variant:ident, $number:ty) => {{
            let mut values: Vec<$number> = (0..count).map(|at| mixed(at) as $number).collect();
            (values[1], values[count - 2]) = (<$number>::MIN, <$number>::MAX);
            Samples::$variant(values)
        }};
    }
    let real = |at: usize| (mixed(at) % 100_003) as f64 / 7.0 - 5000.0;
    match voxel_type {
        VoxelType::U8 => whole!(U8, u8),
        VoxelType::I8 => whole!(I8, i8),
        VoxelType::U16 => whole!(U16, u16),
        VoxelType::I16 => whole!(I16, i16),
        VoxelType::U32 => whole!(U32, u32),
        VoxelType::I32 => whole!(I32, i32),
        VoxelType::F32 => {
            let mut values: Vec<f32> = (0..count).map(|at| real(at) as f32).collect();
            (values[2], values[3], values[4]) = (f32::NAN, -0.0, f32::MIN_POSITIVE / 8.0);
            Samples::F32(values)
        }
        VoxelType::F64 => {
            let mut values: Vec<f64> = (0..count).map(real).collect();
            (values[2], values[3], values[4]) = (f64::NAN, -0.0, f64::from_bits(3));
            Samples::F64(values)
        }
    }
}

/// Returns the affine of an oblique, mirrored grid far from the origin.
fn oblique_affine() -> DAffine3 {
    let turn = DMat3::from_axis_angle(DVec3::new(0.3, -0.9, 0.4).normalize(), 0.7);
    let matrix3 = turn * DMat3::from_diagonal(DVec3::new(0.488_281_25, 0.7, -2.5));
    DAffine3 { matrix3, translation: DVec3::new(-123.456, 78.9, 1012.3) }
}

fn volume(samples: Samples, world_from_index: DAffine3) -> Volume {
    Volume::new("scan", DIMS, world_from_index, samples).unwrap()
}

/// Returns the bytes of all voxels in order, little-endian.
fn bytes(volume: &Volume) -> Vec<u8> {
    let mut bytes = Vec::new();
    ExportVolume::new(volume).write_voxels(&mut bytes).unwrap();
    bytes
}

/// Describes the first difference of two volumes: in grid, number type, voxels, or geometry beyond a relative
/// tolerance.
fn difference(found: &Volume, wanted: &Volume, tolerance: f64) -> Option<String> {
    let kind = |volume: &Volume| volume.samples().voxel_type().name();
    if (found.dims(), kind(found)) != (wanted.dims(), kind(wanted)) {
        return Some(format!("{:?} {} for {:?} {}", found.dims(), kind(found), wanted.dims(), kind(wanted)));
    }
    let (a, b) = (bytes(found), bytes(wanted));
    if let Some(at) = (0..a.len()).find(|&at| a[at] != b[at]) {
        return Some(format!("byte {at}: {} for {}", a[at], b[at]));
    }
    let numbers = |volume: &Volume| volume.world_from_index().to_cols_array();
    let (a, b) = (numbers(found), numbers(wanted));
    // Relative to the longest component of the axis or origin.
    let length =
        |at: usize| b[at / 3 * 3..at / 3 * 3 + 3].iter().fold(1.0f64, |most, part| most.max(part.abs()));
    let far = (0..12).find(|&at| (a[at] - b[at]).abs() > tolerance * length(at))?;
    Some(format!("affine {far}: {} for {}", a[far], b[far]))
}

#[test]
fn blocks_are_read_back_in_their_place() {
    let volume = chiaroscuro_volume::synthetic::builtin("box", Some(16)).unwrap();
    let values: Vec<f32> = (0..512).map(|i| i as f32 / 512.0).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("light.nrrd");
    std::fs::write(&path, nrrd_of_blocks(&volume, "light attenuation", [8; 3], 2, &values)).unwrap();
    let back = load(&path, &LoadOptions::default(), &LoadControl::new()).unwrap();
    assert_eq!(back.dims(), [8; 3]);
    assert_eq!(back.spacing_mm(), volume.spacing_mm() * 2.0);
    assert!((back.value(1, 0, 0) - 1.0 / 512.0).abs() < 1e-9);
    // The bounding box around the voxels' outer faces is unchanged.
    let corner = |volume: &Volume| volume.world_from_index().transform_point3(glam::DVec3::splat(-0.5));
    assert!((corner(&back) - corner(&volume)).length() < 1e-9);
}
