//! Tests of files that must be refused: no pixels, unsupported, contradictory, truncated.

use super::*;

#[test]
fn files_without_pictures_say_what_they_are() {
    let without = |set: DataSetBuilder| set.without(tags::PIXELS);
    let report = DicomFileBuilder::new(EXPLICIT)
        .with(without)
        .with(|set| set.text(tags::MODALITY, *b"CS", "OT").text(tags::SOP_CLASS, *b"UI", "1.2.3"));
    assert_refused(report.load(), LoadErrorKind::BadInput, &["no pixels", "\"OT\""]);
    for (class, name, help) in [
        ("481.3", "RT Structure Set", "dcmrtstruct2nii"),
        ("481.3", "RT Structure Set", "plastimatch convert"),
        ("481.5", "RT Plan", "RTDOSE"),
        ("88.22", "Structured Report", "dsrdump"),
        ("11.1", "Presentation State", "open the images"),
        ("104.1", "Encapsulated PDF", "dcm2pdf"),
        ("9.1.1", "Waveform", "no voxels"),
        ("66", "Raw Data", "reconstruct"),
    ] {
        let class = format!("1.2.840.10008.5.1.4.1.1.{class}");
        let object = DicomFileBuilder::new(EXPLICIT)
            .with(without)
            .with(|set| set.text(tags::SOP_CLASS, *b"UI", &class));
        assert_refused(object.load(), LoadErrorKind::BadInput, &[name, help, "SOP Class UID"]);
        let at = folder(&[object.clone(), object]);
        assert_refused(
            load_path(at.path(), VolumeChoice::default()),
            LoadErrorKind::BadInput,
            &["2 DICOM files", name],
        );
    }
    let directory = DicomFileBuilder::new(EXPLICIT)
        .with(without)
        .with(|set| set.items(tags::DIRECTORY_RECORDS, Vec::new(), false));
    assert_refused(
        directory.load(),
        LoadErrorKind::BadInput,
        &["lists the files of a disk", "open the folder that contains it"],
    );
}

#[test]
fn kinds_that_are_not_read_are_named_with_what_helps() {
    for (syntax, words, help) in [
        ("1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000", "uncompressed file"),
        ("1.2.840.10008.1.2.4.110", "JPEG XL", "uncompressed file"),
        ("1.2.840.10008.1.2.4.102", "video", "gdcmraw"),
        ("1.2.840.10008.1.2.4.52", "rare kind", "gdcmconv --raw"),
        ("1.2.3", "private", "uncompressed file"),
    ] {
        let file = DicomFileBuilder::new(syntax).fragments(&[&[], &[0; 8]]);
        assert_refused(file.load(), LoadErrorKind::BadInput, &[words, help, "Transfer Syntax"]);
    }
    assert_refused(
        DicomFileBuilder::new(EXPLICIT).bits(4, 4, false).load(),
        LoadErrorKind::BadInput,
        &["4 bits", "gdcmconv"],
    );
    assert_refused(
        DicomFileBuilder::new(EXPLICIT).bits(64, 64, false).load(),
        LoadErrorKind::BadInput,
        &["64 bits"],
    );
}

#[test]
fn lengths_that_lie_are_found_out_before_there_is_room_for_them() {
    let huge = DicomFileBuilder::new(EXPLICIT).size(65535, 65535);
    assert_refused(huge.load(), LoadErrorKind::BadInput, &["8589672450 bytes expected", "12 found"]);
    let huge = DicomFileBuilder::new(RLE).size(65535, 65535).fragments(&[&[], &[0; 8]]);
    assert_refused(huge.load(), LoadErrorKind::BadInput, &["65535 x 65535 pixels do not fit in"]);
    let crowded = DicomFileBuilder::new(RLE).frames("9999").fragments(&[&[], &[0; 8]]);
    assert_refused(crowded.load(), LoadErrorKind::BadInput, &["too short for the 9999 frames"]);
    assert_refused(
        DicomFileBuilder::new(EXPLICIT).size(0, 4).load(),
        LoadErrorKind::BadInput,
        &["voxels is empty"],
    );
    let short = DicomFileBuilder::new(EXPLICIT).size(3, 3).load();
    assert_refused(short, LoadErrorKind::BadInput, &["18 bytes expected", "12 found"]);
    let many = DicomFileBuilder::new(EXPLICIT).frames("30000");
    assert_refused(many.load(), LoadErrorKind::BadInput, &["truncated", "30000 frames"]);
    for frames in ["999999999999999999999", "-5", "nan", "x"] {
        // Any result is acceptable, but no panic.
        let _either = DicomFileBuilder::new(EXPLICIT).frames(frames).load();
        let _either = DicomFileBuilder::new(RLE).frames(frames).fragments(&[&[0; 4], &[0; 8]]).load();
    }
    let deflated = DicomFileBuilder::new(DEFLATED).size(3, 300).load();
    assert_refused(deflated, LoadErrorKind::BadInput, &["truncated"]);
    let text = DicomFileBuilder::new(EXPLICIT)
        .with(|set| set.text(tags::SERIES_DESCRIPTION, *b"LO", &"x".repeat(60000)));
    assert!(text.load().unwrap().metadata().acquisition().unwrap().chars().count() < 300);
}

#[test]
fn data_sets_that_contradict_themselves_are_refused() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.dcm");
    let refuse = |bytes: &[u8], words: &str| {
        std::fs::write(&path, [&[0; 128], &b"DICM"[..], bytes].concat()).unwrap();
        assert_refused(load_path(&path, VolumeChoice::default()), LoadErrorKind::BadInput, &[words]);
    };
    refuse(b"\x08\0\x05\0LO\xff\xff", "states a length of 65535 bytes, only 0 are left");
    refuse(b"\x08\0\x05\0UN\0\0\xfe\xff\xff\xff", "4294967294 bytes");
    refuse(b"\x08\0\x05\0LO\x02", "ends within a data element");
    refuse(b"\xfe\xff\0\xe0\0\0\0\0", "outside of a sequence");
    refuse(b"\x08\0\x40\x11SQ\0\0\xff\xff\xff\xff\x08\0\x05\0CS\0\0", "between the items");
    refuse(b"\x08\0\x40\x11OB\0\0\xff\xff\xff\xff\xfe\xff\0\xe0\xff\xff\xff\xff", "no length");
    refuse(b"", "no pixels");
    refuse(
        b"\x08\0\x40\x11OB\0\0\xff\xff\xff\xff\xfe\xff\0\xe0\0\0\0\0",
        "the end of its fragments is missing",
    );
    // Deeply nested sequences.
    let nest = b"\x08\0\x40\x11SQ\0\0\xff\xff\xff\xff\xfe\xff\0\xe0\xff\xff\xff\xff";
    refuse(&nest.repeat(100_000), "more than 64 sequences are nested");
    let deep = DataSetBuilder::default().items(0x0008_1140, vec![DataSetBuilder::default()], true);
    let deep = (0..62).fold(deep, |set, _| DataSetBuilder::default().items(0x0008_1140, vec![set], true));
    assert!(
        DicomFileBuilder::new(EXPLICIT)
            .with(|set| DataSetBuilder(set.0.into_iter().chain(deep.0).collect()))
            .load()
            .is_ok()
    );
}

#[test]
fn pieces_of_a_file_never_harm() {
    let whole = DicomFileBuilder::new(EXPLICIT).bytes();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.dcm");
    for length in 0..whole.len() {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(load_path(&path, VolumeChoice::default()).is_err(), "{length}");
    }
}

#[test]
fn loading_stops_when_asked() {
    let folder = TempDir::new().unwrap();
    let path = DicomFileBuilder::new(EXPLICIT).write(&folder, "a.dcm");
    let control = LoadControl::new();
    control.cancel();
    for path in [path.as_path(), folder.path()] {
        assert!(matches!(load(path, &LoadOptions::default(), &control), Err(LoadError::Cancelled)));
    }
}

#[test]
fn a_compressed_file_says_what_helps() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.dcm.gz");
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&DicomFileBuilder::new(EXPLICIT).bytes()).unwrap();
    std::fs::write(&path, encoder.finish().unwrap()).unwrap();
    assert_refused(load_path(&path, VolumeChoice::default()), LoadErrorKind::BadInput, &["gunzip"]);
}
