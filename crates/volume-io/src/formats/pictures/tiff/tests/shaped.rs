//! Tests of files that give the shape of their arrays, as tifffile writes them.

use super::writer::{LITTLE, LONG, SHORT, TiffLeaf};
use super::{assert_refused, load_bytes, load_chosen};
use crate::formats::pictures::tiff::file::page::tag;
use chiaroscuro_volume::{LoadErrorKind, Volume, VolumeChoice};

/// Creates pages of 2 x 1 pixels whose value is their number, the first with a description.
fn array(json: &str, numbers: std::ops::Range<u8>) -> Vec<TiffLeaf> {
    let mut pages: Vec<TiffLeaf> = numbers.map(|number| LITTLE.leaf([2, 1], 8, &[number, number])).collect();
    if let Some(first) = pages.first_mut() {
        *first = first.clone().with_text(tag::DESCRIPTION, json);
    }
    pages
}

fn file(json: &str, count: u8) -> Vec<u8> {
    LITTLE.file(&array(json, 0..count))
}

fn firsts(volume: &Volume) -> Vec<f64> {
    (0..volume.dims()[2]).map(|z| volume.value(0, 0, z)).collect()
}

fn channel(channel: usize) -> VolumeChoice {
    VolumeChoice { channel: Some(channel), ..VolumeChoice::default() }
}

fn frame(frame: usize) -> VolumeChoice {
    VolumeChoice { frame: Some(frame), ..VolumeChoice::default() }
}

fn series(series: usize) -> VolumeChoice {
    VolumeChoice { series: Some(series.to_string()), ..VolumeChoice::default() }
}

#[test]
fn axes_are_channels_times_and_slices() {
    for (json, choice, words, expected) in [
        ("\"axes\": \"CZYX\", \"shape\": [2, 3, 1, 2]", channel(1), "2 channels", [3.0, 4.0, 5.0]),
        ("\"axes\": \"ZCYX\", \"shape\": [3, 2, 1, 2]", channel(1), "2 channels", [1.0, 3.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2], \"axes\": \"TZYX\"", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2], \"axes\": \"tzyx\"", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 1, 3, 1, 2], \"axes\": \"TCZYX\"", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2], \"axes\": \"RZYX\"", series(1), "2 series", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2]", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2, 1]", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
        ("\"shape\": [2, 3, 1, 2], \"axes\": \"CZ\"", frame(1), "2 time steps", [3.0, 4.0, 5.0]),
    ] {
        let bytes = file(&format!("{{{json}}}"), 6);
        assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &[words]);
        let volume = load_chosen(&bytes, choice).unwrap();
        assert_eq!(firsts(&volume), expected, "{json}");
        let is_assumed = volume.remarks().iter().any(|remark| remark.contains("the axes of its pages"));
        assert_eq!(is_assumed, !json.contains("axes") || json.contains("\"CZ\""), "{json}");
    }
    let bytes = file("shape=(2, 3, 1, 2)", 6);
    assert_eq!(firsts(&load_chosen(&bytes, frame(1)).unwrap()), [3.0, 4.0, 5.0]);
    // Five axes, with and without letters.
    for (axes, both) in [("\"axes\": \"TCZYX\", ", true), ("", false)] {
        let bytes = file(&format!("{{{axes}\"shape\": [2, 2, 3, 1, 2]}}"), 12);
        let choice = VolumeChoice { frame: Some(1), ..channel(0) };
        assert_eq!(firsts(&load_chosen(&bytes, choice).unwrap()), [6.0, 7.0, 8.0], "{both}");
    }
}

#[test]
fn one_axis_of_pages_is_one_of_slices_unless_it_is_called_otherwise() {
    for axes in ["", ", \"axes\": \"ZYX\"", ", \"axes\": \"QYX\"", ", \"axes\": \"AYX\""] {
        let volume = load_bytes(&file(&format!("{{\"shape\": [3, 1, 2]{axes}}}"), 3)).unwrap();
        assert_eq!((firsts(&volume), volume.remarks().len()), (vec![0.0, 1.0, 2.0], 0), "{axes}");
    }
    let times = load_bytes(&file("{\"shape\": [3, 1, 2], \"axes\": \"TYX\"}", 3)).unwrap();
    assert_eq!(firsts(&times), [0.0, 1.0, 2.0], "one slice over time is a volume");
    let channels =
        file("{\"shape\": [3, 1, 2], \"axes\": \"CYX\", \"Channel\": {\"Name\": [\"a\", \"b\", \"c\"]}}", 3);
    assert_refused(load_bytes(&channels), LoadErrorKind::BadInput, &["0 \"a\" (2 x 1 x 1)", "2 \"c\""]);
    assert_eq!(firsts(&load_chosen(&channels, channel(2)).unwrap()), [2.0]);
}

#[test]
fn colours_and_samples_are_parts_of_pages() {
    let color = |json: &str| {
        let page = |number: u8| {
            let leaf = LITTLE.leaf([2, 1], 8, &[number, 0, 0, number, 0, 0]);
            let leaf = leaf.with(tag::BITS, SHORT, &[8; 3]).with(tag::PHOTOMETRIC, SHORT, &[2]);
            leaf.with(tag::SAMPLES, SHORT, &[3])
        };
        let first = page(0).with_text(tag::DESCRIPTION, json);
        LITTLE.file(&[first, page(10), page(20), page(30)])
    };
    let bytes = color("{\"shape\": [2, 2, 1, 2, 3], \"axes\": \"TZYXS\"}");
    let volume = load_chosen(&bytes, VolumeChoice { component: Some(0), ..frame(1) }).unwrap();
    assert_eq!(firsts(&volume), [20.0, 30.0]);
    // Channels of several detectors in separate planes.
    let planes = |number: u8| {
        let leaf = LITTLE.leaf([2, 1], 8, &[]).with(tag::SAMPLES, SHORT, &[2]).with(tag::PLANAR, SHORT, &[2]);
        leaf.with(tag::BITS, SHORT, &[8, 8]).with_parts(vec![vec![number; 2], vec![number + 5; 2]])
    };
    let first = planes(0).with_text(tag::DESCRIPTION, "{\"shape\": [2, 2, 1, 2], \"axes\": \"ZCYX\"}");
    let bytes = LITTLE.file(&[first, planes(10)]);
    assert_refused(load_bytes(&bytes), LoadErrorKind::BadInput, &["2 channels"]);
    assert_eq!(firsts(&load_chosen(&bytes, channel(1)).unwrap()), [5.0, 15.0]);
}

#[test]
fn several_arrays_are_series() {
    let first = array("{\"shape\": [3, 1, 2], \"name\": \"cells\"}", 0..3);
    let second = array("{\"shape\": [2, 2, 1, 2], \"axes\": \"CZYX\"}", 10..14);
    let bytes = LITTLE.file(&[first, second].concat());
    assert_refused(
        load_bytes(&bytes),
        LoadErrorKind::BadInput,
        &["2 series", "0 \"cells\" (2 x 1 x 3)", "1 (2 x 1 x 2)"],
    );
    assert_eq!(firsts(&load_chosen(&bytes, series(0)).unwrap()), [0.0, 1.0, 2.0]);
    assert_refused(load_chosen(&bytes, series(1)), LoadErrorKind::BadInput, &["2 channels"]);
    let choice = VolumeChoice { channel: Some(1), ..series(1) };
    assert_eq!(firsts(&load_chosen(&bytes, choice).unwrap()), [12.0, 13.0]);
    // Pages that were written one by one are slices, as without descriptions.
    let single = |number: u8| array("{\"shape\": [1, 2]}", number..number + 1);
    let volume = load_bytes(&LITTLE.file(&[single(0), single(1), single(2)].concat())).unwrap();
    assert_eq!((firsts(&volume), volume.remarks().len()), (vec![0.0, 1.0, 2.0], 0));
}

#[test]
fn words_of_the_user_may_come_first_and_lengths_are_understood() {
    let json = "{\"shape\": [2, 1, 2], \"axes\": \"ZYX\", \"spacing\": 2.0, \"unit\": \"um\"}";
    let mut pages = array(json, 0..2);
    pages[0] = pages[0]
        .clone()
        .with_second_text(tag::DESCRIPTION, "words of a user")
        .with_rational(tag::X_RESOLUTION, 2, 1)
        .with_rational(tag::Y_RESOLUTION, 4, 1);
    let volume = load_bytes(&LITTLE.file(&pages)).unwrap();
    assert!((volume.spacing_mm() - glam::DVec3::new(0.5e-3, 0.25e-3, 2e-3)).length() < 1e-12);
    assert!(!volume.has_unknown_scale());
}

#[test]
fn one_page_may_stand_for_all() {
    let bytes: Vec<u8> = (0..12).flat_map(|number| [number, number]).collect();
    let leaf = LITTLE.leaf([2, 1], 8, &bytes).with(tag::STRIP_COUNTS, LONG, &[2]);
    let json = "{\"shape\": [2, 6, 1, 2], \"axes\": \"CZYX\", \"truncated\": true}";
    let file = LITTLE.file(&[leaf.clone().with_text(tag::DESCRIPTION, json)]);
    assert_eq!(firsts(&load_chosen(&file, channel(1)).unwrap()), [6.0, 7.0, 8.0, 9.0, 10.0, 11.0]);
    let long = json.replace("[2, 6", "[2, 60000");
    let file = LITTLE.file(&[leaf.with_text(tag::DESCRIPTION, &long)]);
    assert_refused(load_chosen(&file, channel(1)), LoadErrorKind::BadInput, &["truncated", "120000 slices"]);
}

#[test]
fn recordings_that_stopped_and_shapes_that_lie() {
    let stopped = file("{\"shape\": [2, 4, 1, 2], \"axes\": \"TZYX\"}", 6);
    let second = load_chosen(&stopped, frame(1)).unwrap();
    assert_eq!(firsts(&second), [4.0, 5.0]);
    assert!(
        second.remarks().join("; ").contains("4 slices are announced, and there are pages for the first 2")
    );
    let early = file("{\"shape\": [2, 4, 1, 2], \"axes\": \"TZYX\"}", 3);
    let first = load_bytes(&early).unwrap();
    assert_eq!(firsts(&first), [0.0, 1.0, 2.0]);
    let remarks = first.remarks().join("; ");
    assert!(remarks.contains("2 time steps are announced, and there are pages for the first 1"), "{remarks}");
    let late = load_chosen(&early, frame(1));
    assert_refused(late, LoadErrorKind::BadInput, &["\"1\" is not one of its 1 time steps"]);
    let none = load_chosen(&file("{\"shape\": [2, 4, 1, 2], \"axes\": \"RZYX\"}", 3), series(1));
    assert_refused(none, LoadErrorKind::BadInput, &["8 pages are announced, and 3 exist"]);
    // A shape that the pages do not match is ignored: pages are slices.
    for shape in
        ["[3, 2, 3]", "[0, 1, 2]", "[3, 1, 3]", "[2]", "[18446744073709551615, 18446744073709551615, 1, 2]"]
    {
        let volume = load_bytes(&file(&format!("{{\"shape\": {shape}}}"), 3)).unwrap();
        assert_eq!(firsts(&volume), [0.0, 1.0, 2.0], "{shape}");
    }
    let swapped = load_bytes(&file("{\"shape\": [3, 1, 2], \"axes\": \"ZXC\"}", 3)).unwrap();
    assert_eq!(firsts(&swapped), [0.0, 1.0, 2.0], "a page of other axes");
    let many = file("{\"shape\": [300, 300, 2, 1, 2], \"axes\": \"RMZYX\"}", 2);
    assert_refused(load_bytes(&many), LoadErrorKind::Limit, &["90000 series"]);
}
