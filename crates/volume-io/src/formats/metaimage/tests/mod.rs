//! Tests of `MetaImage` files, end to end: accepted and refused files.

mod files;
mod geometry;

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use crate::tests::helpers::{assert_refused, gzip, load_path, zlib};
use chiaroscuro_volume::{LoadError, LoadErrorKind, Modality, Samples, ValueMeaning, Volume, VolumeChoice};

/// Header of 2 x 2 x 2 bytes, without its last field.
const HEADER: &str = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n";
/// Voxels of the volume that `HEADER` describes.
const VOXELS: [u8; 8] = [1, 2, 3, 4, 5, 6, 7, 8];
/// Last field, for data behind the header.
const LOCAL: &str = "ElementDataFile = LOCAL\n";

/// Returns the header with other fields in place of those with the same name.
fn header_with(fields: &[&str]) -> String {
    let name = |line: &str| line.split('=').next().unwrap_or_default().to_owned();
    let replaced: Vec<_> = fields.iter().map(|line| name(line)).collect();
    let kept = HEADER.lines().filter(|line| !replaced.contains(&name(line)));
    kept.chain(fields.iter().copied()).fold(String::new(), |header, line| header + line + "\n")
}

fn write(folder: &TempDir, name: &str, header: &str, data: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, [header.as_bytes(), data].concat()).unwrap();
    path
}

/// Loads a single file: a header with these fields, and data behind it.
fn load_local(fields: &[&str], data: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    let folder = TempDir::new().unwrap();
    load_path(&write(&folder, "v.mha", &(header_with(fields) + LOCAL), data), choice)
}

fn read(fields: &[&str], data: &[u8]) -> Volume {
    load_local(fields, data, VolumeChoice::default()).unwrap()
}

#[test]
fn every_type_is_read_in_both_byte_orders_and_all_encodings() {
    macro_rules! check {
        ($type:ty, [$($name:literal),*], $values:expr, $samples:expr) => {
            let values: [$type; 3] = $values;
            let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            let text = values.map(|value| value.to_string()).join(" \r\n");
            for name in [$($name),*] {
                let of_type = format!("ElementType = MET_{name}");
                for (more, data) in [
                    (&["ElementByteOrderMSB = False"][..], &little),
                    (&["BinaryDataByteOrderMSB = True"], &big),
                    (&["ElementByteOrderMSB = True", "CompressedData = True"], &zlib(&big)),
                    (&["CompressedData = True", "CompressedDataSize = 7"], &zlib(&little)),
                    (&["CompressedData = 1"], &gzip(&little)),
                    (&["BinaryData = False", "ElementByteOrderMSB = True"], &text.clone().into_bytes()),
                ] {
                    let fields = [&["DimSize = 3 1 1", &of_type], more].concat();
                    assert_eq!(*read(&fields, data).samples(), $samples, "{fields:?}");
                }
            }
        };
    }
    check!(u8, ["UCHAR", "UCHAR_ARRAY"], [0, 7, 255], Samples::U8(vec![0, 7, 255]));
    check!(i8, ["CHAR", "ASCII_CHAR"], [-128, 7, 127], Samples::I8(vec![-128, 7, 127]));
    check!(i16, ["SHORT", "SHORT_ARRAY"], [-32768, 258, 7], Samples::I16(vec![-32768, 258, 7]));
    check!(u16, ["USHORT"], [0, 258, 65535], Samples::U16(vec![0, 258, 65535]));
    check!(i32, ["INT", "LONG"], [i32::MIN, 258, 7], Samples::I32(vec![i32::MIN, 258, 7]));
    check!(u32, ["UINT", "ULONG"], [0, 258, u32::MAX], Samples::U32(vec![0, 258, u32::MAX]));
    check!(i64, ["LONG_LONG"], [-5, 258, 7], Samples::I32(vec![-5, 258, 7]));
    check!(u64, ["ULONG_LONG"], [5, 1 << 40, 7], Samples::F64(vec![5.0, (1u64 << 40) as f64, 7.0]));
    check!(f32, ["FLOAT"], [-1.5, 0.25, 1e30], Samples::F32(vec![-1.5, 0.25, 1e30]));
    check!(f64, ["DOUBLE", "DOUBLE_ARRAY"], [-1.5, 0.25, 1e300], Samples::F64(vec![-1.5, 0.25, 1e300]));
}

#[test]
fn headers_are_told_by_their_content_and_read_with_tolerance() {
    let folder = TempDir::new().unwrap();
    let header = "Comment = a chest, CT\r\nNDims=3\r\nNonsense\r\n\r\ndimsize : 2 2 2\r\nName = a \u{1b}tooth\r\n\
                  ElementType = MET_UCHAR\r\nElementDataFile = LOCAL\r\n";
    let volume = load_path(&write(&folder, "no_ending", header, &VOXELS), VolumeChoice::default()).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()));
    assert_eq!(volume.name(), "a ·tooth");
    assert_eq!(volume.metadata().acquisition(), Some("a chest, CT"));
    assert_eq!(volume.metadata().modality, Modality::Ct);
    assert_eq!(read(&[], &VOXELS).name(), "v");
}

#[test]
fn what_values_mean_is_told() {
    for (field, modality) in [
        ("Modality = MET_MOD_CT", Modality::Ct),
        ("Modality = MET_MOD_MR", Modality::Mr),
        ("Modality = MET_MOD_NM", Modality::Nuclear),
        ("Modality = MET_MOD_US", Modality::Ultrasound),
        ("Modality = MET_MOD_OTHER", Modality::Unknown),
        ("0008|0060 = PT", Modality::Pet),
    ] {
        assert_eq!(read(&[field], &VOXELS).metadata().modality, modality, "{field}");
    }
    let stored =
        ["0028|0120 = 3", "0028|1052 = -1", "0028|1053 = 2", "0028|1050 = 40\\80", "0028|1051 = 400\\20"];
    let hints = read(&stored, &VOXELS).metadata().clone();
    assert_eq!((hints.padding, hints.window), (Some(5.0), Some([-160.0, 240.0])));
    let scaled = ["ElementToIntensityFunctionSlope = 0.5", "ElementToIntensityFunctionOffset = -1"];
    let expected = VOXELS.map(|value| f32::from(value) * 0.5 - 1.0).to_vec();
    assert_eq!(*read(&scaled, &VOXELS).samples(), Samples::F32(expected));
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "seg.mha", &(header_with(&[]) + LOCAL), &VOXELS);
    write(&folder, "seg.ctab", "1 Bone 255 0 0 0\n", &[]);
    let volume = load_path(&path, VolumeChoice::default()).unwrap();
    assert_eq!(volume.metadata().meaning, ValueMeaning::Labels);
    assert!(volume.metadata().labels.get(1).is_some_and(|label| label.name == "Bone"));
}

#[test]
fn channels_and_time_steps_are_chosen() {
    let component = |component| VolumeChoice { component: Some(component), ..VolumeChoice::default() };
    let vector = ["DimSize = 2 1 1", "ElementNumberOfChannels = 2", "ElementType = MET_SHORT_ARRAY"];
    let data = [3u8, 0, 4, 0, 0, 0, 2, 0];
    let volume = read(&vector, &data);
    assert_eq!(*volume.samples(), Samples::F32(vec![5.0, 2.0]));
    assert!(volume.remarks().iter().any(|remark| remark.contains("magnitude")));
    assert_eq!(*load_local(&vector, &data, component(1)).unwrap().samples(), Samples::I16(vec![4, 2]));
    assert_refused(
        load_local(&vector, &data, component(2)),
        LoadErrorKind::BadInput,
        &["--component", "0 to 1"],
    );
    let text = [&vector[..], &["BinaryData = False"]].concat();
    assert_eq!(*read(&text, b"3 4 0 2").samples(), Samples::F32(vec![5.0, 2.0]));
    for channels in [3, 4] {
        let color = ["DimSize = 1 1 1", &format!("ElementNumberOfChannels = {channels}")];
        assert_eq!(*read(&color, &[0, 255, 0, 9][..channels]).samples(), Samples::U8(vec![182]));
    }

    let frame = |frame| VolumeChoice { frame: Some(frame), ..VolumeChoice::default() };
    let series = ["NDims = 4", "DimSize = 2 1 1 3", "ElementSpacing = 1 1 1 1"];
    let zipped = [&series[..], &["CompressedData = True"]].concat();
    let text = [&series[..], &["BinaryData = False"]].concat();
    let data = [1u8, 2, 3, 4, 5, 6];
    for (fields, data) in
        [(&series[..], data.to_vec()), (&zipped, zlib(&data)), (&text, b"1 2 3 4 5 6".to_vec())]
    {
        for (at, values) in [[1, 2], [3, 4], [5, 6]].iter().enumerate() {
            let volume = load_local(fields, &data, frame(at)).unwrap();
            assert_eq!(*volume.samples(), Samples::U8(values.to_vec()));
        }
        let unsaid = load_local(fields, &data, VolumeChoice::default());
        assert_refused(unsaid, LoadErrorKind::BadInput, &["3 time steps", "--frame"]);
        assert_refused(load_local(fields, &data, frame(3)), LoadErrorKind::BadInput, &["--frame"]);
    }
}

#[test]
fn missing_and_wrong_fields_are_named() {
    for field in ["NDims", "DimSize", "ElementType"] {
        let header = HEADER.lines().filter(|line| !line.starts_with(field));
        let header = header.fold(String::new(), |header, line| header + line + "\n") + LOCAL;
        let folder = TempDir::new().unwrap();
        let path = write(&folder, "v.mha", &header, &VOXELS);
        assert_refused(
            load_path(&path, VolumeChoice::default()),
            LoadErrorKind::BadInput,
            &[field, "missing"],
        );
    }
    for (field, words) in [
        ("NDims = 1", &["NDims"][..]),
        ("NDims = 5", &["NDims", "2 to 4"]),
        ("NDims = -3", &["NDims"]),
        ("DimSize = 2 2", &["DimSize"]),
        ("DimSize = 2 2 2 2", &["DimSize"]),
        ("DimSize = 2 -2 2", &["DimSize"]),
        ("DimSize = 2 0 2", &["DimSize", "at least 1"]),
        ("DimSize = 2 2 99999999999999999999999", &["DimSize"]),
        ("DimSize = 2 2 3", &["truncated", "12 bytes", "8 found"]),
        ("ElementType = MET_STRING", &["ElementType", "MET_STRING"]),
        ("ElementType = float", &["ElementType"]),
        ("ElementNumberOfChannels = 0", &["ElementNumberOfChannels"]),
        ("ElementNumberOfChannels = 9999999999", &["ElementNumberOfChannels"]),
        ("ElementSpacing = 1 1", &["ElementSpacing"]),
        ("ElementSpacing = 1 1 one", &["ElementSpacing", "one"]),
        ("TransformMatrix = 1 0 0", &["TransformMatrix", "9 numbers"]),
        ("Offset = 1 0", &["Offset"]),
        ("HeaderSize = -2", &["HeaderSize"]),
        ("HeaderSize = 18446744073709551615", &["truncated"]),
        ("HeaderSize = x", &["HeaderSize"]),
    ] {
        assert_refused(
            load_local(&[field], &VOXELS, VolumeChoice::default()),
            LoadErrorKind::BadInput,
            words,
        );
    }
    for field in ["CompressedData = True", "BinaryData = False"] {
        let refused = load_local(&["HeaderSize = -1", field], &VOXELS, VolumeChoice::default());
        assert_refused(refused, LoadErrorKind::BadInput, &["HeaderSize", "plain binary"]);
    }
    let folder = TempDir::new().unwrap();
    let path = write(&folder, "v.mha", HEADER, &[]);
    assert_refused(
        load_path(&path, VolumeChoice::default()),
        LoadErrorKind::BadInput,
        &["ElementDataFile", "missing"],
    );
    let endless = format!("{HEADER}Comment = {}", "x".repeat(5 << 20));
    let path = write(&folder, "v.mha", &endless, &[]);
    assert_refused(load_path(&path, VolumeChoice::default()), LoadErrorKind::Limit, &["4 MiB"]);
}

#[test]
fn lying_sizes_and_broken_data_are_refused() {
    for more in ["CompressedData = True", "BinaryData = False", "BinaryData = True"] {
        let refused = |size, kind, words: &[&str]| {
            assert_refused(load_local(&[size, more], &VOXELS, VolumeChoice::default()), kind, words);
        };
        refused("DimSize = 1000000 1000000 1000000", LoadErrorKind::Limit, &["DimSize", "1.0 MiB"]);
        refused("DimSize = 18446744073709551615 1 1", LoadErrorKind::Limit, &["DimSize"]);
        refused("DimSize = 100 100 100", LoadErrorKind::BadInput, &["data"]);
    }
    let many = load_local(&["NDims = 4", "DimSize = 1 1 1 9999999999"], &VOXELS, VolumeChoice::default());
    assert_refused(many, LoadErrorKind::Limit, &["too many"]);
    let zipped = zlib(&VOXELS);
    let compressed = |data: &[u8]| load_local(&["CompressedData = True"], data, VolumeChoice::default());
    for (data, words) in [
        (&zipped[..zipped.len() - 1], &["compressed data", "truncated"][..]),
        (&zipped[..4], &["truncated"]),
        (&zlib(&VOXELS[..7])[..], &["truncated", "8 bytes", "7 found"]),
        (&VOXELS[..], &["broken"]),
    ] {
        assert_refused(compressed(data), LoadErrorKind::BadInput, words);
    }
    let text = |data: &[u8]| load_local(&["BinaryData = False"], data, VolumeChoice::default());
    for (data, words) in [
        (&b"1 2 3 4 5 6 7        "[..], &["7 found"][..]),
        (b"1 2 3 4 5 6 7", &["truncated"]),
        (b"1 2 3 4 5 6 7 256", &["256"]),
        (b"1 2 3 4 5 6 7 eight", &["eight", "ElementType"]),
        (b"1 2 3 4 5 6 7 8.5", &["8.5"]),
        (&[b'1'; 5000], &["111"]),
    ] {
        assert_refused(text(data), LoadErrorKind::BadInput, words);
    }
    assert_eq!(*text(b"1 2.0 3 4 5 6 7 8e0 9").unwrap().samples(), Samples::U8(VOXELS.to_vec()));
}

#[test]
fn long_text_is_read_across_blocks() {
    let numbers: Vec<u16> = (0..400_000u32).map(|n| (n * 7919 % 65536) as u16).collect();
    let text = numbers.iter().fold(String::new(), |text, n| text + &n.to_string() + "\n");
    let fields = ["ElementType = MET_USHORT", "DimSize = 1000 400 1", "BinaryData = False"];
    assert_eq!(*read(&fields, text.as_bytes()).samples(), Samples::U16(numbers));
}

#[test]
fn bytes_behind_packed_data_are_passed_over() {
    for packed in [zlib(&VOXELS), gzip(&VOXELS)] {
        let padded = [&packed[..], &[0; 512], b"junk"].concat();
        let volume = read(&["CompressedData = True"], &padded);
        assert_eq!(*volume.samples(), Samples::U8(VOXELS.to_vec()));
        let cut =
            load_local(&["CompressedData = True"], &packed[..packed.len() - 5], VolumeChoice::default());
        assert_refused(cut, LoadErrorKind::BadInput, &["broken or truncated"]);
    }
}
