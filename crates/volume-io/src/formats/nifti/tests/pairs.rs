//! Tests of header and data in two files, and of Analyze.

use std::fs;

use glam::DVec3;
use tempfile::TempDir;

use super::{assert_refused, gzip, header_348, load_path, write};
use crate::Endian;
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

#[test]
fn either_of_a_pair_can_be_named() {
    let header = header_348(Endian::Big, &[2, 1, 1], 4, b"ni1\0").f32(108, &[2.0]);
    let data = [9u8, 9, 1, 2, 255, 255];
    let expected = Samples::I16(vec![258, -1]);
    for (names, zipped) in [
        (["v.hdr", "v.img"], [false, false]),
        (["v.hdr", "v.img.gz"], [false, true]),
        (["v.hdr.gz", "v.img.gz"], [true, true]),
        (["V.HDR", "V.IMG"], [false, false]),
    ] {
        let folder = TempDir::new().unwrap();
        let packed = |bytes: &[u8], zipped| if zipped { gzip(bytes) } else { bytes.to_vec() };
        let paths = [
            write(&folder, names[0], &packed(&header.bytes, zipped[0])),
            write(&folder, names[1], &packed(&data, zipped[1])),
        ];
        for path in &paths {
            let volume = load_path(path, VolumeChoice::default()).unwrap();
            assert_eq!(*volume.samples(), expected, "{path:?}");
            assert_eq!(volume.name().to_lowercase(), "v");
        }
        fs::remove_file(&paths[1]).unwrap();
        let refused = load_path(&paths[0], VolumeChoice::default());
        assert_refused(refused, LoadErrorKind::BadInput, &["second file", ".img"]);
        fs::write(&paths[1], packed(&data[..5], zipped[1])).unwrap();
        for path in &paths {
            let refused = load_path(path, VolumeChoice::default());
            assert_refused(refused, LoadErrorKind::BadInput, &["truncated"]);
        }
        fs::write(&paths[0], b"no header").unwrap();
        assert_refused(
            load_path(&paths[1], VolumeChoice::default()),
            LoadErrorKind::BadInput,
            &["not a NIfTI or Analyze header"],
        );
        fs::remove_file(&paths[0]).unwrap();
        assert_refused(load_path(&paths[1], VolumeChoice::default()), LoadErrorKind::BadInput, &[".hdr"]);
    }
}

#[test]
fn analyze_says_no_sides() {
    for endian in [Endian::Little, Endian::Big] {
        let folder = TempDir::new().unwrap();
        // Fields that only NIfTI defines are ignored in Analyze files.
        let header = header_348(endian, &[2, 1, 1, 1], 2, &[0; 4])
            .f32(108, &[0.0, 2.0, 100.0])
            .i16(68, &[1002])
            .i16(252, &[1, 1])
            .text(56, b"um\0\0HU");
        write(&folder, "a.hdr", &header.bytes[..348]);
        let path = write(&folder, "a.img", &[1, 2]);
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(vec![2, 4]), "SPM writes a slope");
        assert!((volume.spacing_mm() - DVec3::new(2.0, 3.0, 4.0) * 1e-3).length() < 1e-12);
        assert!(!volume.is_anatomical());
        assert!(volume.remarks()[0].contains("Analyze"));
        assert_eq!(volume.metadata().unit(), Some("HU"));
    }
}

#[test]
#[cfg(unix)]
fn the_other_file_is_not_looked_for_elsewhere() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    let secret = write(&folder, "secret", &[1, 2]);
    std::os::unix::fs::symlink(&secret, folder.path().join("inner/v.img")).unwrap();
    let path = write(&folder, "inner/v.hdr", &header_348(Endian::Little, &[2, 1, 1], 2, b"ni1\0").bytes);
    assert_refused(load_path(&path, VolumeChoice::default()), LoadErrorKind::BadInput, &["link"]);
}
