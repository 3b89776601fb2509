//! Tests of MGH files built in memory: every type, placement, frames, colour tables, and invalid headers.

use glam::{DAffine3, DMat3, DVec3};

use super::*;
use crate::tests::helpers::{assert_refused, gzip, load_bytes};
use chiaroscuro_volume::{DataKind, FileLabel, LoadErrorKind, Samples, VolumeChoice};

/// Builder of an MGH file, field by field.
#[derive(Clone)]
struct MghFile {
    /// Version, width, height, depth, frames, type, degrees of freedom.
    ints: [i32; 7],
    is_placed: i16,
    /// Spacings, three axis directions, centre.
    place: [f32; 15],
    data: Vec<u8>,
    footer: Vec<u8>,
}

impl MghFile {
    /// A file of 2 x 3 x 2 voxels of a type, 1 x 2 x 3 mm apart, along right, anterior and superior.
    fn new(code: i32, data: Vec<u8>) -> Self {
        let place = [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 10.0, 20.0, 30.0];
        Self { ints: [1, 2, 3, 2, 1, code, 0], is_placed: 1, place, data, footer: Vec::new() }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes: Vec<u8> = self.ints.iter().flat_map(|int| int.to_be_bytes()).collect();
        bytes.extend(self.is_placed.to_be_bytes());
        bytes.extend(self.place.iter().flat_map(|float| float.to_be_bytes()));
        bytes.resize(HEADER_BYTES, 0);
        [bytes, self.data.clone(), self.footer.clone()].concat()
    }

    fn with_int(mut self, field: usize, value: i32) -> Self {
        self.ints[field] = value;
        self
    }

    fn loaded(&self) -> Volume {
        load_bytes("a.mgh", &self.bytes(), VolumeChoice::default()).unwrap()
    }
}

/// A file with the voxels 0 to 11 as bytes.
fn twelve() -> MghFile {
    MghFile::new(0, (0..12).collect())
}

/// Bytes of a colour table tag: with label numbers in its entries (version 2), or of the older version.
fn color_table(has_numbers: bool) -> Vec<u8> {
    let int = |value: i32| value.to_be_bytes().to_vec();
    let text = |text: &str| [int(text.len() as i32 + 1), text.as_bytes().to_vec(), vec![0]].concat();
    let entry = |number: i32, name: &str, color: [i32; 3]| {
        let number = if has_numbers { int(number) } else { Vec::new() };
        [number, text(name), color.map(i32::to_be_bytes).concat(), int(0)].concat()
    };
    let head = if has_numbers {
        [int(-2), int(18), text("LUT"), int(2)]
    } else {
        [int(2), text("LUT"), vec![], vec![]]
    };
    let entries = [
        entry(0, "Unknown", [0, 0, 0]),
        entry(if has_numbers { 17 } else { 1 }, "Left-Hippocampus", [220, 216, 20]),
    ];
    // Five acquisition parameters, a command line, the older transform tag, the table.
    let before = [
        vec![0; 20],
        int(3),
        5i64.to_be_bytes().to_vec(),
        b"recon".to_vec(),
        int(30),
        int(4),
        b"abc".to_vec(),
    ];
    [before.concat(), int(1), head.concat(), entries.concat()].concat()
}

#[test]
fn every_type_is_read() {
    let shorts = [0i16, -1, 300, i16::MAX, i16::MIN, 5, 6, 7, 8, 9, 10, 11];
    let ints = shorts.map(|value| i32::from(value) * 60_000);
    let floats = shorts.map(|value| f32::from(value) / 4.0);
    let unsigned = shorts.map(|value| value as u16);
    for (code, data, expected) in [
        (0, (0..12).collect::<Vec<u8>>(), Samples::U8((0..12).collect())),
        (1, ints.map(i32::to_be_bytes).concat(), Samples::I32(ints.to_vec())),
        (3, floats.map(f32::to_be_bytes).concat(), Samples::F32(floats.to_vec())),
        (4, shorts.map(i16::to_be_bytes).concat(), Samples::I16(shorts.to_vec())),
        (10, unsigned.map(u16::to_be_bytes).concat(), Samples::U16(unsigned.to_vec())),
    ] {
        let made = MghFile::new(code, data);
        assert_eq!((made.loaded().samples(), made.loaded().dims()), (&expected, [2, 3, 2]), "type {code}");
        // Detected by content, whatever the file name; gzipped or not.
        for name in ["scan", "scan.mgz", "scan.bin"] {
            for bytes in [made.bytes(), gzip(&made.bytes())] {
                let volume = load_bytes(name, &bytes, VolumeChoice::default()).unwrap();
                assert_eq!(volume.samples(), &expected, "{name}");
                assert_eq!(volume.name(), name.trim_end_matches(".mgz"));
            }
        }
    }
}

#[test]
fn voxels_lie_where_the_header_says() {
    let volume = twelve().loaded();
    // Index dims / 2 lies at `c_ras`.
    let expected = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
        translation: DVec3::new(10.0, 20.0, 30.0) - DVec3::new(1.0, 3.0, 3.0),
    };
    assert_eq!(volume.world_from_index(), expected);
    assert!(volume.is_anatomical() && !volume.has_unknown_scale() && volume.remarks().is_empty());
    // Orientation of volumes conformed by FreeSurfer: left, inferior, anterior.
    let mut made = twelve();
    made.place[3..12].copy_from_slice(&[-1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0]);
    let conformed = made.loaded();
    let axes = conformed.world_from_index().matrix3;
    assert_eq!([axes.x_axis, axes.y_axis], [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, -2.0)]);
    assert_eq!(conformed.world_from_index().translation, DVec3::new(11.0, 17.0, 33.0));
    made.is_placed = 0;
    made.place = [f32::NAN; 15];
    let unplaced = made.loaded();
    assert!(!unplaced.is_anatomical() && unplaced.has_unknown_scale());
    assert_eq!(unplaced.world_from_index().matrix3.z_axis, DVec3::Y, "coronal slices");
    assert!(unplaced.remarks()[0].contains("goodRASFlag"), "{:?}", unplaced.remarks());
    let mut flat = twelve();
    flat.place[6..9].copy_from_slice(&[1.0, 0.0, 0.0]);
    assert!(load_bytes("a.mgh", &flat.bytes(), VolumeChoice::default()).unwrap().remarks().len() == 1);
}

#[test]
fn volumes_behind_each_other_are_time_steps() {
    let made = MghFile::new(0, (0..24).collect()).with_int(4, 2);
    for bytes in [made.bytes(), gzip(&made.bytes())] {
        let Err(LoadError::Several { dimension: FileDimension::Frame, offers, .. }) =
            load_bytes("a.mgz", &bytes, VolumeChoice::default())
        else {
            panic!("there are two");
        };
        assert_eq!((offers.len(), offers[1].dims), (2, Some([2, 3, 2])));
        let second = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
        let volume = load_bytes("a.mgz", &bytes, second).unwrap();
        assert_eq!(*volume.samples(), Samples::U8((12..24).collect()));
    }
}

#[test]
fn labels_have_the_names_of_the_table_behind_them() {
    let numbers = [0i32, 17, 17, 0, 0, 0, 0, 17, 0, 0, 0, 0];
    let mut made = MghFile::new(1, numbers.map(i32::to_be_bytes).concat());
    made.footer = color_table(true);
    for bytes in [made.bytes(), gzip(&made.bytes())] {
        let volume = load_bytes("aseg.mgz", &bytes, VolumeChoice::default()).unwrap();
        let color = Some([220, 216, 20].map(|part: u8| f32::from(part) / 255.0));
        let expected = FileLabel { name: "Left-Hippocampus".to_owned(), color };
        assert_eq!(volume.metadata().labels.get(17), Some(&expected));
        assert!(matches!(volume.kind().kind, DataKind::LabelMap { .. }), "{:?}", volume.kind());
    }
    made.footer = color_table(false);
    assert_eq!(
        made.loaded().metadata().labels.get(1).map(|label| label.name.as_str()),
        Some("Left-Hippocampus")
    );
    // The intent code above the version marks labels, too.
    made.footer = Vec::new();
    let intended = made.clone().with_int(0, 0x101).loaded();
    assert_eq!((intended.metadata().meaning, intended.metadata().labels.len()), (ValueMeaning::Labels, 0));
    assert_eq!(made.loaded().metadata().meaning, ValueMeaning::Unknown);
    // A table behind real-valued measurements names nothing.
    let mut floats = MghFile::new(3, [0.5f32; 12].map(f32::to_be_bytes).concat());
    floats.footer = color_table(true);
    assert!(floats.loaded().metadata().labels.is_empty());
}

#[test]
fn what_follows_the_voxels_is_no_matter() {
    let table = color_table(true);
    let mut made = twelve();
    for cut in 0..table.len() {
        made.footer = table[..cut].to_vec();
        assert_eq!(*made.loaded().samples(), Samples::U8((0..12).collect()), "{cut} bytes");
    }
    for lie in [i32::MAX, -1, i32::MIN, 0] {
        // Impossible lengths and counts: of a tag, of a name, of entries.
        for at in [24, 28, table.len() - 4, 48, 52, 56] {
            made.footer = table.clone();
            made.footer[at..at + 4].copy_from_slice(&lie.to_be_bytes());
            assert_eq!(made.loaded().dims(), [2, 3, 2], "{lie} at {at}");
        }
    }
}

#[test]
fn every_cut_is_refused() {
    let mut made = twelve();
    made.footer = color_table(true);
    let whole = made.bytes();
    for cut in 0..HEADER_BYTES + 12 {
        assert_refused(
            load_bytes("a.mgh", &whole[..cut], VolumeChoice::default()),
            LoadErrorKind::BadInput,
            &["a.mgh", "truncated"],
        );
    }
    let packed = gzip(&whole);
    for cut in 11..packed.len() - 1 {
        let error = load_bytes("a.mgz", &packed[..cut], VolumeChoice::default()).unwrap_err();
        assert_eq!(error.kind(), LoadErrorKind::BadInput, "{cut}: {error}");
    }
}

#[test]
fn headers_that_lie_are_refused() {
    for (made, kind, words) in [
        (twelve().with_int(0, 2), LoadErrorKind::BadInput, "version"),
        (twelve().with_int(0, -255), LoadErrorKind::BadInput, "version"),
        (twelve().with_int(1, 0), LoadErrorKind::BadInput, "0 x 3 x 2 voxels"),
        (twelve().with_int(2, -1), LoadErrorKind::BadInput, "-1"),
        (twelve().with_int(3, i32::MAX), LoadErrorKind::Limit, "are allowed"),
        (
            twelve().with_int(1, i32::MAX).with_int(2, i32::MAX).with_int(3, i32::MAX),
            LoadErrorKind::Limit,
            "are allowed",
        ),
        (twelve().with_int(3, 3), LoadErrorKind::BadInput, "truncated"),
        (twelve().with_int(4, 0), LoadErrorKind::BadInput, "0 frames"),
        (twelve().with_int(4, i32::MAX), LoadErrorKind::Limit, "time steps"),
        (twelve().with_int(5, 2), LoadErrorKind::BadInput, "mri_convert"),
        (twelve().with_int(5, 9), LoadErrorKind::BadInput, "colours"),
        (twelve().with_int(5, 77), LoadErrorKind::BadInput, "type 77 is unknown"),
        (twelve().with_int(1, 12).with_int(2, 1).with_int(3, 1), LoadErrorKind::BadInput, "surface"),
    ] {
        assert_refused(load_bytes("a.mgz", &made.bytes(), VolumeChoice::default()), kind, &[words]);
    }
}

#[test]
fn other_bytes_are_not_taken_for_it() {
    let made = twelve();
    assert!(is_mgh(&made.bytes()));
    for other in [
        made.clone().with_int(0, 2),
        made.clone().with_int(0, 0x1001),
        made.clone().with_int(1, 0),
        made.clone().with_int(4, -1),
        made.clone().with_int(5, 7),
        MghFile { is_placed: 7, ..made.clone() },
        MghFile { place: [0.0; 15], ..made.clone() },
    ] {
        assert!(!is_mgh(&other.bytes()));
    }
    assert!(!is_mgh(&made.bytes()[..HEADER_BYTES - 1]) && !is_mgh(&[0; 1024]));
}
