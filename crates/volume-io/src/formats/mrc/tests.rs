//! Tests of MRC files built in memory: every mode and byte order, cells, stacks, and invalid headers.

use glam::DVec3;

use super::*;
use crate::tests::helpers::{gzip, load_bytes};
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

/// Builder of an MRC file, word by word.
#[derive(Clone)]
struct MrcBuilder {
    words: Vec<[u8; 4]>,
    is_big: bool,
    data: Vec<u8>,
}

impl MrcBuilder {
    /// A file of 2 x 1 x 2 voxels of a mode, 2 Å apart.
    fn new(mode: i32, is_big: bool, data: Vec<u8>) -> Self {
        let mut made = Self { words: vec![[0; 4]; 256], is_big, data };
        for (at, value) in
            [(1, 2), (2, 1), (3, 2), (4, mode), (8, 2), (9, 1), (10, 2), (17, 1), (18, 2), (19, 3), (23, 1)]
        {
            made = made.int(at, value);
        }
        for (at, value) in [(11, 4.0), (12, 2.0), (13, 4.0), (14, 90.0), (15, 90.0), (16, 90.0)] {
            made = made.float(at, value);
        }
        made.words[52] = *b"MAP ";
        made.words[53] = if is_big { [0x11, 0x11, 0, 0] } else { [0x44, 0x44, 0, 0] };
        made
    }

    fn int(mut self, word: usize, value: i32) -> Self {
        self.words[word - 1] = if self.is_big { value.to_be_bytes() } else { value.to_le_bytes() };
        self
    }

    fn float(self, word: usize, value: f32) -> Self {
        self.int(word, value.to_bits() as i32)
    }

    fn text(mut self, word: usize, text: [u8; 4]) -> Self {
        self.words[word - 1] = text;
        self
    }

    fn bytes(&self) -> Vec<u8> {
        [self.words.concat(), self.data.clone()].concat()
    }

    fn loaded_with(&self, name: &str, choice: VolumeChoice) -> Result<Volume, LoadError> {
        load_bytes(name, &self.bytes(), choice)
    }

    fn loaded(&self) -> Volume {
        self.loaded_with("a.map", VolumeChoice::default()).unwrap()
    }
}

/// Bytes of real numbers, little-endian.
fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

#[test]
fn every_mode_and_byte_order_is_read() {
    for is_big in [false, true] {
        macro_rules! bytes {
            ($type:ty, $values:expr) => {
                $values.map(|v: $type| if is_big { v.to_be_bytes() } else { v.to_le_bytes() }).concat()
            };
        }
        let halves = [0.5f32, -2.0, 3.0, 4.0].map(|v| half::f16::from_f32(v).to_bits());
        for (mode, data, expected) in [
            (0, vec![1, 2, 3, 255], Samples::I8(vec![1, 2, 3, -1])),
            (1, bytes!(i16, [1, -2, 300, 4]), Samples::I16(vec![1, -2, 300, 4])),
            (2, bytes!(f32, [1.5, -2.0, 3.0, 4.0]), Samples::F32(vec![1.5, -2.0, 3.0, 4.0])),
            (3, bytes!(i16, [3, 4, 0, 1, 0, 0, 5, -12]), Samples::F32(vec![5.0, 1.0, 0.0, 13.0])),
            (
                4,
                bytes!(f32, [3.0, 4.0, 0.0, 1.0, 0.0, 0.0, 5.0, 12.0]),
                Samples::F32(vec![5.0, 1.0, 0.0, 13.0]),
            ),
            (6, bytes!(u16, [1, 2, 300, 65535]), Samples::U16(vec![1, 2, 300, 65535])),
            (12, bytes!(u16, halves), Samples::F32(vec![0.5, -2.0, 3.0, 4.0])),
            (16, vec![9, 9, 9, 0, 0, 0, 0, 255, 0, 1, 1, 1], Samples::U8(vec![9, 0, 182, 1])),
        ] {
            let made = MrcBuilder::new(mode, is_big, data);
            let volume = made.loaded();
            assert_eq!(*volume.samples(), expected, "mode {mode}, big {is_big}");
            assert_eq!(volume.dims(), [2, 1, 2]);
            let hints = volume.metadata();
            assert_eq!(hints.modality, Modality::ElectronMicroscopy);
            assert_eq!(hints.meaning == ValueMeaning::PositiveDensity, matches!(mode, 2 | 12), "{mode}");
            // Without a machine stamp, or with a wrong one, plausible dimensions decide.
            for stamp in [[0; 4], [0x44, 0x44, 0, 0], [0x11, 0x11, 0, 0]] {
                assert_eq!(*made.clone().text(54, stamp).loaded().samples(), expected, "{stamp:?}");
            }
        }
    }
}

#[test]
fn bytes_have_signs_where_something_says_so() {
    let made = MrcBuilder::new(0, false, vec![1, 2, 3, 255]);
    let signed = Samples::I8(vec![1, 2, 3, -1]);
    let unsigned = Samples::U8(vec![1, 2, 3, 255]);
    let of_imod = made.clone().text(39, *b"IMOD");
    for (made, expected) in [
        (made.clone(), &signed),
        (made.clone().float(21, 255.0), &unsigned),
        (made.clone().float(21, 255.0).int(28, 20140), &signed),
        (of_imod.clone(), &unsigned),
        (of_imod.clone().int(40, 1), &signed),
    ] {
        assert_eq!(made.loaded().samples(), expected);
    }
    assert_eq!(i32::from_le_bytes(*b"IMOD"), 1_146_047_817);
}

#[test]
fn cells_say_where_voxels_lie() {
    let made = MrcBuilder::new(2, false, floats(&[1.0, 2.0, 3.0, 4.0]));
    let volume = made.loaded();
    assert!((volume.spacing_mm() * 1e7 - DVec3::splat(2.0)).abs().max_element() < 1e-9);
    assert!(!volume.is_anatomical() && !volume.has_unknown_scale() && volume.remarks().is_empty());
    let place = |made: MrcBuilder| made.loaded().world_from_index();
    let near = |found: DVec3, x: f64, y: f64, z: f64| {
        assert!((found * 1e7 - DVec3::new(x, y, z)).abs().max_element() < 1e-6, "{found}");
    };
    near(place(made.clone().float(50, 5.0)).translation, 5.0, 0.0, 0.0);
    near(place(made.clone().float(50, 5.0).text(39, *b"IMOD").int(40, 4)).translation, -5.0, 0.0, 0.0);
    near(place(made.clone().int(5, -3).int(7, 1)).translation, -6.0, 0.0, 2.0);
    // Columns along z, rows along x, sections along y.
    let turned = place(made.clone().int(17, 3).int(18, 1).int(19, 2).int(5, 1));
    near(turned.matrix3.x_axis, 0.0, 0.0, 2.0);
    near(turned.matrix3.y_axis, 2.0, 0.0, 0.0);
    near(turned.matrix3.z_axis, 0.0, 2.0, 0.0);
    near(turned.translation, 0.0, 0.0, 2.0);
    let oblique = place(made.clone().float(15, 120.0).float(16, 60.0));
    near(oblique.matrix3.y_axis, 1.0, 3f64.sqrt(), 0.0);
    let z = oblique.matrix3.z_axis * 1e7;
    assert!((z.length() - 2.0).abs() < 1e-6 && (z.x + 1.0).abs() < 1e-6, "{z}");
}

#[test]
fn what_cannot_be_said_of_a_cell_is_mended() {
    let made = MrcBuilder::new(2, false, floats(&[1.0, 2.0, 3.0, 4.0]));
    let unsaid = made.clone().float(11, 0.0).float(12, 0.0).float(13, 0.0).loaded();
    assert!(unsaid.has_unknown_scale() && unsaid.remarks().is_empty());
    assert_eq!(unsaid.spacing_mm(), DVec3::ONE);
    let partly = made.clone().float(13, f32::NAN).loaded();
    assert!((partly.spacing_mm().z * 1e7 - 2.0).abs() < 1e-6 && partly.remarks().len() == 1);
    let order = made.clone().int(17, 1).int(18, 1).loaded();
    assert!(order.remarks()[0].contains("order"), "{:?}", order.remarks());
    let angles = made.clone().float(14, 1.0).float(15, 100.0).float(16, 170.0).loaded();
    assert_eq!(angles.world_from_index().matrix3.x_axis.y, 0.0);
    let stack = made.clone().int(23, 0).int(10, 1).loaded();
    assert!(stack.remarks()[0].contains("stack of images"));
    assert_eq!(stack.metadata().meaning, ValueMeaning::Unknown);
}

#[test]
fn headers_may_be_longer_and_hold_words_and_stacks() {
    let mut made =
        MrcBuilder::new(2, false, [vec![7; 12], floats(&[1.0, 2.0, 3.0, 4.0]), vec![0; 5]].concat());
    made = made.int(24, 12).text(57, *b"  Vi").text(58, *b"rus\0");
    let volume = made.loaded();
    assert_eq!(*volume.samples(), Samples::F32(vec![1.0, 2.0, 3.0, 4.0]));
    assert_eq!(volume.metadata().acquisition(), Some("Virus"));
    assert_eq!(volume.name(), "a");

    let stack = MrcBuilder::new(2, false, floats(&[1.0, 2.0, 3.0, 4.0])).int(23, 401).int(10, 1);
    let Err(LoadError::Several { dimension: FileDimension::Frame, offers, .. }) =
        stack.loaded_with("a.mrc", VolumeChoice::default())
    else {
        panic!("there are two");
    };
    assert_eq!((offers.len(), offers[1].dims), (2, Some([2, 1, 1])));
    let second = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    assert_eq!(*stack.loaded_with("a.mrc", second).unwrap().samples(), Samples::F32(vec![3.0, 4.0]));
    // Old files have no magic bytes: the name's ending decides.
    let old = stack.clone().int(23, 0).int(10, 2).text(53, [0; 4]);
    assert!(old.loaded_with("a.rec", VolumeChoice::default()).is_ok());
}

#[test]
fn compressed_files_are_read_and_checked() {
    let zipped = gzip(&MrcBuilder::new(2, false, floats(&[1.0, 2.0, 3.0, 4.0])).bytes());
    let loaded = |bytes: &[u8]| load_bytes("virus.map.gz", bytes, VolumeChoice::default());
    assert_eq!(loaded(&zipped).unwrap().name(), "virus");
    let error = loaded(&zipped[..zipped.len() - 12]).unwrap_err();
    assert!(error.to_string().contains("truncated"), "{error}");
}

#[test]
fn headers_that_lie_are_refused() {
    let made = MrcBuilder::new(2, false, floats(&[1.0, 2.0, 3.0, 4.0]));
    let component = VolumeChoice { component: Some(2), ..VolumeChoice::default() };
    for (made, choice, kind, words) in [
        (made.clone().int(1, 3), None, LoadErrorKind::BadInput, "24 bytes expected for 3 x 1 x 2"),
        (made.clone().int(1, 0), None, LoadErrorKind::BadInput, "0 x 1 x 2 are not valid dimensions"),
        (made.clone().int(2, -1), None, LoadErrorKind::BadInput, "-1"),
        (made.clone().int(2, i32::MAX), None, LoadErrorKind::Limit, "are allowed"),
        (made.clone().int(4, 5), None, LoadErrorKind::BadInput, "mode 5 is unknown"),
        (made.clone().int(4, 101), None, LoadErrorKind::BadInput, "4 bits"),
        (made.clone().int(24, -4), None, LoadErrorKind::BadInput, "NSYMBT"),
        (made.clone().int(24, i32::MAX), None, LoadErrorKind::BadInput, "truncated"),
        (
            made.clone().int(1, 1 << 25).text(54, [0; 4]).int(4, -1),
            None,
            LoadErrorKind::BadInput,
            "not that of an MRC file",
        ),
        (made.clone().int(3, 1 << 24).int(10, 1).int(23, 401), None, LoadErrorKind::Limit, "time steps"),
        (made.clone().int(4, 4), Some(component), LoadErrorKind::BadInput, "--component"),
    ] {
        let error = made.loaded_with("a.mrc", choice.unwrap_or_default()).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(words), "{words} is not in: {error}");
    }
    let short = MrcBuilder { words: vec![[0; 4]; 255], ..made };
    let error = short.loaded_with("a.mrc", VolumeChoice::default()).unwrap_err();
    assert!(
        error.to_string().contains("1024 bytes expected, 1036 found")
            || error.to_string().contains("not that of an MRC file")
    );
}

#[test]
fn bytes_behind_a_packed_map_are_passed_over_and_checksums_looked_at() {
    let made = MrcBuilder::new(0, false, vec![1, 2, 3, 4]);
    let packed = gzip(&made.bytes());
    let whole = made.loaded();
    for behind in [vec![0; 1024], vec![0xAA; 3]] {
        let volume =
            load_bytes("a.mrc.gz", &[&packed[..], &behind].concat(), VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), whole.samples());
    }
    let mut changed = packed.clone();
    let checksum = changed.len() - 8;
    changed[checksum] ^= 1;
    for broken in [&changed[..], &packed[..packed.len() - 3]] {
        let error = load_bytes("a.mrc.gz", broken, VolumeChoice::default()).unwrap_err();
        assert_eq!(error.kind(), LoadErrorKind::BadInput, "{error}");
    }
}
