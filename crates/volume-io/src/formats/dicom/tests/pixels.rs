//! Tests of pixels: types, byte orders, bits, colours, and value hints.

use super::*;
use chiaroscuro_volume::{Modality, ValueMeaning};

#[test]
fn every_way_of_writing_gives_the_same() {
    for syntax in [IMPLICIT, EXPLICIT, DEFLATED, BIG] {
        let volume = DicomFileBuilder::new(syntax).load().unwrap();
        assert_eq!(volume.dims(), [3, 2, 1], "{syntax}");
        assert_eq!(volume.samples(), &Samples::U16(vec![10, 20, 30, 40, 50, 60]), "{syntax}");
        // Columns are 0.25 mm apart, rows 0.5; x and y are inverted.
        let expected = [-0.25, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 2.5, -1.0, -2.0, 3.0];
        assert_eq!(affine_columns(&volume), expected, "{syntax}");
        assert!(volume.is_anatomical() && volume.remarks().is_empty(), "{:?}", volume.remarks());
    }
}

#[test]
fn what_is_there_counts_not_what_the_file_says_of_its_writing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.dcm");
    let (said, set) = (DicomFileBuilder::new(EXPLICIT).bytes(), DicomFileBuilder::new(IMPLICIT).set);
    let meta = said.len() - DicomFileBuilder::new(EXPLICIT).set.bytes(ElementEncoding::EXPLICIT).len();
    std::fs::write(&path, [&said[..meta], &set.bytes(ElementEncoding::IMPLICIT)].concat()).unwrap();
    assert_eq!(load_path(&path, VolumeChoice::default()).unwrap().samples().value(5), 60.0);
    // Without magic bytes and file meta group.
    for syntax in [IMPLICIT, EXPLICIT, BIG] {
        let file = DicomFileBuilder::new(syntax);
        std::fs::write(folder.path().join("bare"), file.set.bytes(file.form())).unwrap();
        let volume = load_path(&folder.path().join("bare"), VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples().value(5), 60.0, "{syntax}");
    }
}

#[test]
fn numbers_of_every_type_are_exact() {
    let file = |bits: u16, stored: u16, is_signed| {
        DicomFileBuilder::new(EXPLICIT).size(2, 1).bits(bits, stored, is_signed)
    };
    for (bits, is_signed, bytes, expected) in [
        (8, false, &[0, 255][..], Samples::U8(vec![0, 255])),
        (8, true, &[127, 128], Samples::I8(vec![127, -128])),
        (16, false, &[1, 2, 255, 255], Samples::U16(vec![513, 65535])),
        (16, true, &[1, 2, 255, 255], Samples::I16(vec![513, -1])),
        (32, false, &[1, 0, 0, 0, 255, 255, 255, 255], Samples::U32(vec![1, u32::MAX])),
        (32, true, &[1, 0, 0, 0, 255, 255, 255, 255], Samples::I32(vec![1, -1])),
    ] {
        let volume = file(bits, bits, is_signed).pixels(bytes).load().unwrap();
        assert_eq!(volume.samples(), &expected);
    }
    let volume = file(16, 12, true).words(&[0xa801, 0xa7ff]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::I16(vec![-2047, 2047]), "bits above the sign do not count");
    let volume = file(16, 12, false).short(tags::HIGH_BIT, 15).words(&[0x1235, 0xfff0]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![0x123, 0xfff]));
    // Bytes swapped within big-endian words.
    let swapped =
        DicomFileBuilder::new(BIG).size(2, 2).bits(8, 8, false).pixels(&[2, 1, 4, 3]).load().unwrap();
    assert_eq!(swapped.samples(), &Samples::U8(vec![1, 2, 3, 4]));
    let floats = [0.5f32, -2.0].map(f32::to_le_bytes).concat();
    let without = |set: DataSetBuilder| set.without(tags::PIXELS);
    let volume =
        file(32, 32, false).with(|set| without(set).value(tags::FLOATS, *b"OF", &floats)).load().unwrap();
    assert_eq!(volume.samples(), &Samples::F32(vec![0.5, -2.0]));
    let floats = [0.1f64, -2.0].map(f64::to_be_bytes).concat();
    let file = DicomFileBuilder::new(BIG).size(2, 1);
    let volume = file.with(|set| without(set).value(tags::DOUBLES, *b"OD", &floats)).load().unwrap();
    assert_eq!(volume.samples(), &Samples::F64(vec![0.1, -2.0]));
}

#[test]
fn values_are_rescaled_with_all_that_refers_to_them() {
    let volume = DicomFileBuilder::new(EXPLICIT)
        .short(tags::PADDING, 10)
        .with(|set| {
            set.decimal(tags::SLOPE, "2")
                .decimal(tags::INTERCEPT, "-1024")
                .decimal(tags::WINDOW_CENTER, "40\\50")
                .decimal(tags::WINDOW_WIDTH, "401\\9")
                .text(tags::PROTOCOL, *b"LO", "Routine")
        })
        .load()
        .unwrap();
    assert_eq!(volume.samples(), &Samples::I16(vec![-1004, -984, -964, -944, -924, -904]));
    let hints = volume.metadata();
    assert_eq!((hints.modality, hints.meaning), (Modality::Ct, ValueMeaning::HounsfieldUnits));
    assert_eq!((hints.padding, hints.window), (Some(-1004.0), Some([-160.5, 239.5])));
    assert_eq!(hints.acquisition(), Some("Head, Routine"));
    let signed =
        DicomFileBuilder::new(EXPLICIT).bits(16, 16, true).short(tags::PADDING, (-2000i16) as u16).load();
    assert_eq!(signed.unwrap().metadata().padding, Some(-2000.0));
    let nothing = DicomFileBuilder::new(EXPLICIT).with(|set| set.decimal(tags::SLOPE, "0")).load().unwrap();
    assert_eq!(nothing.samples().value(0), 10.0, "a slope of 0 says nothing");
}

#[test]
fn colours_are_shown_as_luminance_or_one_by_one() {
    let pixels = [255u8, 0, 0, 0, 255, 0];
    let planar = [255u8, 0, 0, 255, 0, 0];
    let file = |photometric: &str, planar: u16, bytes: &[u8]| {
        DicomFileBuilder::new(EXPLICIT)
            .size(2, 1)
            .bits(8, 8, false)
            .short(tags::SAMPLES, 3)
            .short(tags::PLANAR, planar)
            .with(|set| set.text(tags::PHOTOMETRIC, *b"CS", photometric))
            .pixels(bytes)
    };
    for (order, bytes) in [(0, pixels), (1, planar)] {
        let volume = file("RGB", order, &bytes).load().unwrap();
        assert_eq!(volume.samples(), &Samples::U8(vec![54, 182]));
        assert_remark(&volume, "luminance");
        let choice = VolumeChoice { component: Some(1), ..VolumeChoice::default() };
        let volume = file("RGB", order, &bytes).load_with(choice).unwrap();
        assert_eq!(volume.samples(), &Samples::U8(vec![0, 255]));
    }
    // Red and grey; then two greys that share colour differences.
    let volume = file("YBR_FULL", 0, &[76, 85, 255, 90, 128, 128]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U8(vec![54, 90]));
    let volume = file("YBR_FULL_422", 0, &[70, 90, 128, 128]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U8(vec![70, 90]));
    let choice = VolumeChoice { component: Some(3), ..VolumeChoice::default() };
    assert_refused(
        file("RGB", 0, &pixels).load_with(choice),
        LoadErrorKind::BadInput,
        &["--component", "0 to 2"],
    );
    let odd = file("ARGB", 0, &pixels).load();
    assert_refused(odd, LoadErrorKind::BadInput, &["ARGB", "--photometric-interpretation RGB"]);
}

#[test]
fn values_that_mean_something_else_are_kept_and_said() {
    for (photometric, words) in [("MONOCHROME1", "shown dark"), ("PALETTE COLOR", "colour table")] {
        let volume = DicomFileBuilder::new(EXPLICIT)
            .with(|set| set.text(tags::PHOTOMETRIC, *b"CS", photometric))
            .load()
            .unwrap();
        assert_eq!(volume.samples().value(0), 10.0);
        assert_remark(&volume, words);
    }
    let table = DataSetBuilder::default().value(0x0028_3002, *b"US", &[1, 0, 0, 0, 16, 0]);
    let volume = DicomFileBuilder::new(EXPLICIT)
        .with(|set| set.items(tags::MODALITY_LUT_SEQUENCE, vec![table], false))
        .load();
    assert_remark(&volume.unwrap(), "not applied");
}
