//! Tests of segmentations: masks of one bit, fractions, and label maps.

use super::*;
use chiaroscuro_volume::{FileLabel, ValueMeaning};

/// A segment as the header describes it, coloured grey of this lightness, from 0 to 100.
fn segment(number: u16, label: &str, lightness: f64) -> DataSetBuilder {
    let grey = [(lightness / 100.0 * 65535.0) as u16, 32896, 32896];
    DataSetBuilder::default()
        .value(tags::SEGMENT_NUMBER, *b"US", &number.to_le_bytes())
        .text(tags::SEGMENT_LABEL, *b"LO", label)
        .value(tags::SEGMENT_COLOR, *b"US", &grey.map(u16::to_le_bytes).concat())
}

/// A segmentation with frames of 5 x 3 pixels, each of a segment at a height.
fn segmentation(kind: &str, frames: &[(u16, &str)]) -> DicomFileBuilder {
    let frame = |(number, z): &(u16, &str)| {
        let position = DataSetBuilder::default().decimal(tags::POSITION, &format!("0\\0\\{z}"));
        let number = DataSetBuilder::default().value(tags::REFERENCED_SEGMENT, *b"US", &number.to_le_bytes());
        DataSetBuilder::default().items(tags::PLANE_POSITION, vec![position], false).items(
            tags::SEGMENT_IDENTIFICATION,
            vec![number],
            true,
        )
    };
    let measures = DataSetBuilder::default()
        .decimal(tags::PIXEL_SPACING, "0.5\\0.25")
        .decimal(tags::SPACING_BETWEEN_SLICES, "2")
        .decimal(tags::SLICE_THICKNESS, "2");
    let shared = DataSetBuilder::default().items(tags::PIXEL_MEASURES, vec![measures], false);
    DicomFileBuilder::new(EXPLICIT).size(5, 3).frames(&frames.len().to_string()).with(|set| {
        set.without(tags::POSITION)
            .without(tags::SLICE_THICKNESS)
            .text(tags::SOP_CLASS, *b"UI", "1.2.840.10008.5.1.4.1.1.66.4")
            .text(tags::MODALITY, *b"CS", "SEG")
            .text(tags::SEGMENTATION_TYPE, *b"CS", kind)
            .items(tags::SEGMENTS, vec![segment(1, "Liver", 0.0), segment(3, "Spleen", 100.0)], false)
            .items(tags::SHARED_GROUPS, vec![shared], false)
            .items(tags::FRAME_GROUPS, frames.iter().map(frame).collect(), true)
    })
}

/// Packs frames of bits, eight to a byte, lowest bit first, without a gap between frames.
fn bits(frames: &[[u8; 15]]) -> Vec<u8> {
    let mut bytes = vec![0u8; (frames.len() * 15).div_ceil(16) * 2];
    for (at, bit) in frames.iter().flatten().enumerate() {
        bytes[at / 8] |= bit << (at % 8);
    }
    bytes
}

/// Makes a mask with these pixels set.
fn mask(pixels: &[usize]) -> [u8; 15] {
    let mut mask = [0; 15];
    for &pixel in pixels {
        mask[pixel] = 1;
    }
    mask
}

fn assert_labels(volume: &Volume) {
    assert_eq!(volume.metadata().meaning, ValueMeaning::Labels);
    let label = |name: &str, grey: f32| FileLabel { name: name.to_owned(), color: Some([grey; 3]) };
    let found: Vec<_> = volume.metadata().labels.iter().collect();
    assert_eq!((found[0].0, found[1].0), (1, 3));
    for ((_, found), right) in found.into_iter().zip([label("Liver", 0.0), label("Spleen", 1.0)]) {
        assert_eq!(found.name, right.name);
        let both = found.color.unwrap().into_iter().zip(right.color.unwrap());
        assert!(both.into_iter().all(|(found, right)| (found - right).abs() < 0.02), "{found:?}");
    }
}

#[test]
fn masks_of_one_bit_are_a_label_map() {
    let frames = [(1, "0"), (1, "2"), (3, "2"), (3, "8")];
    let masks = [mask(&[0, 14]), mask(&[1, 2]), mask(&[7]), mask(&[3, 4])];
    let file = segmentation("BINARY", &frames).bits(1, 1, false).pixels(&bits(&masks));
    for syntax in [EXPLICIT, IMPLICIT, DEFLATED] {
        let volume = DicomFileBuilder { syntax, ..file.clone() }.load().unwrap();
        let mut expected = vec![0u8; 5 * 15];
        for (voxel, number) in
            [(0, 1), (14, 1), (15 + 1, 1), (15 + 2, 1), (15 + 7, 3), (60 + 3, 3), (60 + 4, 3)]
        {
            expected[voxel] = number;
        }
        assert_eq!((volume.dims(), volume.samples()), ([5, 3, 5], &Samples::U8(expected)), "{syntax}");
        assert_eq!(
            affine_columns(&volume)[8],
            2.0,
            "frames without segments are left out in the file, not in space"
        );
        assert_labels(&volume);
        assert!(volume.remarks().is_empty(), "{:?}", volume.remarks());
    }
}

/// Encodes bytes in runs of one, as DICOM's RLE has them.
fn run_lengths(bytes: &[u8]) -> Vec<u8> {
    let mut encoded: Vec<u8> = [1u32, 64].into_iter().flat_map(u32::to_le_bytes).collect();
    encoded.resize(64, 0);
    encoded.extend(bytes.iter().flat_map(|&byte| [0, byte]));
    encoded
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    let mut bytes = encoder.finish().unwrap();
    if !bytes.len().is_multiple_of(2) {
        bytes.push(0);
    }
    bytes
}

#[test]
fn masks_are_unpacked_from_every_kind_of_compression() {
    const ENCAPSULATED: &str = "1.2.840.10008.1.2.1.98";
    const DEFLATED_FRAMES: &str = "1.2.840.10008.1.2.8.1";
    let masks = [mask(&[0, 14]), mask(&[1, 2, 7])];
    let file = segmentation("BINARY", &[(1, "0"), (3, "2")]).bits(1, 1, false);
    let whole = file.clone().pixels(&bits(&masks)).load().unwrap();
    let packed = masks.map(|mask| bits(&[mask]));
    // With a byte for each pixel, as some write run lengths, and with packed bits.
    let cases: [(&str, [Vec<u8>; 2]); 4] = [
        (ENCAPSULATED, packed.clone()),
        (DEFLATED_FRAMES, packed.each_ref().map(|bytes| deflated(bytes))),
        (RLE, packed.each_ref().map(|bytes| run_lengths(bytes))),
        (RLE, masks.each_ref().map(|mask| run_lengths(mask))),
    ];
    for (syntax, [first, second]) in &cases {
        let packed = |fragments: &[&[u8]]| DicomFileBuilder { syntax, ..file.clone() }.fragments(fragments);
        let volume = packed(&[&[], first, second]).load().unwrap();
        assert_eq!(volume.samples(), whole.samples(), "{syntax}");
        assert_labels(&volume);
        for length in 0..first.len() {
            // A truncated frame is left out, or refused; but for the padding, and where so few bytes are left of a
            // mask of bytes that they could be packed bits.
            let is_unnoticed = length + 2 > first.len() || (68..72).contains(&length) && first.len() > 72;
            let cut = packed(&[&[], &first[..length], second]).load();
            assert!(is_unnoticed || cut.is_err() || !cut.unwrap().remarks().is_empty(), "{length}");
        }
        let huge = packed(&[&[], first, second]).size(65535, 65535).load();
        assert!(huge.is_err(), "{syntax}");
    }
    // Frames of whole numbers, too.
    let bytes = [10u16, 20, 30, 40, 50, 60].map(u16::to_le_bytes).concat();
    let file = DicomFileBuilder { syntax: DEFLATED_FRAMES, ..DicomFileBuilder::new(EXPLICIT) };
    let volume = file.clone().fragments(&[&[], &deflated(&bytes)]).load().unwrap();
    assert_eq!(*volume.samples(), Samples::U16(vec![10, 20, 30, 40, 50, 60]));
    let short = file.fragments(&[&[], &deflated(&bytes[..8])]);
    assert_refused(short.load(), LoadErrorKind::BadInput, &["truncated: it has 8 of 12 bytes", "gdcmconv"]);
}

#[test]
fn segments_that_overlap_are_said() {
    let file = segmentation("BINARY", &[(3, "0"), (1, "0"), (1, "2")]).bits(1, 1, false);
    let volume = file.pixels(&bits(&[mask(&[0, 1]), mask(&[1, 2]), mask(&[])])).load().unwrap();
    let Samples::U8(found) = volume.samples() else { panic!() };
    assert_eq!(&found[..4], [3, 3, 1, 0]);
    assert_remark(&volume, "segments overlap in 1 voxels: the one with the highest number is shown");
}

#[test]
fn shares_of_several_segments_are_a_label_map() {
    let shares = |pixels: &[(usize, u8)]| {
        let mut frame = [0u8; 15];
        for &(pixel, share) in pixels {
            frame[pixel] = share;
        }
        frame
    };
    let frames = [shares(&[(0, 200), (1, 99), (2, 120)]), shares(&[(0, 100), (1, 100), (2, 150)])];
    let file = segmentation("FRACTIONAL", &[(1, "0"), (3, "0")])
        .bits(8, 8, false)
        .short(tags::MAX_FRACTION, 200)
        .pixels(&frames.concat());
    let volume = file.load().unwrap();
    let Samples::U8(found) = volume.samples() else { panic!() };
    assert_eq!(&found[..4], [1, 3, 3, 0], "the largest share of a half at least");
    assert_labels(&volume);
    // Fractions of a single segment are a scalar field.
    let one = segmentation("FRACTIONAL", &[(1, "0"), (1, "4")])
        .bits(8, 8, false)
        .with(|set| set.items(tags::SEGMENTS, vec![segment(1, "Liver", 0.0)], false));
    let volume = one.pixels(&frames.concat()).load().unwrap();
    assert_eq!(volume.dims(), [5, 3, 3]);
    assert_eq!([0, 1, 15, 30].map(|at| volume.samples().value(at)), [200.0, 99.0, 0.0, 100.0]);
    assert_eq!(volume.metadata().meaning, ValueMeaning::Unknown);
}

#[test]
fn numbers_of_segments_have_names_and_colors() {
    let mut pixels = [0u8; 30];
    (pixels[0], pixels[29]) = (1, 3);
    let file = segmentation("LABELMAP", &[(1, "0"), (1, "4")]).bits(8, 8, false).pixels(&pixels);
    let volume = file.load().unwrap();
    let mut expected = vec![0u8; 45];
    (expected[0], expected[44]) = (1, 3);
    assert_eq!((volume.dims(), volume.samples()), ([5, 3, 3], &Samples::U8(expected)));
    assert_labels(&volume);
}

#[test]
fn pixels_of_one_bit_are_read_anywhere() {
    let film = DicomFileBuilder::new(EXPLICIT).size(5, 3).frames("2").bits(1, 1, false);
    let volume = film.pixels(&bits(&[mask(&[0, 14]), mask(&[1])])).load().unwrap();
    let ones: Vec<usize> = (0..30).filter(|&at| volume.samples().value(at) == 1.0).collect();
    assert_eq!(ones, [0, 14, 16]);
}

#[test]
fn segmentations_that_lie_are_no_harm() {
    let whole =
        segmentation("BINARY", &[(1, "0"), (1, "2")]).bits(1, 1, false).pixels(&bits(&[mask(&[0]); 2]));
    let truncated = whole.clone().frames("60000");
    assert_refused(truncated.load(), LoadErrorKind::BadInput, &["truncated", "60000 frames"]);
    // Far apart: no more layers than the limit allows.
    let far =
        segmentation("BINARY", &[(1, "0"), (1, "1e12")]).bits(1, 1, false).pixels(&bits(&[mask(&[0]); 2]));
    assert_eq!(far.load().unwrap().dims()[2], 2);
    let nowhere = whole.clone().with(|set| set.without(tags::FRAME_GROUPS));
    assert_eq!(nowhere.load().unwrap().dims(), [5, 3, 2]);
    let many = segmentation("BINARY", &[(65535, "0"), (1, "2")]).bits(1, 1, false);
    let many = many.pixels(&bits(&[mask(&[0]); 2])).load().unwrap();
    assert_eq!(many.samples().value(0), 65535.0);
    let packed = whole.fragments(&[&[], &[0; 64], &[0; 64]]);
    assert!(DicomFileBuilder { syntax: RLE, ..packed }.load().is_err());
}
