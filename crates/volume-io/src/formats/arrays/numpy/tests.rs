//! Tests of NumPy arrays and archives: every type, order and shape, and headers with false sizes.

use std::io::Write as _;

use super::*;
use crate::tests::helpers::load_bytes as loaded_as;
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

fn array_of(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let length = header.len();
    let length = if version == 1 {
        (length as u16).to_le_bytes().to_vec()
    } else {
        (length as u32).to_le_bytes().to_vec()
    };
    [MAGIC, &[version, 0], &length, header.as_bytes(), data].concat()
}

fn array(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    array_of(1, &header, data)
}

fn loaded(bytes: &[u8]) -> Result<Volume, LoadError> {
    loaded_as("a.bin", bytes, VolumeChoice::default())
}

#[test]
fn every_type_and_byte_order_is_read() {
    macro_rules! check {
        ($code:expr, $type:ty, $values:expr, $expected:expr) => {
            let values: [$type; 4] = $values;
            for (order, bytes) in [
                ("<", values.map(|v| v.to_le_bytes()).concat()),
                (">", values.map(|v| v.to_be_bytes()).concat()),
            ] {
                let code = format!("{order}{}", $code);
                let volume = loaded(&array(&code, "False", "(1, 2, 2)", &bytes)).unwrap();
                assert_eq!(*volume.samples(), $expected, "{code}");
                assert_eq!((volume.dims(), volume.has_unknown_scale()), ([2, 2, 1], true));
            }
        };
    }
    check!("u1", u8, [1, 2, 3, 255], Samples::U8(vec![1, 2, 3, 255]));
    check!("i1", i8, [1, 2, 3, -1], Samples::I8(vec![1, 2, 3, -1]));
    check!("u2", u16, [1, 2, 3, 65535], Samples::U16(vec![1, 2, 3, 65535]));
    check!("i2", i16, [1, 2, 3, -300], Samples::I16(vec![1, 2, 3, -300]));
    check!("u4", u32, [1, 2, 3, u32::MAX], Samples::U32(vec![1, 2, 3, u32::MAX]));
    check!("i4", i32, [1, 2, 3, i32::MIN], Samples::I32(vec![1, 2, 3, i32::MIN]));
    check!("u8", u64, [1, 2, 3, 1 << 40], Samples::F64(vec![1.0, 2.0, 3.0, (1u64 << 40) as f64]));
    check!("i8", i64, [1, 2, 3, -5], Samples::I32(vec![1, 2, 3, -5]));
    check!("f4", f32, [1.5, 2.0, 3.0, -1.0], Samples::F32(vec![1.5, 2.0, 3.0, -1.0]));
    check!("f8", f64, [1.5, 2.0, 3.0, -1.0], Samples::F64(vec![1.5, 2.0, 3.0, -1.0]));
    let halves = [1.5f32, 2.0, 3.0, -1.0].map(|v| half::f16::from_f32(v).to_bits());
    check!("f2", u16, halves, Samples::F32(vec![1.5, 2.0, 3.0, -1.0]));
    let bools = loaded(&array("|b1", "False", "(2, 2)", &[0, 1, 1, 0])).unwrap();
    assert_eq!(*bools.samples(), Samples::U8(vec![0, 1, 1, 0]));
    let complex = [3.0f32, 4.0, 0.0, 1.0].map(f32::to_le_bytes).concat();
    let volume = loaded(&array("<c8", "False", "(1, 2)", &complex)).unwrap();
    assert_eq!(*volume.samples(), Samples::F32(vec![5.0, 1.0]));
    assert!(volume.remarks()[0].contains("complex"));
    let imaginary = VolumeChoice { component: Some(1), ..VolumeChoice::default() };
    let volume = loaded_as("a.npy", &array("<c8", "False", "(1, 2)", &complex), imaginary).unwrap();
    assert_eq!((volume.samples(), volume.remarks().len()), (&Samples::F32(vec![4.0, 1.0]), 0));
}

#[test]
fn every_version_is_read() {
    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2), }";
    for version in [1, 2, 3] {
        let volume = loaded(&array_of(version, header, &[5, 6])).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(vec![5, 6]));
    }
    let error = loaded(&array_of(4, header, &[5, 6])).unwrap_err();
    assert!(error.to_string().contains("version 4"), "{error}");
}

#[test]
fn axes_are_a_volume_or_several() {
    let data: Vec<u8> = (0..24).collect();
    for (order, shape, dims) in [
        ("False", "(2, 3, 4)", [4, 3, 2]),
        ("True", "(4, 3, 2)", [4, 3, 2]),
        ("False", "(6, 4)", [4, 6, 1]),
        ("True", "(6, 4)", [6, 4, 1]),
        ("False", "(1, 2, 2, 6)", [6, 2, 2]),
        ("False", "(1, 2, 3, 4, 1, 1)", [4, 3, 2]),
        ("True", "(6, 2, 2, 1)", [6, 2, 2]),
        ("False", "(2L, 3, 4)", [4, 3, 2]),
    ] {
        let volume = loaded(&array("|u1", order, shape, &data)).unwrap();
        assert_eq!((volume.dims(), volume.samples()), (dims, &Samples::U8(data.clone())), "{shape}");
    }
    let frames = array("|u1", "False", "(2, 3, 2, 2)", &data);
    let error = loaded(&frames).unwrap_err();
    assert!(
        matches!(&error, LoadError::Several { dimension: FileDimension::Frame, offers, .. } if offers.len() == 2)
    );
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    assert_eq!(
        *loaded_as("a.npy", &frames, choice.clone()).unwrap().samples(),
        Samples::U8((12..24).collect())
    );
    let channels = array("|u1", "False", "(2, 3, 2, 2, 2)", &(0..48).collect::<Vec<u8>>());
    let error = loaded_as("a.npy", &channels, choice.clone()).unwrap_err();
    assert!(matches!(error, LoadError::Several { dimension: FileDimension::Channel, .. }));
    let both = VolumeChoice { channel: Some(2), ..choice };
    assert_eq!(*loaded_as("a.npy", &channels, both).unwrap().samples(), Samples::U8((40..48).collect()));

    let colors = array("|u1", "False", "(1, 2, 2, 3)", &[9, 9, 9, 0, 0, 0, 0, 255, 0, 7, 7, 7]);
    let volume = loaded(&colors).unwrap();
    assert_eq!((volume.dims(), volume.samples()), ([2, 2, 1], &Samples::U8(vec![9, 0, 182, 7])));
    assert!(volume.remarks()[0].contains("luminance"));
    let green = VolumeChoice { component: Some(1), ..VolumeChoice::default() };
    assert_eq!(*loaded_as("a.npy", &colors, green).unwrap().samples(), Samples::U8(vec![9, 0, 255, 7]));
    let alpha = VolumeChoice { component: Some(3), ..VolumeChoice::default() };
    assert!(loaded_as("a.npy", &colors, alpha).unwrap_err().to_string().contains("--component"));
}

#[test]
fn inconsistent_headers_are_refused() {
    let data = [0; 24];
    for (bytes, kind, words) in [
        (array("|u1", "False", "(5, 5, 1)", &data), LoadErrorKind::BadInput, "25 bytes expected"),
        (array("|u1", "False", "(5, 0, 1)", &data), LoadErrorKind::BadInput, "empty"),
        (array("|u1", "False", "(0, 5, 5, 2)", &data), LoadErrorKind::BadInput, "no time steps"),
        (array("|u1", "False", "(24,)", &data), LoadErrorKind::BadInput, "1 axes"),
        (array("|u1", "False", "()", &data), LoadErrorKind::BadInput, "0 axes"),
        (array("|u1", "False", "(2, 2, 2, 2, 2, 2)", &data), LoadErrorKind::BadInput, "6 axes"),
        (array("|u1", "False", "(99999999999, 9999999999999, 99)", &data), LoadErrorKind::Limit, "allowed"),
        (array("|u1", "False", "(999999, 2, 3, 5)", &data), LoadErrorKind::Limit, "time steps"),
        (array("<f16", "False", "(2, 2)", &data), LoadErrorKind::BadInput, "astype"),
        (array("|O", "False", "(2, 2)", &data), LoadErrorKind::BadInput, "\"|O\""),
        (array("<U5", "False", "(2, 2)", &data), LoadErrorKind::BadInput, "\"<U5\""),
        (array_of(1, "{'descr': [('a', '<f4')]}", &data), LoadErrorKind::BadInput, "records"),
        (array_of(1, "{'descr': '<f4'}", &data), LoadErrorKind::BadInput, "shape"),
        (array_of(1, "{}", &data), LoadErrorKind::BadInput, "descr"),
        (array_of(1, "import os", &data), LoadErrorKind::BadInput, "in braces"),
        (array_of(2, &" ".repeat(70_000), &data), LoadErrorKind::BadInput, "too long for an array"),
        (array_of(2, "", &data)[..9].to_vec(), LoadErrorKind::BadInput, "truncated"),
        (MAGIC.to_vec(), LoadErrorKind::BadInput, "truncated"),
    ] {
        let error = loaded(&bytes).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
    let error = loaded_as("a.npy", b"x", VolumeChoice::default()).unwrap_err();
    assert!(error.to_string().contains("truncated"), "{error}");
}

/// Builds a ZIP archive of names and contents: deflated or stored; with sizes after the entries, as streaming writers
/// do, or before them; with ZIP64 sizes or not.
fn archive(files: &[(&str, &[u8])], [is_deflated, is_stream, is_large]: [bool; 3]) -> Vec<u8> {
    let (mut bytes, mut lines) = (Vec::new(), Vec::new());
    let number = |value: usize| (value as u32).to_le_bytes();
    for (name, content) in files {
        let at = bytes.len();
        let mut crc = flate2::Crc::new();
        crc.update(content);
        let stored = if is_deflated {
            let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(content).unwrap();
            encoder.finish().unwrap()
        } else {
            content.to_vec()
        };
        let method = if is_deflated { 8u16 } else { 0 }.to_le_bytes();
        let flags = if is_stream { 8u16 } else { 0 }.to_le_bytes();
        let sizes = [crc.sum().to_le_bytes(), number(stored.len()), number(content.len())].concat();
        let early = if is_stream { vec![0; 12] } else { sizes.clone() };
        let name_length = (name.len() as u16).to_le_bytes();
        let start = [&[20, 0][..], &flags, &method, &[0; 4]].concat();
        bytes.extend(
            [b"PK\x03\x04", &start[..], &early, &name_length, &[0, 0], name.as_bytes(), &stored].concat(),
        );
        if is_stream {
            bytes.extend([b"PK\x07\x08", &sizes[..]].concat());
        }
        let (sizes, extra) = if is_large {
            let large = [content.len(), stored.len(), at].map(|n| (n as u64).to_le_bytes()).concat();
            let sizes = [&crc.sum().to_le_bytes()[..], &[0xff; 8]].concat();
            (sizes, [&[9, 9, 1, 0, 0, 1, 0, 24, 0][..], &large].concat())
        } else {
            (sizes, Vec::new())
        };
        let place = if is_large { [0xff; 4] } else { number(at) };
        let extra_length = (extra.len() as u16).to_le_bytes();
        let rest = [&name_length[..], &extra_length, &[0; 10], &place, name.as_bytes(), &extra].concat();
        lines.extend([b"PK\x01\x02", &[20, 0][..], &start, &sizes, &rest].concat());
    }
    let (at, length) = (bytes.len(), lines.len());
    bytes.extend(&lines);
    if is_large {
        let end = bytes.len() as u64;
        let numbers = [length as u64, at as u64].map(u64::to_le_bytes).concat();
        bytes.extend([b"PK\x06\x06", &[0; 36][..], &numbers].concat());
        bytes.extend([b"PK\x06\x07", &[0; 4][..], &end.to_le_bytes(), &[1, 0, 0, 0]].concat());
        bytes.extend([b"PK\x05\x06", &[0; 8][..], &[0xff; 8], &[0; 2]].concat());
    } else {
        bytes.extend([b"PK\x05\x06", &[0; 8][..], &number(length), &number(at), &[0; 2]].concat());
    }
    bytes
}

#[test]
fn archives_are_read_however_they_are_written() {
    let data: Vec<u8> = (0..240).map(|n| n / 3).collect();
    let volume = array("|u1", "False", "(6, 5, 8)", &data);
    let other = array("<i2", "True", "(2, 1, 1)", &[1, 0, 2, 0]);
    let table = array("<f8", "False", "(3,)", &[0; 24]);
    for at in 0..8 {
        let (is_deflated, is_stream, is_large) = (at & 1 > 0, at & 2 > 0, at & 4 > 0);
        let write = |files: &[(&str, &[u8])]| archive(files, [is_deflated, is_stream, is_large]);
        let one = write(&[("table.npy", &table), ("readme.txt", b"hello"), ("ct.npy", &volume)]);
        let found = loaded_as("scan.npz", &one, VolumeChoice::default()).unwrap();
        assert_eq!((found.dims(), found.samples()), ([8, 5, 6], &Samples::U8(data.clone())), "{at}");
        assert_eq!(found.name(), "scan ct");
        let two = write(&[("ct.npy", &volume), ("mask.npy", &other)]);
        let error = loaded(&two).unwrap_err();
        let LoadError::Several { dimension: FileDimension::Array, offers, .. } = error else { panic!("two") };
        assert_eq!((offers[1].key.as_str(), offers[1].dims), ("mask", Some([2, 1, 1])));
        let mask = VolumeChoice { array: Some("mask".to_owned()), ..VolumeChoice::default() };
        assert_eq!(*loaded_as("a.npz", &two, mask).unwrap().samples(), Samples::I16(vec![1, 2]));
    }
}

#[test]
fn matrices_and_tables_are_not_offered() {
    let data: Vec<u8> = (0..240).collect();
    let volume = array("|u1", "False", "(6, 5, 8)", &data);
    let affine = array("<f8", "False", "(4, 4)", &[0; 128]);
    let poses = array("<f4", "False", "(9, 3, 3)", &[0; 324]);
    let points = array("<f4", "False", "(100, 3)", &[0; 1200]);
    let picture = array("|u1", "False", "(16, 20)", &[1; 320]);
    let write = |files: &[(&str, &[u8])]| archive(files, [true, false, false]);
    let files =
        [("data.npy", &volume[..]), ("affine.npy", &affine), ("poses.npy", &poses), ("points.npy", &points)];
    let found = loaded(&write(&files)).unwrap();
    assert_eq!((found.dims(), found.samples()), ([8, 5, 6], &Samples::U8(data)));
    let named = |name: &str| VolumeChoice { array: Some(name.to_owned()), ..VolumeChoice::default() };
    let found = loaded_as("a.npz", &write(&files), named("affine")).unwrap();
    assert_eq!(found.dims(), [4, 4, 1], "what is named is meant");
    let unknown = loaded_as("a.npz", &write(&files), named("mask")).unwrap_err();
    assert!(unknown.to_string().contains("\"mask\" is not one"), "{unknown}");
    // Pictures are offered, too, and tables only where there is nothing else.
    let error = loaded(&write(&[("data.npy", &volume), ("image.npy", &picture)])).unwrap_err();
    assert!(matches!(error, LoadError::Several { offers, .. } if offers.len() == 2));
    assert_eq!(loaded(&write(&[("affine.npy", &affine)])).unwrap().dims(), [4, 4, 1]);
}

#[test]
fn an_affine_beside_a_volume_places_it() {
    let numbers = [2.0, 0.0, 0.0, -7.0, 0.0, 3.0, 0.5, -8.0, 0.0, 0.0, 4.0, 9.0, 0.0, 0.0, 0.0, 1.0f64];
    let bytes = |numbers: &[f64]| -> Vec<u8> { numbers.iter().flat_map(|n| n.to_le_bytes()).collect() };
    let transposed: Vec<f64> = (0..16).map(|at| numbers[at % 4 * 4 + at / 4]).collect();
    let singles: Vec<u8> = numbers.iter().flat_map(|&n| (n as f32).to_be_bytes()).collect();
    let affines = [
        array("<f8", "False", "(4, 4)", &bytes(&numbers)),
        array("<f8", "True", "(4, 4)", &bytes(&transposed)),
        array(">f4", "False", "(4, 4)", &singles),
    ];
    let data: Vec<u8> = (0..240).collect();
    let load = |affine: &[u8], order: &str, shape: &str| {
        let volume = array("|u1", order, shape, &data);
        let archive = archive(&[("data.npy", &volume), ("affine.npy", affine)], [true, false, false]);
        loaded_as("a.npz", &archive, VolumeChoice { frame: Some(0), ..VolumeChoice::default() }).unwrap()
    };
    let columns = |volume: &Volume| volume.world_from_index().to_cols_array();
    for affine in &affines {
        let volume = load(affine, "True", "(6, 5, 8)");
        assert_eq!(volume.dims(), [6, 5, 8]);
        assert_eq!(columns(&volume), [2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.5, 4.0, -7.0, -8.0, 9.0]);
        assert!(volume.is_anatomical() && !volume.has_unknown_scale() && volume.remarks().is_empty());
        // Both memory orders place a voxel of given indices at the same point.
        let volume = load(affine, "False", "(6, 5, 8)");
        assert_eq!(volume.dims(), [8, 5, 6]);
        assert_eq!(columns(&volume), [0.0, 0.5, 4.0, 0.0, 3.0, 0.0, 2.0, 0.0, 0.0, -7.0, -8.0, 9.0]);
        // Time is the last axis of nibabel's arrays.
        let volume = load(affine, "True", "(6, 5, 4, 2)");
        assert_eq!((volume.dims(), volume.is_anatomical()), ([6, 5, 4], true));
        let volume = load(affine, "False", "(2, 4, 6, 5)");
        assert!(volume.has_unknown_scale() && volume.remarks()[0].contains("are not those of the volume"));
    }
    for (at, value, words) in [(0, 0.0, "singular"), (5, f64::NAN, "not finite"), (12, 2.0, "last row")] {
        let mut wrong = numbers;
        wrong[at] = value;
        let volume = load(&array("<f8", "False", "(4, 4)", &bytes(&wrong)), "True", "(6, 5, 8)");
        assert!(volume.has_unknown_scale() && volume.remarks()[0].contains(words), "{:?}", volume.remarks());
    }
    let short = load(&array("<f8", "False", "(4, 4)", &[0; 100]), "True", "(6, 5, 8)");
    assert!(short.remarks()[0].contains("it cannot be read"), "{:?}", short.remarks());
}

#[test]
fn inconsistent_archives_are_refused() {
    let volume = array("|u1", "False", "(6, 5, 8)", &[7; 240]);
    let table = array("<f8", "False", "(3,)", &[0; 24]);
    let stored = archive(&[("ct.npy", &volume)], [false; 3]);
    let deflated = archive(&[("ct.npy", &volume)], [true, false, false]);
    let changed = |bytes: &[u8], mark: &[u8], at: usize, to: &[u8]| {
        let mut bytes = bytes.to_vec();
        let start = bytes.windows(4).rposition(|window| window == mark).unwrap() + at;
        bytes[start..start + to.len()].copy_from_slice(to);
        bytes
    };
    let line = b"PK\x01\x02";
    let end = b"PK\x05\x06";
    let short = array("|u1", "False", "(6, 5, 9)", &[7; 240]);
    for (bytes, words) in [
        (stored[..stored.len() - 30].to_vec(), "no directory"),
        (changed(&stored, b"PK\x03\x04", 150, &[9]), "checksum"),
        (changed(&stored, line, 20, &[0xff, 0xff, 0xff, 0x7f]), "cannot be the size"),
        (changed(&deflated, line, 24, &[0xff, 0xff, 0xff, 0x7f]), "cannot be the size"),
        (changed(&stored, line, 24, &[0xff; 4]), "does not state its size"),
        (changed(&stored, line, 42, &[7]), "not where"),
        (changed(&stored, line, 42, &[0xff, 0xff, 0xff, 0x7f]), "not where"),
        (changed(&stored, line, 28, &[0xff, 0x7f]), "truncated"),
        (changed(&stored, end, 12, &[0xff, 0xff]), "directory of the archive is too long"),
        (changed(&stored, line, 8, &[1]), "1 array is encrypted, and cannot be read"),
        (changed(&stored, line, 10, &[12]), "1 array is compressed in a way that is not supported"),
        (archive(&[("ct.npy", &short)], [true, false, false]), "truncated"),
        (archive(&[("a.npy", &table)], [true, false, false]), "1 axes"),
        (archive(&[("a.npy", &table), ("b.npy", &table)], [true, false, false]), "none of its 2 arrays"),
        (archive(&[], [true, false, false]), "it holds no arrays"),
        (b"PK".to_vec(), "no directory"),
    ] {
        let error = loaded_as("a.npz", &bytes, VolumeChoice::default()).unwrap_err();
        assert_eq!(error.kind(), LoadErrorKind::BadInput, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
}
