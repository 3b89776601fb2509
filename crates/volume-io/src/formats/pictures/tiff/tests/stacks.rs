//! Tests of pages that are slices: without metadata, and with that of microscope software.

use super::writer::{LITTLE, LONG, SHORT, TiffLeaf};
use super::{assert_refused, load_bytes, load_chosen};
use crate::Endian;
use crate::formats::pictures::tiff::file::page::tag;
use crate::formats::pictures::tiff::metadata::imagej_channels::tests::entries;
use crate::formats::pictures::tiff::metadata::lsm_channels;
use chiaroscuro_volume::{LoadErrorKind, Modality, Samples, Volume, VolumeChoice};

fn page(value: u8) -> TiffLeaf {
    LITTLE.leaf([2, 1], 8, &[value, value + 1])
}

fn pages(count: u8) -> Vec<TiffLeaf> {
    (0..count).map(|at| page(at * 10)).collect()
}

fn described(mut pages: Vec<TiffLeaf>, description: &str) -> Vec<u8> {
    if let Some(first) = pages.first_mut() {
        let first_page = first.clone().with_text(tag::DESCRIPTION, description);
        *first = first_page.with_rational(tag::X_RESOLUTION, 2, 1).with_rational(tag::Y_RESOLUTION, 4, 1);
    }
    LITTLE.file(&pages)
}

/// First pixel of each slice.
fn firsts(volume: &Volume) -> Vec<f64> {
    (0..volume.dims()[2]).map(|z| volume.value(0, 0, z)).collect()
}

#[test]
fn plain_pages_are_slices_and_others_are_left_out() {
    let thumbnail = LITTLE.leaf([1, 1], 8, &[99]).with(tag::NEW_SUBFILE_TYPE, LONG, &[1]);
    let other = LITTLE.leaf([1, 1], 8, &[99]);
    let mut leaves = pages(3);
    leaves.insert(0, thumbnail);
    leaves.insert(2, other);
    let volume = load_bytes(&LITTLE.file(&leaves)).unwrap();
    assert_eq!(firsts(&volume), [0.0, 10.0, 20.0]);
    assert!(volume.has_unknown_scale());
    let remarks = volume.remarks().join("; ");
    assert!(remarks.contains("1 of 5 pages are left out: they are masks or smaller"), "{remarks}");
    assert!(remarks.contains("1 of 5 pages are left out: their size"), "{remarks}");
}

#[test]
fn resolutions_of_scanners_are_no_distances_of_voxels() {
    let mut leaves = pages(2);
    leaves[0] = page(0).with_rational(tag::X_RESOLUTION, 300, 1).with(296, SHORT, &[2]);
    assert!(load_bytes(&LITTLE.file(&leaves)).unwrap().has_unknown_scale());
}

#[test]
fn hyperstacks_have_channels_slices_and_times() {
    let file = described(
        pages(12),
        "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\nframes=2\nunit=\\u00B5m\nspacing=1.5\n",
    );
    assert_refused(load_bytes(&file), LoadErrorKind::BadInput, &["2 channels", "--channel"]);
    let channel = VolumeChoice { channel: Some(1), ..VolumeChoice::default() };
    assert_refused(
        load_chosen(&file, channel.clone()),
        LoadErrorKind::BadInput,
        &["2 time steps", "--frame"],
    );
    let volume = load_chosen(&file, VolumeChoice { frame: Some(1), ..channel }).unwrap();
    assert_eq!(firsts(&volume), [70.0, 90.0, 110.0]);
    assert!((volume.spacing_mm() - glam::DVec3::new(0.5e-3, 0.25e-3, 1.5e-3)).length() < 1e-12);
    assert!(!volume.has_unknown_scale() && !volume.is_anatomical());
}

#[test]
fn channels_are_called_as_imagej_calls_their_slices() {
    let described = "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n";
    for labels in [&["DAPI", "GFP"][..], &["c:1/2 z:1/2 - DAPI", "c:2/2 z:1/2 - GFP", "DAPI", "GFP"]] {
        let (counts, content) = entries("", labels, Endian::Little);
        let mut leaves = pages(4);
        leaves[0] = page(0)
            .with_text(tag::DESCRIPTION, described)
            .with(tag::IMAGEJ_COUNTS, LONG, &counts)
            .with_bytes(tag::IMAGEJ_CONTENT, &content);
        let refused = load_bytes(&LITTLE.file(&leaves));
        assert_refused(refused, LoadErrorKind::BadInput, &["0 \"DAPI\" (2 x 1 x 2)", "1 \"GFP\""]);
    }
}

#[test]
fn slices_are_not_assumed_to_be_far_thicker_than_pixels_are_wide() {
    // Pixels per micrometre, and the distance of slices that is taken.
    for (resolution, said, taken) in [
        (2, "", 1.0),
        (10, "", 1.0),
        (15, "", 1.0 / 15.0),
        (15, "spacing=1\n", 1.0),
        (40, "spacing=0.3\n", 0.3),
    ] {
        let mut leaves = pages(2);
        leaves[0] = page(0)
            .with_rational(tag::X_RESOLUTION, resolution, 1)
            .with_rational(tag::Y_RESOLUTION, resolution, 1)
            .with_text(tag::DESCRIPTION, &format!("ImageJ=1.53t\nimages=2\nslices=2\nunit=um\n{said}"));
        let volume = load_bytes(&LITTLE.file(&leaves)).unwrap();
        let found = volume.spacing_mm().z / 1e-3;
        assert!((found - taken).abs() < 1e-9, "{resolution} {said:?}: {found}");
        assert_eq!(volume.remarks().is_empty(), !said.is_empty(), "{:?}", volume.remarks());
    }
}

#[test]
fn imagej_defaults_apply() {
    let of = |lines: &str| {
        load_bytes(&described(pages(2), &format!("ImageJ=1.53t\nimages=2\nslices=2\n{lines}"))).unwrap()
    };
    let volume = of("unit=micron\n");
    assert!((volume.spacing_mm().z - 1e-3).abs() < 1e-15 && volume.remarks()[0].contains("ImageJ"));
    // The pages have 2 pixels per unit along x, and 4 along y.
    let print = of("unit=inch\n");
    assert_eq!(print.spacing_mm(), glam::DVec3::new(1.0, 0.5, 1.0), "of unknown size");
    assert!(print.has_unknown_scale() && print.remarks()[0].contains("prints"), "{:?}", print.remarks());
    let stated = of("unit=inch\nspacing=0.5\n");
    assert!((stated.spacing_mm() - 25.4 * glam::DVec3::new(0.5, 0.25, 0.5)).length() < 1e-9);
    assert!(stated.remarks().is_empty() && !stated.has_unknown_scale());
    let pixels = of("unit=pixel\nspacing=3\n");
    assert!(pixels.has_unknown_scale() && pixels.spacing_mm().z == 3.0, "longer, nobody knows of what");
    assert!(of("").has_unknown_scale());
    let signed = of("cf=0\nc0=-5\nc1=2\nvunit=Gray Value\nmin=1\nmax=11\n");
    assert_eq!(*signed.samples(), Samples::I16(vec![-5, -3, 15, 17]));
    assert_eq!((signed.metadata().window, signed.metadata().unit()), (Some([-3.0, 17.0]), None));
    assert_eq!(of("cf=0\nc0=0\nc1=1\nvunit=HU\n").metadata().unit(), Some("HU"));
    // Counts that do not match the pages are ignored.
    let volume = load_bytes(&described(pages(3), "ImageJ=1\nimages=99\nslices=50\nchannels=2\n")).unwrap();
    assert!(volume.dims()[2] == 3 && volume.remarks()[0].contains("50 slices"));
}

#[test]
fn more_channels_than_are_shown_together_are_slices() {
    let file = described(pages(8), "ImageJ=1.11a\nimages=8\nchannels=8\n");
    let volume = load_bytes(&file).unwrap();
    assert!(volume.dims()[2] == 8 && volume.remarks()[0].contains("8 channels"));
    let one = load_chosen(&file, VolumeChoice { channel: Some(3), ..VolumeChoice::default() }).unwrap();
    assert_eq!(firsts(&one), [30.0]);
    let seven = load_bytes(&described(pages(7), "ImageJ=1.11a\nimages=7\nchannels=7\n"));
    assert_refused(seven, LoadErrorKind::BadInput, &["7 channels"]);
}

#[test]
fn slices_may_follow_a_single_page() {
    let bytes: Vec<u8> = (0..6).collect();
    let leaf = LITTLE.leaf([2, 1], 8, &bytes).with(tag::STRIP_COUNTS, LONG, &[2]);
    let volume = load_bytes(&described(vec![leaf.clone()], "ImageJ=1.53t\nimages=3\nslices=3\n")).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(bytes));
    let long = load_bytes(&described(vec![leaf], "ImageJ=1.53t\nimages=300000\nslices=300000\n"));
    assert_refused(long, LoadErrorKind::BadInput, &["truncated", "300000 slices"]);
}

#[test]
fn times_of_one_slice_are_a_volume() {
    let file = described(pages(3), "ImageJ=1.53t\nimages=3\nframes=3\nunit=um\n");
    let volume = load_bytes(&file).unwrap();
    assert_eq!(firsts(&volume), [0.0, 10.0, 20.0]);
    assert!(volume.has_unknown_scale() && volume.remarks().iter().any(|remark| remark.contains("time")));
    let one = load_chosen(&file, VolumeChoice { frame: Some(2), ..VolumeChoice::default() }).unwrap();
    assert_eq!(firsts(&one), [20.0]);
}

#[test]
fn laser_scanning_microscopes_say_their_sizes() {
    let mut info = vec![0; 128];
    for (at, number) in [(0, 0x0040_0494u32), (8, 2), (12, 1), (16, 2), (20, 2), (24, 1)] {
        info[at..at + 4].copy_from_slice(&number.to_le_bytes());
    }
    for (at, metres) in [(40, 1e-7f64), (48, 2e-7), (56, 5e-7)] {
        info[at..at + 8].copy_from_slice(&metres.to_le_bytes());
    }
    let slice = |value: u8| {
        let leaf = LITTLE.leaf([2, 1], 8, &[]).with(tag::SAMPLES, SHORT, &[2]).with(tag::PLANAR, SHORT, &[2]);
        let leaf = leaf.with(tag::BITS, SHORT, &[8, 8]).with(tag::PHOTOMETRIC, SHORT, &[2]);
        leaf.with_parts(vec![vec![value, value], vec![value + 5, value + 5]])
    };
    let thumbnail = || LITTLE.leaf([1, 1], 8, &[99]).with(tag::NEW_SUBFILE_TYPE, LONG, &[1]);
    let write = |info: &[u8]| {
        let first = slice(0).with_bytes(tag::LSM_INFO, info);
        LITTLE.file(&[first, thumbnail(), slice(10), thumbnail()])
    };
    let file = write(&info);
    assert_refused(
        load_bytes(&file),
        LoadErrorKind::BadInput,
        &["2 channels", "0 (2 x 1 x 2), 1 (2 x 1 x 2)"],
    );
    let volume = load_chosen(&file, VolumeChoice { channel: Some(1), ..VolumeChoice::default() }).unwrap();
    assert_eq!((firsts(&volume), volume.remarks().len()), (vec![5.0, 15.0], 0));
    assert!((volume.spacing_mm() - glam::DVec3::new(1e-4, 2e-4, 5e-4)).length() < 1e-12);
    assert_eq!(volume.metadata().modality, Modality::LightMicroscopy);
    // Names of the channels are behind the pages, and the entry has their offset.
    info[108..112].copy_from_slice(&(file.len() as u32).to_le_bytes());
    let named = [write(&info), lsm_channels::tests::block(&[b"DAPI", b"Ch2-T1"])].concat();
    let words = ["0 \"DAPI\" (2 x 1 x 2)", "1 \"Ch2-T1\""];
    assert_refused(load_bytes(&named), LoadErrorKind::BadInput, &words);
    let truncated = &named[..file.len() + 10];
    assert_refused(load_bytes(truncated), LoadErrorKind::BadInput, &["0 (2 x 1 x 2)"]);
}
