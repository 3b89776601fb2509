//! Tests of RAW files and of format detection through the public interface: accepted and refused files.

mod cancelling;
mod choices;
pub(super) mod helpers;
mod portions;

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use tempfile::TempDir;

use self::helpers::gzip;
use super::*;
use crate::open;
use chiaroscuro_volume::{GridExtent, LoadErrorKind, Samples, VoxelType};

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn options(raw: RawFormat) -> LoadOptions {
    LoadOptions { raw, memory_budget_bytes: 1 << 20, ..LoadOptions::default() }
}

fn load_as(path: &Path, raw: RawFormat) -> Result<Volume, LoadError> {
    load(path, &options(raw), &LoadControl::new())
}

/// Kind and message of the error for a file that must be refused.
fn refusal(path: &Path, raw: RawFormat) -> (LoadErrorKind, String) {
    let error = load_as(path, raw).unwrap_err();
    (error.kind(), error.to_string())
}

#[track_caller]
fn assert_refused(path: &Path, raw: RawFormat, kind: LoadErrorKind, words: &[&str]) {
    let (found, message) = refusal(path, raw);
    assert_eq!(found, kind, "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

/// Runs a check with six voxels of every type, including negative and fractional ones where possible.
macro_rules! for_each_type {
    ($check:ident) => {
        $check!(u8, U8, [0, 1, 2, 127, 254, 255]);
        $check!(i8, I8, [-128, -1, 0, 1, 2, 127]);
        $check!(u16, U16, [0, 1, 258, 4096, 65534, 65535]);
        $check!(i16, I16, [-32768, -2, 0, 1, 258, 32767]);
        $check!(u32, U32, [0, 1, 66051, 7, 9, u32::MAX]);
        $check!(i32, I32, [i32::MIN, -2, 0, 1, 66051, i32::MAX]);
        $check!(f32, F32, [-1.5, 0.0, 0.25, 1e-30, 7.0, 1e30]);
        $check!(f64, F64, [-1.5, 0.0, 0.25, 1e-300, 7.0, 1e300]);
    };
}

#[test]
fn every_type_and_byte_order_is_read() {
    let folder = TempDir::new().unwrap();
    macro_rules! check {
        ($type:ty, $variant:ident, $values:expr) => {
            let values: [$type; 6] = $values;
            let samples = Samples::$variant(values.to_vec());
            let name = format!("v_3x2x1_{}.raw", VoxelType::$variant.name());
            let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            let path = write(&folder, &name, &little);
            assert_eq!(*load_as(&path, RawFormat::default()).unwrap().samples(), samples);
            let path = write(&folder, &format!("{name}.gz"), &gzip(&little));
            assert_eq!(*load_as(&path, RawFormat::default()).unwrap().samples(), samples);
            let path = write(&folder, &name, &big);
            let format = RawFormat { endian: Some(Endian::Big), ..Default::default() };
            assert_eq!(*load_as(&path, format).unwrap().samples(), samples);
        };
    }
    for_each_type!(check);
}

#[test]
fn names_and_options_describe_the_volume() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "skull_2x3x1_uint8.raw", &[1, 2, 3, 4, 5, 6]);
    let volume = load_as(&path, RawFormat::default()).unwrap();
    assert_eq!((volume.name(), volume.dims(), volume.spacing_mm()), ("skull", [2, 3, 1], DVec3::ONE));
    assert_eq!(volume.value(1, 2, 0), 6.0);
    assert!(volume.has_unknown_scale(), "nobody has said how long a voxel is");

    let everything = RawFormat {
        dims: Some([1, 1, 2]),
        voxel_type: Some(VoxelType::U16),
        spacing_mm: Some([0.5, 1.0, 3.0]),
        endian: Some(Endian::Big),
        offset: Some(2),
    };
    let volume = load_as(&path, everything).unwrap();
    assert_eq!(*volume.samples(), Samples::U16(vec![0x0304, 0x0506]));
    assert_eq!(volume.spacing_mm(), DVec3::new(0.5, 1.0, 3.0));
    assert!(!volume.has_unknown_scale());

    let dims_and_type =
        RawFormat { dims: Some([3, 2, 1]), voxel_type: Some(VoxelType::I8), ..Default::default() };
    let path = write(&folder, "anything.bin", &[0, 1, 2, 3, 4, 255]);
    assert_eq!(load_as(&path, dims_and_type).unwrap().value_range(), (-1.0, 4.0).into());
    assert_refused(
        &path,
        RawFormat { voxel_type: None, ..dims_and_type },
        LoadErrorKind::BadInput,
        &["--type"],
    );
    assert_refused(&path, RawFormat::default(), LoadErrorKind::BadInput, &["NRRD", "RAW", "--dims"]);
    let path = write(&folder, "plain.raw", &[0, 1]);
    assert_refused(&path, RawFormat::default(), LoadErrorKind::BadInput, &["file name", "--dims"]);
}

#[test]
fn gzip_is_recognised_by_its_content() {
    let folder = TempDir::new().unwrap();
    let voxels: Vec<u8> = (0..64).collect();
    let zipped_without_ending = write(&folder, "a_4x4x4_uint8.raw", &gzip(&voxels));
    let plain_with_ending = write(&folder, "b_4x4x4_uint8.raw.gz", &voxels);
    for path in [zipped_without_ending, plain_with_ending] {
        assert_eq!(*load_as(&path, RawFormat::default()).unwrap().samples(), Samples::U8(voxels.clone()));
    }
    // Voxels that look like gzip's magic.
    let path = write(&folder, "c_4x1x1_uint8.raw", &[0x1f, 0x8b, 8, 0]);
    assert_eq!(load_as(&path, RawFormat::default()).unwrap().value(1, 0, 0), 139.0);
    // Bytes after a complete stream are no part of it.
    let padded = [gzip(&voxels), vec![0; 4096]].concat();
    let path = write(&folder, "p_4x4x4_uint8.raw.gz", &padded);
    assert_eq!(*load_as(&path, RawFormat::default()).unwrap().samples(), Samples::U8(voxels.clone()));
    // The offset counts inflated bytes; several members are one stream.
    let mut members = gzip(&[9, 9, 1]);
    members.extend(gzip(&[2, 3, 4]));
    let path = write(&folder, "d_4x1x1_uint8.raw.gz", &members);
    let format = RawFormat { offset: Some(2), ..Default::default() };
    assert_eq!(*load_as(&path, format).unwrap().samples(), Samples::U8(vec![1, 2, 3, 4]));
}

#[test]
fn wrong_lengths_are_refused() {
    let folder = TempDir::new().unwrap();
    let name = RawFormat::default();
    let path = write(&folder, "a_4x4x4_uint8.raw", &[1; 63]);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["64 bytes", "63", "a_4x4x4_uint8.raw, file size"]);
    let path = write(&folder, "b_4x4x4_uint8.raw", &[1; 76]);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["76", "--offset 12"]);
    let path = write(&folder, "c_4x4x4_uint8.raw", &[1; 128]);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["--type uint16"]);
    let offset = RawFormat { offset: Some(u64::MAX), ..Default::default() };
    assert_refused(&path, offset, LoadErrorKind::BadInput, &["offset"]);
    let path = write(&folder, "d_4x4x4_uint8.raw", &[]);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["64 bytes"]);

    let zipped = gzip(&(0..64).collect::<Vec<u8>>());
    let path = write(&folder, "e_4x4x4_uint8.raw.gz", &zipped[..zipped.len() / 2]);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["truncated"]);
    let path = write(&folder, "f_4x4x5_uint8.raw.gz", &zipped);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["truncated", "80 bytes", "64 found"]);
    let path = write(&folder, "g_4x4x3_uint8.raw.gz", &zipped);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["more data than the 48 bytes"]);
    let mut broken = zipped.clone();
    let checksum = broken.len() - 8;
    broken[checksum] ^= 1;
    let path = write(&folder, "h_4x4x4_uint8.raw.gz", &broken);
    assert_refused(&path, name, LoadErrorKind::BadInput, &["broken"]);
    // A decompression bomb is inflated no further than the size that the name gives.
    let path = write(&folder, "i_4x4x4_uint8.raw.gz", &gzip(&vec![0; 50 << 20]));
    assert_refused(&path, name, LoadErrorKind::BadInput, &["more data"]);
}

#[test]
fn sizes_over_the_budget_are_refused_before_allocation() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "a_1000000x1000000x1000000_uint8.raw.gz", &gzip(&[1]));
    assert_refused(&path, RawFormat::default(), LoadErrorKind::Limit, &["888.2 PiB", "1.0 MiB", "file name"]);
    let path = write(&folder, "a_99999999999999999999999x9x9_uint8.raw", &[1]);
    assert_refused(&path, RawFormat::default(), LoadErrorKind::Limit, &["1.0 MiB"]);
    let huge =
        RawFormat { dims: Some([usize::MAX; 3]), voxel_type: Some(VoxelType::F64), ..Default::default() };
    assert_refused(&path, huge, LoadErrorKind::Limit, &["--dims"]);
}

#[test]
fn unusable_options_are_refused() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "a_1x1x1_uint8.raw", &[1]);
    let dims = RawFormat { dims: Some([1, 0, 1]), ..Default::default() };
    assert_refused(&path, dims, LoadErrorKind::BadInput, &["--dims", "at least 1"]);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let spacing = RawFormat { spacing_mm: Some([1.0, wrong, 1.0]), ..Default::default() };
        assert_refused(&path, spacing, LoadErrorKind::BadInput, &["--spacing"]);
    }
    let path = write(&folder, "a_1x0x1_uint8.raw", &[]);
    assert_refused(&path, RawFormat::default(), LoadErrorKind::BadInput, &["file name"]);
    let path = write(&folder, "a_1x1x1_float32.raw", &f32::NAN.to_le_bytes());
    assert_refused(&path, RawFormat::default(), LoadErrorKind::BadInput, &["finite"]);
}

#[test]
fn what_is_not_a_readable_file_is_refused() {
    let folder = TempDir::new().unwrap();
    let missing = folder.path().join("missing.nrrd");
    assert_refused(&missing, RawFormat::default(), LoadErrorKind::Io, &["no such file", "missing.nrrd"]);
    assert_refused(
        folder.path(),
        RawFormat::default(),
        LoadErrorKind::BadInput,
        &["folder", "open a single file"],
    );
    assert_refused(Path::new(""), RawFormat::default(), LoadErrorKind::Io, &[]);
    #[cfg(unix)]
    {
        let format = RawFormat { dims: Some([1; 3]), voxel_type: Some(VoxelType::U8), ..Default::default() };
        assert_refused(Path::new("/dev/zero"), format, LoadErrorKind::Io, &["not a regular file"]);
        let socket = folder.path().join("s.raw");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        assert_refused(&socket, format, LoadErrorKind::Io, &["not a regular file"]);
    }
}

#[test]
fn loading_can_be_watched_and_cancelled() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "a_4x4x4_uint16.raw", &[1; 128]);
    let control = LoadControl::new();
    assert_eq!(control.fraction(), None);
    load(&path, &options(RawFormat::default()), &control).unwrap();
    assert_eq!(control.fraction(), Some(1.0));
    control.cancel();
    for source in [path.to_str().unwrap(), "builtin:sphere:8"] {
        let error = open(source, &options(RawFormat::default()), &control).unwrap_err();
        assert_eq!(error.kind(), LoadErrorKind::Cancelled);
    }
}

/// Endless reader of zeros, which cancels during its first block.
struct CancellingReader<'a>(&'a LoadControl);

impl std::io::Read for CancellingReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.0.cancel();
        buffer.fill(0);
        Ok(buffer.len())
    }
}

#[test]
fn cancelling_stops_within_a_block() {
    let control = LoadControl::new();
    let extent = GridExtent::unchecked([64 << 20, 1, 1], VoxelType::U8);
    let layout =
        super::reading::samples::VoxelLayout { extent, voxel_type: VoxelType::U8, endian: Endian::Little };
    let stopped = super::reading::samples::read_binary(&mut CancellingReader(&control), &layout, &control);
    assert!(matches!(stopped, Err(super::reading::samples::ReadFault::Stopped(LoadError::Cancelled))));
    assert!(control.done_bytes.load(std::sync::atomic::Ordering::Relaxed) <= 4 << 20);
}

#[test]
fn built_in_volumes_are_opened_by_name() {
    let control = LoadControl::new();
    let open = |source: &str| open(source, &options(RawFormat::default()), &control);
    assert_eq!(open("builtin:box:16").unwrap().dims(), [16; 3]);
    for (source, kind, word) in [
        ("builtin:table", LoadErrorKind::BadInput, "marschner-lobb"),
        ("builtin:", LoadErrorKind::BadInput, "chair"),
        ("builtin:box:", LoadErrorKind::BadInput, "builtin:chair:128"),
        ("builtin:box:-8", LoadErrorKind::BadInput, "\"-8\""),
        ("builtin:box:7", LoadErrorKind::BadInput, "8"),
        ("builtin:box:1025", LoadErrorKind::BadInput, "1024"),
        ("builtin:box:128", LoadErrorKind::Limit, "1.0 MiB"),
    ] {
        let error = open(source).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
}
