//! Tests that load folders of pictures through the public interface.

mod recordings;

use std::path::Path;

use image::{DynamicImage, ImageFormat};
use tempfile::TempDir;

use crate::tests::helpers::assert_refused;
use crate::{LoadOptions, load};
use chiaroscuro_volume::{LoadControl, LoadError, LoadErrorKind, Samples, Volume, VolumeChoice};

fn load_with(path: &Path, choice: VolumeChoice) -> Result<Volume, LoadError> {
    let options = LoadOptions { memory_budget_bytes: 1 << 16, choice, ..LoadOptions::default() };
    load(path, &options, &LoadControl::new())
}

fn load_path(path: &Path) -> Result<Volume, LoadError> {
    load_with(path, VolumeChoice::default())
}

fn grey(width: u32, values: &[u8]) -> DynamicImage {
    let height = values.len() as u32 / width;
    image::GrayImage::from_raw(width, height, values.to_vec()).unwrap().into()
}

fn grey16(values: &[u16]) -> DynamicImage {
    image::ImageBuffer::<image::Luma<u16>, _>::from_raw(values.len() as u32, 1, values.to_vec())
        .unwrap()
        .into()
}

fn folder(pictures: &[(&str, DynamicImage)]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, picture) in pictures {
        picture.save_with_format(folder.path().join(name), ImageFormat::from_path(name).unwrap()).unwrap();
    }
    folder
}

#[test]
fn slices_are_stacked_in_natural_order() {
    let stack = folder(&[
        ("slice 10.png", grey(2, &[5, 6])),
        ("slice 9.png", grey(2, &[3, 4])),
        ("slice 8.PNG", grey(2, &[1, 2])),
    ]);
    for (name, bytes) in [("Thumbs.db", &b"BM, by chance"[..]), ("notes.txt", b"x"), ("empty", b"")] {
        std::fs::write(stack.path().join(name), bytes).unwrap();
    }
    let volume = load_path(stack.path()).unwrap();
    assert_eq!((volume.dims(), volume.samples()), ([2, 1, 3], &Samples::U8(vec![1, 2, 3, 4, 5, 6])));
    assert!(volume.has_unknown_scale() && volume.remarks().is_empty());
    let stack =
        folder(&[("a1.png", grey16(&[1, 60_000])), ("a4.png", grey16(&[3, 4])), ("a5.png", grey16(&[5, 6]))]);
    let volume = load_path(stack.path()).unwrap();
    assert_eq!(*volume.samples(), Samples::U16(vec![1, 60_000, 3, 4, 5, 6]));
    assert!(volume.remarks()[0].contains("between numbers 1 and 4"));
}

#[test]
fn of_a_folder_the_files_that_are_meant_are_read() {
    let stack = folder(&[
        ("1.png", grey(2, &[1, 2])),
        ("2.png", grey(2, &[3, 4])),
        ("3.png", grey(2, &[5, 6])),
        ("other.png", grey(1, &[9])),
    ]);
    let meant = |names: &[&str]| {
        let among = names.iter().map(|name| stack.path().join(name)).collect();
        let options = LoadOptions { only_files: Some(among), ..LoadOptions::default() };
        load(stack.path(), &options, &LoadControl::new())
    };
    assert_eq!(*meant(&["3.png", "2.png"]).unwrap().samples(), Samples::U8(vec![3, 4, 5, 6]));
    assert_eq!(*meant(&["other.png"]).unwrap().samples(), Samples::U8(vec![9]));
    assert_refused(meant(&["elsewhere.png"]), LoadErrorKind::BadInput, &["none of its 0 files"]);
}

#[test]
fn all_kinds_of_pictures_also_single() {
    let picture = grey(4, &[7; 16]);
    for ending in ["png", "bmp", "jpg"] {
        // Encoders of BMP and JPEG accept grey.
        let name = format!("one.{ending}");
        let one = folder(&[(name.as_str(), picture.clone())]);
        let volume = load_path(&one.path().join(&name)).unwrap();
        assert_eq!((volume.dims(), volume.name()), ([4, 4, 1], "one"), "{ending}");
        assert!((volume.value(1, 1, 0) - 7.0).abs() <= 1.0, "{ending}");
        assert_eq!(load_path(one.path()).unwrap().dims(), [4, 4, 1], "{ending}");
    }
    let color: DynamicImage = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 10, 20, 30]).unwrap().into();
    let stack = folder(&[("1.png", color.clone()), ("2.png", color)]);
    let volume = load_path(stack.path()).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![54, 19, 54, 19]));
    assert!(volume.remarks()[0].contains("luminance"));
    let blue =
        load_with(stack.path(), VolumeChoice { component: Some(2), ..VolumeChoice::default() }).unwrap();
    assert_eq!(*blue.samples(), Samples::U8(vec![0, 30, 0, 30]));
    let none = load_with(stack.path(), VolumeChoice { component: Some(3), ..VolumeChoice::default() });
    assert_refused(none, LoadErrorKind::BadInput, &["component 3", "its 3"]);
}

#[test]
fn slices_that_differ_are_named() {
    let sizes = folder(&[("a1.png", grey(2, &[1, 2])), ("a2.png", grey(1, &[1, 2]))]);
    assert_refused(
        load_path(sizes.path()),
        LoadErrorKind::BadInput,
        &["\"a2.png\" has 1 x 2", "\"a1.png\" has 2 x 1"],
    );
    let types = folder(&[("a1.png", grey(2, &[1, 2])), ("a2.png", grey16(&[1, 2]))]);
    assert_refused(load_path(types.path()), LoadErrorKind::BadInput, &["1 x 16 bits", "1 x 8 bits"]);
}

#[test]
fn several_groups_are_series_and_strays_are_left_out() {
    let pixel = |value| grey(1, &[value]);
    let two = folder(&[
        ("a1.png", pixel(1)),
        ("a2.png", pixel(2)),
        ("b1.png", pixel(3)),
        ("b2.png", pixel(4)),
        ("b3.png", pixel(5)),
    ]);
    assert_refused(load_path(two.path()), LoadErrorKind::BadInput, &["2 series", "1 \"b#.png\" (1 x 1 x 3)"]);
    let choice = VolumeChoice { series: Some("b#.png".to_owned()), ..VolumeChoice::default() };
    let volume = load_with(two.path(), choice).unwrap();
    assert_eq!((volume.samples(), volume.name()), (&Samples::U8(vec![3, 4, 5]), "b#.png"));
    let stray = folder(&[
        ("a1.png", pixel(1)),
        ("a2.png", pixel(2)),
        ("a3.png", pixel(3)),
        ("overview.png", grey(2, &[9, 9])),
    ]);
    let volume = load_path(stray.path()).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![1, 2, 3]));
    assert!(volume.remarks()[0].contains("1 single pictures"));
}

#[test]
fn broken_and_huge_pictures_are_refused() {
    let stack = folder(&[("a1.png", grey(2, &[1, 2])), ("a2.png", grey(2, &[3, 4]))]);
    let path = stack.path().join("a2.png");
    let whole = std::fs::read(&path).unwrap();
    for len in [20, whole.len() - 14] {
        std::fs::write(&path, &whole[..len]).unwrap();
        assert_refused(load_path(stack.path()), LoadErrorKind::BadInput, &["a2.png", "the picture is"]);
        assert_refused(load_path(&path), LoadErrorKind::BadInput, &["the picture is"]);
    }
    // The size of a PNG picture is at byte 16; its checksum is recomputed.
    let mut huge = whole.clone();
    huge[16..24].copy_from_slice(&[0x7F, 0xFF, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF, 0xFF]);
    let mut checksum = flate2::Crc::new();
    checksum.update(&huge[12..29]);
    huge[29..33].copy_from_slice(&checksum.sum().to_be_bytes());
    std::fs::write(&path, &huge).unwrap();
    let error = load_path(&path).unwrap_err();
    assert!(matches!(error.kind(), LoadErrorKind::Limit | LoadErrorKind::BadInput), "{error}");
    // Half of a JPEG picture: decoders fill the missing rest with grey.
    let values: Vec<u8> = (0..64 * 64).map(|at| (at * 37 % 251) as u8).collect();
    let lossy = folder(&[("a.jpg", grey(64, &values))]);
    let path = lossy.path().join("a.jpg");
    let whole = std::fs::read(&path).unwrap();
    assert!(load_path(&path).is_ok());
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    assert_refused(load_path(&path), LoadErrorKind::BadInput, &["a.jpg", "its end marker is missing"]);
    let large = folder(&[("a.png", grey(300, &vec![0; 300 * 300]))]);
    assert_refused(load_path(&large.path().join("a.png")), LoadErrorKind::Limit, &["allowed"]);
}

#[test]
fn a_slice_that_is_no_picture_is_said() {
    let damaged = |bytes: &[u8], name: &str| {
        let stack = folder(&[("s000.png", grey(2, &[1, 2])), ("s002.png", grey(2, &[3, 4]))]);
        std::fs::write(stack.path().join(name), bytes).unwrap();
        std::fs::write(stack.path().join("notes001.txt"), b"x").unwrap();
        load_path(stack.path()).unwrap().remarks().join("; ")
    };
    for bytes in [&b"garbage"[..], b"", &[0; 4096]] {
        let remarks = damaged(bytes, "s001.png");
        assert!(remarks.contains("\"s001.png\" is left out: it is not a picture"), "{remarks}");
        assert!(!remarks.contains("notes"), "{remarks}");
    }
    assert!(damaged(b"garbage", "other.jpeg").contains("\"other.jpeg\" is left out"));
    assert!(!damaged(b"garbage", "other.dat").contains("left out"));
    // A single slice is left, which is read as a file of its own.
    let two = TempDir::new().unwrap();
    grey(2, &[1, 2]).save_with_format(two.path().join("a0.png"), ImageFormat::Png).unwrap();
    std::fs::write(two.path().join("a1.png"), b"garbage").unwrap();
    let volume = load_path(two.path()).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![1, 2]));
    assert!(volume.remarks()[0].contains("\"a1.png\" is left out"));
    // Damaged files of another series are not reported.
    let series = folder(&[
        ("a1.png", grey(1, &[1])),
        ("a2.png", grey(1, &[2])),
        ("b1.png", grey(1, &[3])),
        ("b2.png", grey(1, &[4])),
    ]);
    std::fs::write(series.path().join("b3.png"), b"garbage").unwrap();
    let choose =
        |series_key: &str| VolumeChoice { series: Some(series_key.to_owned()), ..VolumeChoice::default() };
    assert!(load_with(series.path(), choose("0")).unwrap().remarks().is_empty());
    assert!(load_with(series.path(), choose("1")).unwrap().remarks()[0].contains("b3.png"));
}
