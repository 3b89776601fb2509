//! Tests of invalid headers and corrupt files, which must be refused.

use super::{NiftiBuilder, assert_refused, gzip, load_bytes, nifti1_header, read};
use crate::Endian;
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

#[track_caller]
fn refused(file: &[u8], words: &[&str]) {
    assert_refused(load_bytes(file, VolumeChoice::default()), LoadErrorKind::BadInput, words);
}

#[test]
fn wrong_fields_are_named() {
    let header = || nifti1_header(&[2, 1, 1], 2);
    for (header, words) in [
        (header().i16(40, &[0]), &["dim[0]"][..]),
        (header().i16(40, &[8]), &["dim[0]"]),
        (header().i16(42, &[0]), &["dim", "empty"]),
        (header().i16(42, &[-1]), &["dim[1]", "-1"]),
        (header().i16(46, &[-7]), &["dim[3]", "-7"]),
        (header().i16(70, &[1]), &["datatype", "one bit"]),
        (header().i16(70, &[1536]), &["datatype", "128 bits"]),
        (header().i16(70, &[7777]), &["datatype", "7777"]),
        (header().f32(108, &[-1.0]), &["vox_offset", "-1"]),
        (header().f32(108, &[f32::NAN]), &["vox_offset"]),
        (header().f32(108, &[1e30]), &["vox_offset"]),
        (header().f32(108, &[1e18]), &["truncated"]),
        (header().i16(42, &[3]), &["truncated", "3 bytes", "2 found"]),
    ] {
        refused(&header.with_data(&[1, 2]), words);
    }
    let two = |dims: &[i64]| {
        let header = NiftiBuilder { endian: Endian::Little, bytes: vec![0; 544] };
        header.i32(0, &[540]).text(4, b"n+2\0").i16(12, &[2]).i64(16, dims).i64(168, &[544]).with_data(&[1])
    };
    assert!(load_bytes(&two(&[3, 1, 1, 1]), VolumeChoice::default()).is_ok());
    refused(&two(&[i64::MIN, 1, 1, 1]), &["dim[0]"]);
    refused(&two(&[3, -1, 1, 1]), &["dim[1]"]);
    for dims in [[3, i64::MAX, i64::MAX, i64::MAX, 1], [4, 1, 1, 1, i64::MAX], [3, 1 << 11, 1 << 10, 1, 1]] {
        assert_refused(load_bytes(&two(&dims), VolumeChoice::default()), LoadErrorKind::Limit, &["dim"]);
    }
}

#[test]
fn empty_offsets_mean_the_header_and_extensions_are_skipped() {
    let expected = Samples::U8(vec![1, 2]);
    let header = nifti1_header(&[2, 1, 1], 2);
    assert_eq!(*read(&header.clone().f32(108, &[0.0]).with_data(&[1, 2])).samples(), expected);
    let extension = [16u8, 0, 0, 0, 6, 0, 0, 0, b'n', b'o', b't', b'e', 0, 0, 0, 0];
    let extended = header.text(348, &[1]).f32(108, &[368.0]);
    assert_eq!(*read(&extended.with_data(&[&extension[..], &[1, 2, 99]].concat())).samples(), expected);
}

#[test]
fn broken_files_are_refused() {
    let file = nifti1_header(&[2, 1, 1], 2).with_data(&[1, 2]);
    for length in [0, 4, 347] {
        refused(&file[..length], &["header"]);
    }
    let zipped = gzip(&file);
    refused(&zipped[..zipped.len() - 1], &["truncated"]);
    let mut changed = zipped.clone();
    let checksum = changed.len() - 8;
    changed[checksum] ^= 1;
    refused(&changed, &["broken"]);
    refused(&gzip(&file[..file.len() - 1]), &["truncated"]);
    refused(&gzip(&file[..300]), &["header"]);
}
