//! Tests of Gaussian cubes: densities and orbitals, orthogonal and oblique, and headers with false sizes.

use std::io::Write as _;

use glam::DVec3;

use super::*;
use crate::tests::helpers::load_bytes as loaded_as;
use chiaroscuro_volume::{LoadErrorKind, VolumeChoice};

const WATER: &str = "Water\n density in atomic units\n 2 1.0 -2.0 3.0\n 2 0.5 0.0 0.0\n 3 0.0 0.5 0.0\n \
                     2 0.0 0.0 1.0\n 8 8.0 0.0 0.0 0.0\n 1 1.0 0.0 1.0 1.0\n";

fn loaded(text: &str) -> Result<Volume, LoadError> {
    loaded_as("a.cube", text.as_bytes(), VolumeChoice::default())
}

fn numbers(count: usize) -> String {
    let lines: Vec<String> =
        (0..count).map(|n| format!(" {n}.5E+00{}", if n % 6 == 5 { "\n" } else { "" })).collect();
    lines.concat()
}

#[test]
fn x_becomes_the_fastest() {
    let text = WATER.to_owned() + &numbers(12);
    let volume = loaded(&text).unwrap();
    assert_eq!(volume.dims(), [2, 3, 2]);
    for (x, y, z) in [(0, 0, 0), (1, 0, 0), (0, 2, 1), (1, 1, 0)] {
        assert_eq!(volume.value(x, y, z), (6 * x + 2 * y + z) as f64 + 0.5);
    }
    let bohr = 5.291_772_109_03e-8;
    assert!((volume.spacing_mm() / bohr - DVec3::new(0.5, 0.5, 1.0)).abs().max_element() < 1e-12);
    let origin = volume.world_from_index().translation / bohr;
    assert!((origin - DVec3::new(1.0, -2.0, 3.0)).abs().max_element() < 1e-12);
    assert!(!volume.is_anatomical() && !volume.has_unknown_scale() && volume.remarks().is_empty());
    assert_eq!(volume.metadata().acquisition(), Some("Water"));
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.replace('\n', "\r\n").as_bytes()).unwrap();
    let zipped = encoder.finish().unwrap();
    let unzipped = loaded_as("b.cube.gz", &zipped, VolumeChoice::default()).unwrap();
    assert_eq!(unzipped.samples(), volume.samples());
    let error = loaded_as("b.cube.gz", &zipped[..zipped.len() - 20], VolumeChoice::default()).unwrap_err();
    assert!(error.to_string().contains("truncated"), "{error}");
}

#[test]
fn grids_may_be_oblique_and_in_angstrom() {
    let header = "a\nb\n 0 0 0 0\n -1 1 0 0\n -2 0.5 1 0\n -1 0 0 2\n";
    let volume = loaded(&(header.to_owned() + "1.0D+00 -2.5-001")).unwrap();
    assert_eq!(*volume.samples(), Samples::F32(vec![1.0, -0.25]));
    let y = volume.world_from_index().matrix3.y_axis * 1e7;
    assert!((y - DVec3::new(0.5, 1.0, 0.0)).abs().max_element() < 1e-9, "{y}");
    let flat = loaded(&(header.replace("0.5 1 0", "2 0 0") + "1 2")).unwrap();
    assert!(!flat.remarks().is_empty());
}

#[test]
fn one_of_several_orbitals_is_chosen() {
    let orbitals = WATER.replace("\n 2 1.0 -2.0", "\n -2 1.0 -2.0") + " 2 17\n 18\n" + &numbers(24);
    let LoadError::Several { dimension: FileDimension::Channel, offers, .. } = loaded(&orbitals).unwrap_err()
    else {
        panic!("there are two");
    };
    assert_eq!(offers[1].name, "orbital 18");
    let choice = VolumeChoice { channel: Some(1), ..VolumeChoice::default() };
    let second = loaded_as("a.cub", orbitals.as_bytes(), choice.clone()).unwrap();
    assert_eq!((second.value(0, 0, 0), second.value(0, 0, 1), second.value(1, 0, 0)), (1.5, 3.5, 13.5));
    let values = WATER.replace(" 3.0\n", " 3.0 2\n") + &numbers(24);
    let second = loaded_as("a.cube", values.as_bytes(), choice).unwrap();
    assert_eq!(second.value(0, 0, 1), 3.5);
}

#[test]
fn inconsistent_headers_are_refused() {
    for (text, kind, words) in [
        (String::new(), LoadErrorKind::BadInput, "ends within its header"),
        (WATER.to_owned() + &numbers(11), LoadErrorKind::BadInput, "12 numbers expected, 11 found"),
        (WATER.to_owned(), LoadErrorKind::BadInput, "truncated"),
        (WATER.to_owned() + " nothing" + &numbers(11), LoadErrorKind::BadInput, "\"nothing\""),
        (WATER.replace(" 3 0.0", " 300000 0.0"), LoadErrorKind::Limit, "allowed"),
        (WATER.replace(" 3 0.0", " 30000 0.0"), LoadErrorKind::BadInput, "numbers expected, at most"),
        (WATER.replace(" 3 0.0", " 0 0.0"), LoadErrorKind::BadInput, "empty"),
        (WATER.replace(" 3 0.0", " x 0.0"), LoadErrorKind::BadInput, "line 5"),
        (WATER.replace("\n 2 1.0", "\n 2000000000 1.0"), LoadErrorKind::Limit, "atoms"),
        (WATER.replace("\n 2 1.0", "\n 99 1.0"), LoadErrorKind::BadInput, "ends within its header"),
        (WATER.replace("\n 2 1.0", "\n -9223372036854775808 1.0"), LoadErrorKind::Limit, "atoms"),
        (WATER.replace("\n 2 1.0", "\n -2 1.0") + " -3", LoadErrorKind::BadInput, "orbitals"),
        (WATER.replace("\n 2 1.0", "\n TITLE"), LoadErrorKind::BadInput, "line 3"),
        ("x".repeat(10_000), LoadErrorKind::BadInput, "short line"),
    ] {
        let error = loaded(&text).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
}
