//! Tests of the reader of HDF5 files, on files that h5py and netCDF4 wrote; `tests/oracle/` compares their voxels.

mod mutations;

use std::path::{Path, PathBuf};

use crate::tests::helpers::{assert_refused, gzip, load_bytes, load_path};
use crate::{LoadOptions, load};
use chiaroscuro_volume::{FileDimension, LoadControl, LoadErrorKind, Portion, VolumeChoice};

fn oracle(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracle").join(name)
}

fn bytes_of(name: &str) -> Vec<u8> {
    std::fs::read(oracle(name)).unwrap()
}

#[test]
fn what_lies_elsewhere_or_is_packed_otherwise_is_refused() {
    for (name, words) in [
        ("other_file.h5", &["other files", "links"][..]),
        ("bdv_parts.h5", &["t00000", "another file"]),
        ("other_storage.h5", &["stored in other files", "voxels", "h5repack"]),
        ("virtual.h5", &["virtual dataset", "voxels"]),
        ("bitshuffle.h5", &["filter bitshuffle", "h5repack -f NONE"]),
        ("blosc2.h5", &["filter Blosc2", "h5repack -f NONE"]),
        ("scale_offset.h5", &["filter scale-offset", "h5repack -f NONE"]),
        ("text.h5", &["arrays", "2 are lists, text or records"]),
        ("empty.h5", &["ever written", "--array"]),
        ("circle.h5", &["it holds no arrays"]),
        ("minc.mnc", &["MINC 2", "mnc2nii"]),
    ] {
        let read = load_path(&oracle(&format!("refused/{name}")), VolumeChoice::default());
        assert_refused(read, LoadErrorKind::BadInput, words);
    }
}

#[test]
fn damaged_headers_are_refused_before_memory_is_taken() {
    let sizes = |numbers: [u64; 3]| numbers.map(u64::to_le_bytes).concat();
    for (name, kind, words) in [
        ("hdf5_new_contiguous.h5", LoadErrorKind::Limit, "are allowed"),
        ("hdf5_new_chunks.h5", LoadErrorKind::Limit, "are allowed"),
    ] {
        let mut bytes = bytes_of(&format!("written/{name}"));
        let at = bytes.windows(24).position(|window| window == sizes([3, 4, 5])).unwrap();
        bytes[at..at + 24].copy_from_slice(&sizes([1 << 40, 1 << 40, 1 << 40]));
        assert_refused(load_bytes("t.h5", &bytes, VolumeChoice::default()), kind, &[words, "t.h5"]);
    }
    let bytes = bytes_of("written/hdf5_old_shuffle.h5");
    for length in (0..bytes.len() - 1).step_by(97) {
        assert!(load_bytes("t.h5", &bytes[..length], VolumeChoice::default()).is_err(), "{length}");
    }
    let zipped = load_bytes("t.h5.gz", &gzip(&bytes), VolumeChoice::default());
    assert_refused(zipped, LoadErrorKind::BadInput, &["gunzip"]);
    let other = load_bytes("t.h5", &[7; 3000], VolumeChoice::default());
    assert_refused(other, LoadErrorKind::BadInput, &["signature"]);
}

#[test]
fn channels_have_names_and_colors_and_levels_are_offered() {
    let fallback = VolumeChoice::default().with_first_as_fallback();
    let volume = load_path(&oracle("written/hdf5_imaris.ims"), fallback.clone()).unwrap();
    let contents = volume.contents();
    assert_eq!(contents.format, Some("Imaris"));
    let channels = contents.alternatives_in(FileDimension::Channel).unwrap();
    let named: Vec<_> = channels.offers.iter().map(|offer| (offer.name.as_str(), offer.color)).collect();
    assert_eq!(named, [("DAPI", Some([0, 0, 255])), ("GFP", Some([0, 255, 0]))]);
    let levels = contents.alternatives_in(FileDimension::Level).unwrap();
    let dims: Vec<_> = levels.offers.iter().map(|offer| offer.dims).collect();
    assert_eq!((levels.selected, dims), (0, vec![Some([5, 4, 3]), Some([3, 2, 3])]));
    assert_eq!(contents.alternatives_in(FileDimension::Frame).map(|times| times.offers.len()), Some(2));
    let volume = load_path(&oracle("written/hdf5_bdv.xml"), fallback).unwrap();
    let channels = volume.contents().alternatives_in(FileDimension::Channel).unwrap().clone();
    assert_eq!(channels.offers[1].name, "red");
    let none = load_path(&oracle("written/hdf5_imaris.ims"), VolumeChoice::default());
    assert_refused(none, LoadErrorKind::BadInput, &["--channel", "DAPI"]);
}

#[test]
fn descriptions_name_a_file_beside_them_only() {
    let xml = String::from_utf8(bytes_of("written/hdf5_bdv.xml")).unwrap();
    for (name, words) in
        [("../hdf5_bdv.h5", "leads out"), ("/etc/passwd", "absolute"), ("none.h5", "no such file")]
    {
        let text = xml.replace("hdf5_bdv.h5", name);
        let error = load_bytes("t.xml", text.as_bytes(), VolumeChoice::default()).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn fill_values_are_missing() {
    let choice = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    let volume = load_path(&oracle("written/hdf5_netcdf.nc"), choice).unwrap();
    assert_eq!(volume.padding_value(), Some(-489.5));
    assert_eq!(volume.metadata().unit(), Some("kg m-3"));
}

#[test]
fn only_chunks_of_the_region_are_read() {
    let pieces = |portion: Option<Portion>| {
        let options = LoadOptions {
            choice: VolumeChoice { portion, ..VolumeChoice::default() },
            memory_budget_bytes: 1 << 20,
            ..LoadOptions::default()
        };
        let control = LoadControl::new();
        load(&oracle("written/hdf5_new_deflate_grows.h5"), &options, &control).unwrap();
        control.pieces_begun()
    };
    let corner = Portion { region: "0:1,0:1,0:1".parse().ok(), ..Portion::default() };
    let (whole, part) = (pieces(None), pieces(Some(corner)));
    // One of 12 chunks is read and decoded.
    assert!(part + 22 <= whole, "{part} of {whole}");
}
