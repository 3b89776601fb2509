//! Tests of unreadable slices among readable ones, and of private syntaxes with plain pixels.

use super::*;

const HTJ2K: &str = "1.2.840.10008.1.2.4.201";
const JPEG_LOSSLESS: &str = "1.2.840.10008.1.2.4.70";
const PRIVATE: &str = "1.3.46.670589.33.1.4.1";

fn at_height(file: DicomFileBuilder, z: u16) -> DicomFileBuilder {
    file.with(|set| set.decimal(tags::POSITION, &format!("0\\0\\{}", 2 * z)))
}

/// Four slices, the second of which is replaced.
fn with_second_slice(second: DicomFileBuilder) -> [DicomFileBuilder; 4] {
    [ramp_file(0), second, ramp_file(200), ramp_file(300)]
}

fn series(second: DicomFileBuilder) -> TempDir {
    let files: Vec<DicomFileBuilder> = with_second_slice(second)
        .into_iter()
        .enumerate()
        .map(|(z, file)| at_height(file, z as u16))
        .collect();
    folder(&files)
}

#[test]
fn one_unreadable_slice_does_not_cost_the_series() {
    let packed = |syntax: &'static str, picture: &[u8]| {
        DicomFileBuilder { syntax, ..ramp_file(0) }.fragments(&[&[], picture])
    };
    // A JPEG that ends within its tables.
    let cut = [0xff, 0xd8, 0xff, 0xc3, 0, 11, 16, 0, 3, 0, 4, 1, 1, 0x11, 0, 0xff];
    for (second, why) in [
        (packed(HTJ2K, &[0xff; 64]), "High-Throughput JPEG 2000"),
        (packed(JPEG_LOSSLESS, &cut), "image is broken"),
        (packed(JPEG_LOSSLESS, &[0; 64]), "image is broken"),
        (packed(RLE, &[0; 64]), "0 byte planes"),
        (ramp_file(0).words(&[1, 2, 3]), "truncated"),
        (ramp_file(0).bits(64, 64, false), "64 bits"),
    ] {
        let at = series(second);
        for path in [at.path().to_owned(), at.path().join("0")] {
            let volume = load_path(&path, VolumeChoice::default()).unwrap();
            // Values at its position are interpolated from its neighbours.
            assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100, 200, 300])), "{why}");
            assert_eq!(affine_columns(&volume)[8], 2.0);
            assert_remark(&volume, "1 of 4 slices is left out");
            assert_remark(&volume, why);
            assert_remark(&volume, "1 slice is missing of 4");
        }
        let itself = load_path(&at.path().join("1"), VolumeChoice::default());
        assert_refused(itself, LoadErrorKind::BadInput, &[why]);
    }
}

#[test]
fn a_series_of_which_nothing_is_read_says_how_many_that_are() {
    let packed = || DicomFileBuilder { syntax: HTJ2K, ..ramp_file(0) }.fragments(&[&[], &[0xff; 64]]);
    let at = folder(&[at_height(packed(), 0), at_height(packed(), 1), at_height(packed(), 2)]);
    let words = ["none of 3 files can be read", "High-Throughput JPEG 2000"];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
    let broken = || DicomFileBuilder { syntax: JPEG_LOSSLESS, ..ramp_file(0) }.fragments(&[&[], &[0; 64]]);
    let at = folder(&[at_height(broken(), 0), at_height(broken(), 1)]);
    let words = ["none of 2 slices can be read", "broken"];
    assert_refused(load_path(at.path(), VolumeChoice::default()), LoadErrorKind::BadInput, &words);
}

#[test]
fn another_series_that_is_not_read_is_said() {
    let other = |z: u16| {
        let file = DicomFileBuilder { syntax: HTJ2K, ..ramp_file(0) }.fragments(&[&[], &[0xff; 64]]);
        at_height(file, z).with(|set| set.text(tags::SERIES_INSTANCE_UID, *b"UI", "9.9"))
    };
    let at = folder(&[at_height(ramp_file(0), 0), at_height(ramp_file(100), 1), other(0), other(1)]);
    let volume = load_path(at.path(), VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0, 100])));
    assert_remark(&volume, "2 of 2 files of other series are left out");
}

#[test]
fn a_broken_frame_does_not_cost_the_others() {
    let mut rle = vec![0u8; 64];
    rle[..12].copy_from_slice(&[2, 0, 0, 0, 64, 0, 0, 0, 66, 0, 0, 0]);
    // Twelve pixels: high bytes 0, low bytes 7.
    rle.extend([245, 0, 245, 7]);
    let frames = ["0", "2", "4"].map(|z| {
        let position = DataSetBuilder::default().decimal(tags::POSITION, &format!("0\\0\\{z}"));
        DataSetBuilder::default().items(tags::PLANE_POSITION, vec![position], false)
    });
    let file = DicomFileBuilder { syntax: RLE, ..ramp_file(0) }
        .frames("3")
        .fragments(&[&[], &rle, &[0; 64], &rle])
        .with(|set| set.without(tags::POSITION).items(tags::FRAME_GROUPS, frames.to_vec(), false));
    let volume = file.load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![7; 24]));
    assert_eq!(affine_columns(&volume)[8], 4.0);
    assert_remark(&volume, "1 of 3 slices is left out");
}

#[test]
fn private_syntaxes_that_are_plain_are_read() {
    for form in [ElementEncoding::EXPLICIT, ElementEncoding::IMPLICIT] {
        // In either encoding, as the private syntax states none.
        let bytes = ramp_file(0).set.bytes(form);
        let meta = DataSetBuilder::default()
            .text(tags::TRANSFER_SYNTAX, *b"UI", PRIVATE)
            .bytes(ElementEncoding::EXPLICIT);
        let at = TempDir::new().unwrap();
        let path = at.path().join("a.dcm");
        std::fs::write(&path, [vec![0; 128], b"DICM".to_vec(), meta, bytes].concat()).unwrap();
        let volume = load_path(&path, VolumeChoice::default()).unwrap();
        assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0])), "{form:?}");
    }
    // Compressed pixels, detected by their magic bytes.
    let mut rle = vec![0u8; 64];
    rle[..12].copy_from_slice(&[2, 0, 0, 0, 64, 0, 0, 0, 66, 0, 0, 0]);
    rle.extend([245, 0, 245, 7]);
    let packed = DicomFileBuilder { syntax: PRIVATE, ..ramp_file(0) }.fragments(&[&[], &rle]);
    assert_eq!(packed.load().unwrap().samples(), &Samples::U16(vec![7; 12]));
    // Pixels in no known form.
    let unknown = DicomFileBuilder { syntax: PRIVATE, ..ramp_file(0) }.words(&[0; 7]);
    assert_refused(
        unknown.load(),
        LoadErrorKind::BadInput,
        &["private transfer syntax", PRIVATE, "Explicit VR"],
    );
}

#[test]
fn pixels_of_ge_are_swapped() {
    let words: Vec<u8> = ramp_values(&[0]).into_iter().flat_map(u16::to_be_bytes).collect();
    let bytes = ramp_file(0).pixels(&words).set.bytes(ElementEncoding::IMPLICIT);
    let meta = DataSetBuilder::default()
        .text(tags::TRANSFER_SYNTAX, *b"UI", "1.2.840.113619.5.2")
        .bytes(ElementEncoding::EXPLICIT);
    let at = TempDir::new().unwrap();
    let path = at.path().join("a.dcm");
    std::fs::write(&path, [vec![0; 128], b"DICM".to_vec(), meta, bytes].concat()).unwrap();
    let volume = load_path(&path, VolumeChoice::default()).unwrap();
    assert_eq!(volume.samples(), &Samples::U16(ramp_values(&[0])));
}
