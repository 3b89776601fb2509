//! Tests of FITS files: types, scales, several units and axes.

mod broken;
mod spacing;
mod writer;

use super::*;
use crate::tests::helpers::{assert_refused, gzip, load_bytes, load_path};
use chiaroscuro_volume::{MissingVoxels, Samples, VolumeChoice};
use writer::TestUnit;

/// An image of 3 x 2 pixels of 16 bits, the lower row first.
fn picture() -> TestUnit {
    TestUnit::primary(16, &[3, 2], [1i16, 2, 3, 4, 5, 6].map(i16::to_be_bytes).concat())
}

fn loaded(unit: &TestUnit) -> Volume {
    load_bytes("a.fits", &unit.bytes(), VolumeChoice::default()).unwrap()
}

#[test]
fn every_type_is_read_with_the_first_row_below() {
    // Two rows of two pixels: the second row is the upper one, and comes first.
    for (bits, data, expected) in [
        (8, vec![1, 2, 3, 255], Samples::U8(vec![3, 255, 1, 2])),
        (16, [1i16, -2, 300, 4].map(i16::to_be_bytes).concat(), Samples::I16(vec![300, 4, 1, -2])),
        (32, [1i32, -2, 70_000, 4].map(i32::to_be_bytes).concat(), Samples::I32(vec![70_000, 4, 1, -2])),
        (64, [1i64, -2, 70_000, 4].map(i64::to_be_bytes).concat(), Samples::I32(vec![70_000, 4, 1, -2])),
        (
            -32,
            [0.5f32, -2.0, 3.0, 4.0].map(f32::to_be_bytes).concat(),
            Samples::F32(vec![3.0, 4.0, 0.5, -2.0]),
        ),
        (
            -64,
            [0.5f64, -2.0, 3.0, 4.0].map(f64::to_be_bytes).concat(),
            Samples::F64(vec![3.0, 4.0, 0.5, -2.0]),
        ),
    ] {
        let unit = TestUnit::primary(bits, &[2, 2], data);
        let volume = loaded(&unit);
        assert_eq!((volume.samples(), volume.dims()), (&expected, [2, 2, 1]), "{bits} bits");
        assert!(volume.has_unknown_scale() && !volume.is_anatomical());
        // The first pixel stays the origin of the world, and rows go up.
        let place = volume.world_from_index().transform_point3(glam::DVec3::new(0.0, 1.0, 0.0));
        assert_eq!(place, glam::DVec3::ZERO);
        assert_eq!(volume.world_from_index().matrix3.y_axis, -glam::DVec3::Y);
        let packed = load_bytes("anything", &gzip(&unit.bytes()), VolumeChoice::default()).unwrap();
        assert_eq!(packed.samples(), &expected);
    }
}

#[test]
fn values_are_scaled_and_what_is_blank_is_missing() {
    let unsigned = picture().with("BZERO", 32768).with("BSCALE", "1.0");
    assert_eq!(*loaded(&unsigned).samples(), Samples::U16(vec![32772, 32773, 32774, 32769, 32770, 32771]));
    let real = picture().with("BSCALE", "0.5D0").with("BZERO", "1E1").with("BUNIT", "'Jy/beam '");
    let volume = loaded(&real);
    assert_eq!(*volume.samples(), Samples::F32(vec![12.0, 12.5, 13.0, 10.5, 11.0, 11.5]));
    assert_eq!(volume.metadata().unit(), Some("Jy/beam"));
    for scale in ["1.0", "2.0", "0.1"] {
        let blank = loaded(&picture().with("BLANK", 6).with("BSCALE", scale));
        assert_eq!(blank.missing().map(MissingVoxels::count), Some(1), "{scale}");
        assert!(blank.density_at([2, 0, 0]).is_none(), "the last pixel of the upper row");
        assert!(blank.value_range().high < 6.0 * scale.parse::<f64>().unwrap());
    }
    let nan = TestUnit::primary(-32, &[2, 2], [1.0, f32::NAN, 3.0, 4.0].map(f32::to_be_bytes).concat());
    assert_eq!(loaded(&nan).missing().map(MissingVoxels::count), Some(1));
    // Floating-point arrays have no BLANK.
    let real = TestUnit::primary(-32, &[2, 1], [1.0f32, 2.0].map(f32::to_be_bytes).concat()).with("BLANK", 1);
    assert_eq!(loaded(&real).missing(), None);
}

#[test]
fn three_axes_are_a_volume_and_a_fourth_are_several() {
    let cube = TestUnit::primary(8, &[3, 2, 2], (0..12).collect());
    assert_eq!(*loaded(&cube).samples(), Samples::U8(vec![3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8]));
    for axes in [vec![3, 2, 2, 1], vec![3, 2, 1, 2], vec![1, 3, 2, 2], vec![3, 1, 2, 1, 1, 2]] {
        assert_eq!(loaded(&TestUnit::primary(8, &axes, (0..12).collect())).dims(), [3, 2, 2], "{axes:?}");
    }
    let times = TestUnit::primary(8, &[3, 2, 1, 1, 2], (0..12).collect());
    assert_eq!(loaded(&times).dims(), [3, 2, 2], "of few axes that are longer than 1 all are shown");
    let times = TestUnit::primary(8, &[3, 1, 2, 2, 2], (0..24).collect());
    let Err(LoadError::Several { dimension, offers, .. }) =
        load_bytes("a.fits", &times.bytes(), VolumeChoice::default())
    else {
        panic!("there are two");
    };
    assert_eq!((dimension, offers.len()), (FileDimension::Frame, 2));
    let second = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    let volume = load_bytes("a.fits", &times.bytes(), second).unwrap();
    assert_eq!(*volume.samples(), Samples::U8(vec![15, 16, 17, 12, 13, 14, 21, 22, 23, 18, 19, 20]));
    // Polarisations are named channels.
    let stokes =
        times.with("CTYPE5", "'STOKES  '").with("CRVAL5", 1.0).with("CRPIX5", 1.0).with("CDELT5", 1.0);
    let Err(LoadError::Several { dimension: FileDimension::Channel, offers, .. }) =
        load_bytes("a.fits", &stokes.bytes(), VolumeChoice::default())
    else {
        panic!("there are two");
    };
    assert_eq!(offers.iter().map(|offer| offer.name.as_str()).collect::<Vec<_>>(), ["I", "Q"]);
}

#[test]
fn images_behind_an_empty_unit_are_offered() {
    let empty = TestUnit::primary(8, &[], Vec::new());
    let table = TestUnit::extension("BINTABLE", 8, &[7, 3], vec![9; 21]).with("EXTNAME", "'EVENTS'");
    let science = TestUnit::extension("IMAGE", 8, &[3, 2], (0..6).collect()).with("EXTNAME", "'SCI'");
    let error = TestUnit::extension("IMAGE", 16, &[3, 2], [7; 12].to_vec()).with("EXTNAME", "'ERR'");
    let one = [empty.bytes(), table.bytes(), science.bytes()].concat();
    let several = [one.clone(), error.bytes(), b"and more".to_vec()].concat();
    for bytes in [one.clone(), gzip(&one)] {
        let volume = load_bytes("m.fits", &bytes, VolumeChoice::default()).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(vec![3, 4, 5, 0, 1, 2]));
        assert_eq!(volume.name(), "m SCI");
    }
    for bytes in [several.clone(), gzip(&several)] {
        let Err(LoadError::Several { dimension: FileDimension::Array, offers, .. }) =
            load_bytes("m.fits", &bytes, VolumeChoice::default())
        else {
            panic!("there are two");
        };
        let found: Vec<_> = offers.iter().map(|offer| (offer.key.as_str(), offer.name.as_str())).collect();
        assert_eq!(found, [("2", "SCI"), ("3", "ERR")]);
        for named in ["3", "ERR"] {
            let choice = VolumeChoice { array: Some(named.to_owned()), ..VolumeChoice::default() };
            let volume = load_bytes("m.fits", &bytes, choice).unwrap();
            assert_eq!(*volume.samples(), Samples::I16(vec![0x0707; 6]));
        }
    }
}

#[test]
fn parts_of_a_file_are_counted_from_the_highest_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.fits");
    std::fs::write(&path, TestUnit::primary(8, &[4, 5, 2], (0..40).collect()).bytes()).unwrap();
    let part = |text: &str| {
        let portion = chiaroscuro_volume::Portion { region: text.parse().ok(), ..Default::default() };
        load_path(&path, VolumeChoice { portion: Some(portion), ..VolumeChoice::default() }).unwrap()
    };
    let rows = part(":,1:3,1:2");
    assert_eq!(
        *rows.samples(),
        Samples::U8(vec![32, 33, 34, 35, 28, 29, 30, 31]),
        "the upper of two rows first"
    );
    let whole = load_path(&path, VolumeChoice::default()).unwrap();
    let place =
        |volume: &Volume, y: f64| volume.world_from_index().transform_point3(glam::DVec3::new(0.0, y, 0.0));
    assert_eq!(place(&rows, 1.0), place(&whole, 2.0) + glam::DVec3::Z);
    let every = chiaroscuro_volume::Portion::with_stride(2);
    let thinned = load_path(&path, VolumeChoice { portion: Some(every), ..VolumeChoice::default() }).unwrap();
    assert_eq!(*thinned.samples(), Samples::U8(vec![16, 18, 8, 10, 0, 2]));
    assert_eq!(place(&thinned, 2.0), place(&whole, 4.0));
}
