//! Tests of compressed pixels, with images that other programs wrote.

use super::*;

const JPEG_LOSSLESS: &str = "1.2.840.10008.1.2.4.70";
const JPEG_BASELINE: &str = "1.2.840.10008.1.2.4.50";
const JPEG_EXTENDED: &str = "1.2.840.10008.1.2.4.51";
const JPEG_LS: &str = "1.2.840.10008.1.2.4.80";
const JPEG_2000: &str = "1.2.840.10008.1.2.4.90";

/// Lossless JPEG of 16 bits.
const LOSSLESS: &str = "ffd8ffe000104a46494600010100000100010000ffc3000b100004000501011100ffc400160001010100000000\
    0000000000000000000c0e0fffda0008010100010000c0019998ccc6663332ff00f33ffbd6671998cccbff00c6663331998cccbffc666333\
    1998cccfffd9";

/// JPEG-LS of the image in `LOSSLESS`.
const LS: &str = "ffd8fff7000b100004000501011100fff8000d01ffff0012004301140040ffda000801010000000040d02cb8165d995664c0\
    0000007f80000000080e733ab33005987ff6000000000001e6677ff6b328ccb3ff4acc8598eb318cca00ffd9";

/// JPEG 2000 of 16 bits, signed.
const SIGNED: &str = "ff4fff5100290000000000050000000400000000000000000000000500000004000000000000000000018f0101ff52000c\
    00000001000004040001ff5c00044080ff90000a0000000000380001ff93dff8913015f9b61e325d3295bdd032d13a0f166a9e25c9923893\
    509fcde4e43bf6bfb53962f32b9435bfffd9";

/// JPEG 2000 of RGB, 8 bits each.
const COLORS: &str = "ff4fff51002f000000000005000000040000000000000000000000050000000400000000000000000003070101070101\
    070101ff52000c00000001010004040001ff5c00044040ff90000a0000000000320001ff93cfb44c1273217ba468235268374faf010a0e67\
    29d9dfc0f844140058efc0f8441150508fffd9";

/// Baseline JPEG of 8 bits, with minimal loss.
const LOSSY: &str = "ffd8ffe000104a46494600010100000100010000ffdb004300010101010101010101010101010101010101010101010101010101\
    01010101010101010101010101010101010101010101010101010101010101010101010101ffc0000b080004000501011100ffc4\
    0014000100000000000000000000000000000009ffc4001f100001000b0000000000000000000000000200050708091627435253\
    65ffda0008010100003f00401894249c82520a5fa2fabf03e4a7ffd9";

/// JPEG-LS of RGB, 8 bits each: one scan per component, interleaved by line, interleaved by sample.
const COLORS_LS: [&str; 3] = [
    "ffd8fff70011080004000503011100021100031100ffda0008010100000000003870e4bc0000058c10a20100000058dcc5142247\
    7100ffda000801020000000000050e4bda000002c6085100822731453023b880ffda000801030000000000014392f6800000b182\
    14402089cc514c08ee20ffd9",
    "ffd8fff70011080004000503011100021100031100ffda000c03010002000300000100003870e4bc22d5a7c33fbba000002c6085\
    1008000002c6e628a1123b8860ecc72f6663172aa94b5b642c6db95b6dc0ffd9",
    "ffd8fff70011080004000503011100021100031100ffda000c03010002000300000200001049d070e4bdab4ffeee800000b18000\
    00b188810a21cc523b810a21817973b33332aa9cc52d2c2b6db6db647700ffd9",
];

/// Extended JPEG of 12 bits, with minimal loss.
const EXTENDED: &str = "ffd8ffe000104a46494600010100000100010000ffdb004300010101010101010101010101010101010101010101010101010101\
    01010101010101010101010101010101010101010101010101010101010101010101010101ffc1000b0c0004000501011100ffc4\
    001400010000000000000000000000000000000cffc40027100000010a0603000000000000000000001202040507090a0b111317\
    06080c0e1415161822ffda0008010100003f004b26cfc16a2e71992da4858f9fe922c521595ff7c821dd5cd11b9e9cf776a99a8f\
    9d785cb80934503adb918b2756b8b9ff0014825d4fffd9";

fn hex(text: &str) -> Vec<u8> {
    let digits = text.as_bytes().as_chunks::<2>().0.iter();
    let mut bytes: Vec<u8> =
        digits.map(|two| u8::from_str_radix(std::str::from_utf8(two).unwrap(), 16).unwrap()).collect();
    if !bytes.len().is_multiple_of(2) {
        bytes.push(0);
    }
    bytes
}

/// A file with images of 5 x 4 pixels.
fn file(syntax: &'static str, is_signed: bool, fragments: &[&[u8]]) -> DicomFileBuilder {
    DicomFileBuilder::new(syntax).size(5, 4).bits(16, 16, is_signed).fragments(fragments)
}

/// Returns the pixels of [`LOSSLESS`] and [`LS`].
fn unsigned() -> Vec<u16> {
    let mut values: Vec<u16> = (0..20).map(|n| n * 3276 + 7).collect();
    values[6] = 65535;
    values
}

#[test]
fn compression_without_loss_is_exact() {
    for (syntax, picture) in [(JPEG_LOSSLESS, LOSSLESS), (JPEG_LS, LS)] {
        let volume = file(syntax, false, &[&[], &hex(picture)]).load().unwrap();
        assert_eq!(volume.samples(), &Samples::U16(unsigned()), "{syntax}");
        let signed = file(syntax, true, &[&[], &hex(picture)]).load().unwrap();
        let expected = unsigned().into_iter().map(|value| value as i16).collect();
        assert_eq!(signed.samples(), &Samples::I16(expected), "the header says the sign");
    }
    let mut expected: Vec<i16> = (0..20).map(|n| (n * 3000 - 30000) as i16).collect();
    (expected[6], expected[12]) = (i16::MIN, i16::MAX);
    let volume = file(JPEG_2000, true, &[&[], &hex(SIGNED)]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::I16(expected));
}

#[test]
fn compression_with_loss_is_near() {
    let volume = file(JPEG_BASELINE, false, &[&[], &hex(LOSSY)]).bits(8, 8, false).load().unwrap();
    for at in 0..20 {
        let expected = (at * 10 + 20) as f64;
        assert!((volume.samples().value(at) - expected).abs() <= 1.0, "{at}");
    }
    let volume = file(JPEG_EXTENDED, false, &[&[], &hex(EXTENDED)]).bits(16, 12, false).load().unwrap();
    let rows = [
        [0, 300, 900, 2000, 4095],
        [10, 310, 910, 2010, 4000],
        [20, 320, 920, 2020, 3900],
        [30, 330, 930, 2030, 3800],
    ];
    for (at, expected) in rows.into_iter().flatten().enumerate() {
        assert!((volume.samples().value(at) - f64::from(expected)).abs() <= 1.0, "{at}");
    }
}

#[test]
fn colours_are_unpacked() {
    let colors = file(JPEG_2000, false, &[&[], &hex(COLORS)])
        .bits(8, 8, false)
        .short(tags::SAMPLES, 3)
        .with(|set| set.text(tags::PHOTOMETRIC, *b"CS", "YBR_RCT"));
    for (component, add) in [(0, 0), (1, 5), (2, 9)] {
        let choice = VolumeChoice { component: Some(component), ..VolumeChoice::default() };
        let volume = colors.load_with(choice).unwrap();
        assert_eq!(volume.samples(), &Samples::U8((0..20).map(|n| n * 10 + 20 + add).collect()));
    }
    for (component, (picture, add)) in COLORS_LS.into_iter().zip([0, 5, 9]).enumerate() {
        let colors = file(JPEG_LS, false, &[&[], &hex(picture)]).bits(8, 8, false).short(tags::SAMPLES, 3);
        let choice = VolumeChoice { component: Some(component), ..VolumeChoice::default() };
        let volume = colors.with(|set| set.text(tags::PHOTOMETRIC, *b"CS", "RGB")).load_with(choice).unwrap();
        assert_eq!(volume.samples(), &Samples::U8((0..20).map(|n| n * 10 + 20 + add).collect()));
    }
}

#[test]
fn frames_are_made_of_fragments() {
    let picture = hex(LOSSLESS);
    let (start, end) = picture.split_at(50);
    let second = (start.len() + end.len() + 16) as u32;
    let table = [0u32, second].map(u32::to_le_bytes).concat();
    let expected = [unsigned(), unsigned()].concat();
    let two = |fragments: &[&[u8]]| file(JPEG_LOSSLESS, false, fragments).frames("2").load();
    assert_eq!(two(&[&table, start, end, &picture]).unwrap().samples(), &Samples::U16(expected.clone()));
    assert_eq!(two(&[&[], &picture, &picture]).unwrap().samples(), &Samples::U16(expected.clone()));
    let starts = [0u64, second.into()].map(u64::to_le_bytes).concat();
    let of_starts = file(JPEG_LOSSLESS, false, &[&[], start, end, &picture])
        .frames("2")
        .with(|set| set.value(tags::FRAME_STARTS, *b"OV", &starts));
    assert_eq!(of_starts.load().unwrap().samples(), &Samples::U16(expected));
    let unclear = two(&[&[], start, end, &picture]);
    assert_refused(unclear, LoadErrorKind::BadInput, &["3 fragments cannot be assigned to 2 frames"]);
}

#[test]
fn runs_are_unpacked() {
    let mut packed = vec![2u32, 64, 66];
    packed.resize(16, 0);
    let mut packed: Vec<u8> = packed.into_iter().flat_map(u32::to_le_bytes).collect();
    // High bytes all 1; low bytes 2 2 2 3 4 5.
    packed.extend([251, 1, 254, 2, 2, 3, 4, 5]);
    let volume = DicomFileBuilder::new(RLE).fragments(&[&[], &packed]).load().unwrap();
    assert_eq!(volume.samples(), &Samples::U16(vec![258, 258, 258, 259, 260, 261]));
}

#[test]
fn pictures_that_are_not_what_the_header_says_are_refused() {
    let signed = hex(SIGNED);
    for (file, words) in [
        (file(JPEG_2000, true, &[&[], &signed]).size(5, 5), "5 x 4 pixels, the header states 5 x 5"),
        (file(JPEG_2000, true, &[&[], &hex(COLORS)]), "3 samples per pixel"),
        (file(JPEG_2000, true, &[&[], &[0; 8]]), "no codestream"),
        (file(JPEG_LOSSLESS, true, &[&[], &hex(LOSSLESS)]).size(4, 4), "5 x 4 pixels"),
        (file(JPEG_LOSSLESS, true, &[&[], &[0; 8]]), "broken"),
        (file(JPEG_LS, true, &[&[], &hex(LS)]).size(4, 5), "5 x 4 pixels, the header states 4 x 5"),
        (file(RLE, true, &[&[], &[0; 8]]), "0 byte planes"),
        (file(RLE, true, &[]), "0 fragments"),
    ] {
        assert_refused(file.load(), LoadErrorKind::BadInput, &[words]);
    }
    // Lossy JPEG of 12 bits: the first bytes of one, and one of another size.
    let twelve = [0xff, 0xd8, 0xff, 0xc1, 0, 11, 12, 0, 4, 0, 5, 1, 1, 0x11, 0, 0];
    let twelve = file(JPEG_EXTENDED, false, &[&[], &twelve]);
    assert_refused(twelve.load(), LoadErrorKind::BadInput, &["truncated", "gdcmconv --raw"]);
    let twelve = file(JPEG_EXTENDED, false, &[&[], &hex(EXTENDED)]).size(4, 4);
    assert_refused(twelve.load(), LoadErrorKind::BadInput, &["5 x 4 pixels, the header states 4 x 4"]);
}

/// Decoders take time and memory for all announced pixels, whatever the data hold.
#[test]
fn bombs_are_refused_before_there_is_room_for_them() {
    for syntax in [JPEG_LOSSLESS, JPEG_BASELINE, JPEG_LS, JPEG_2000, RLE] {
        let huge = file(syntax, false, &[&[], &[0; 2048]]).size(20000, 20000);
        assert_refused(huge.load(), LoadErrorKind::BadInput, &["20000 x 20000 pixels do not fit in"]);
    }
}

#[test]
fn half_a_picture_is_none() {
    for (syntax, picture) in
        [(JPEG_LOSSLESS, LOSSLESS), (JPEG_EXTENDED, EXTENDED), (JPEG_LS, LS), (JPEG_2000, SIGNED)]
    {
        let picture = hex(picture);
        let half = file(syntax, true, &[&[], &picture[..picture.len() / 8 * 6]]);
        assert_refused(half.load(), LoadErrorKind::BadInput, &["Pixel Data, frame 0"]);
    }
}

#[test]
fn cut_pictures_never_harm() {
    for (syntax, picture) in
        [(JPEG_LOSSLESS, LOSSLESS), (JPEG_LS, LS), (JPEG_2000, SIGNED), (JPEG_BASELINE, LOSSLESS)]
    {
        let picture = hex(picture);
        for length in (0..picture.len()).step_by(7) {
            let _either = file(syntax, false, &[&[], &picture[..length & !1]]).load();
        }
    }
}
