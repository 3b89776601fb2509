//! Tests of all number types, storage layouts and compression schemes.

use std::io::Write as _;

use super::writer::{LITTLE, SHORT, TiffLeaf, TiffWriter};
use super::{assert_refused, load_bytes, load_chosen, samples_of};
use crate::Endian;
use crate::formats::pictures::tiff::file::page::tag;
use chiaroscuro_volume::{LoadErrorKind, Samples, VolumeChoice};

const WRITERS: [TiffWriter; 4] = [
    LITTLE,
    TiffWriter { endian: Endian::Big, is_big: false },
    TiffWriter { endian: Endian::Little, is_big: true },
    TiffWriter { endian: Endian::Big, is_big: true },
];

/// Encodes twelve pixels, 4 x 3, in the byte order of a writer.
macro_rules! pixels {
    ($writer:expr, $values:expr) => {
        $values
            .iter()
            .flat_map(|value| match $writer.endian {
                Endian::Little => value.to_le_bytes().to_vec(),
                Endian::Big => value.to_be_bytes().to_vec(),
            })
            .collect::<Vec<u8>>()
    };
}

#[test]
fn all_types_in_both_orders_and_sizes_of_places() {
    for writer in WRITERS {
        macro_rules! check {
            ($type:ty, $format:expr, $value:expr, $variant:ident, $expected:expr) => {
                let values: Vec<$type> = (0..12).map($value).collect();
                let leaf = writer.leaf([4, 3], 8 * size_of::<$type>() as u64, &pixels!(writer, values));
                let leaf = leaf.with(tag::SAMPLE_FORMAT, SHORT, &[$format]);
                let expected = values.iter().map($expected).collect();
                assert_eq!(samples_of(&writer.file(&[leaf])), Samples::$variant(expected));
            };
        }
        check!(i8, 2, |at| at * 10 - 3, I8, |&value| value);
        check!(i16, 2, |at| at * 1000 - 3, I16, |&value| value);
        check!(i32, 2, |at| at * 100_000 - 3, I32, |&value| value);
        check!(i64, 2, |at| at * 100_000 - 3, I32, |&value| i32::try_from(value).unwrap());
        check!(f32, 3, |at: u8| f32::from(at) * 0.3 - 1.0, F32, |&value| value);
        check!(f64, 3, |at: u8| f64::from(at) * 0.3 - 1.0, F64, |&value| value);
        check!(u8, 1, |at| 200 + at, U8, |&value| value);
        check!(u16, 1, |at| 60_000 + at, U16, |&value| value);
        check!(u32, 1, |at| 4_000_000_000 + at, U32, |&value| value);
        check!(u64, 1, |at| (1 << 40) + at, F64, |&value| value as f64);
        let halves: Vec<half::f16> = (0..12u8).map(|at| half::f16::from_f32(f32::from(at) / 4.0)).collect();
        let leaf = writer.leaf([4, 3], 16, &pixels!(writer, halves)).with(tag::SAMPLE_FORMAT, SHORT, &[3]);
        let expected = halves.iter().map(|half| half.to_f32()).collect();
        assert_eq!(samples_of(&writer.file(&[leaf])), Samples::F32(expected));
    }
}

fn compress(compression: u64, bytes: &[u8]) -> Vec<u8> {
    match compression {
        5 => {
            let mut encoder = weezl::encode::Encoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8);
            encoder.encode(bytes).unwrap()
        }
        8 | 32946 => {
            let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
            encoder.write_all(bytes).unwrap();
            encoder.finish().unwrap()
        }
        32773 => bytes.chunks(100).flat_map(|run| [&[run.len() as u8 - 1], run].concat()).collect(),
        50000 => ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest),
        _ => bytes.to_vec(),
    }
}

/// Encodes rows of 16-bit numbers with horizontal differencing, in the byte order of a writer.
fn differences(writer: TiffWriter, rows: &[u16], width: usize, samples: usize) -> Vec<u8> {
    let mut out = Vec::new();
    for row in rows.chunks(width * samples) {
        let at = |at: usize| row[at].wrapping_sub(if at < samples { 0 } else { row[at - samples] });
        let row: Vec<u16> = (0..row.len()).map(at).collect();
        out.extend(pixels!(writer, row));
    }
    out
}

/// Encodes rows of floating-point numbers with the floating-point predictor.
fn float_differences(rows: &[f32], width: usize) -> Vec<u8> {
    let mut out = Vec::new();
    for row in rows.chunks(width) {
        let bytes: Vec<u8> =
            (0..4).flat_map(|weight| row.iter().map(move |value| value.to_be_bytes()[weight])).collect();
        out.extend(
            (0..bytes.len()).map(|at| bytes[at].wrapping_sub(if at == 0 { 0 } else { bytes[at - 1] })),
        );
    }
    out
}

#[test]
fn all_compressions_with_strips_and_tiles_and_predictors() {
    // 5 x 4 pixels: the last of the strips of 3 rows has one row, tiles of 4 x 3 reach beyond the page on two sides.
    let value = |x: u16, y: u16| 40_000u16.wrapping_add(x * 1_003).wrapping_add(y * 20_011);
    let all: Vec<u16> = (0..20).map(|at| value(at % 5, at / 5)).collect();
    let tile = |x0: u16, y0: u16| -> Vec<u16> {
        (0..12)
            .map(|at| (x0 + at % 4, y0 + at / 4))
            .map(|(x, y)| if x < 5 && y < 4 { value(x, y) } else { 7 })
            .collect()
    };
    for writer in WRITERS {
        for compression in [1, 5, 8, 32946, 32773, 50000] {
            for predictor in [1, 2] {
                let part = |values: &[u16], width| {
                    let bytes = if predictor == 2 {
                        differences(writer, values, width, 1)
                    } else {
                        pixels!(writer, values)
                    };
                    compress(compression, &bytes)
                };
                let leaf = || {
                    let leaf = writer.leaf([5, 4], 16, &[]);
                    leaf.with(tag::COMPRESSION, SHORT, &[compression]).with(
                        tag::PREDICTOR,
                        SHORT,
                        &[predictor],
                    )
                };
                let strips = vec![part(&all[..15], 5), part(&all[15..], 5)];
                let tiles = [[0, 0], [4, 0], [0, 3], [4, 3]].map(|[x, y]| part(&tile(x, y), 4)).to_vec();
                for leaf in [leaf().with_rows_per_strip(3, strips), leaf().with_tiles([4, 3], tiles)] {
                    let found = samples_of(&writer.file(&[leaf]));
                    assert_eq!(found, Samples::U16(all.clone()), "{compression} {predictor}");
                }
            }
        }
        let floats: Vec<f32> = (0..6).map(|at| at as f32 * -0.37).collect();
        let leaf = writer.leaf([3, 2], 32, &compress(8, &float_differences(&floats, 3)));
        let leaf = leaf.with(tag::SAMPLE_FORMAT, SHORT, &[3]).with(tag::COMPRESSION, SHORT, &[8]).with(
            tag::PREDICTOR,
            SHORT,
            &[3],
        );
        assert_eq!(samples_of(&writer.file(&[leaf])), Samples::F32(floats));
    }
}

/// Page of two RGB pixels.
fn colors(photometric: u64, samples: u64) -> TiffLeaf {
    LITTLE
        .leaf([2, 1], 8, &[255, 0, 0, 10, 20, 30])
        .with(tag::BITS, SHORT, &[8; 3])
        .with(tag::PHOTOMETRIC, SHORT, &[photometric])
        .with(tag::SAMPLES, SHORT, &[samples])
}

#[test]
fn colours_are_luminance_or_a_component() {
    let planar = colors(2, 3).with(tag::PLANAR, SHORT, &[2]);
    let planar = planar.with_parts(vec![vec![255, 10], vec![0, 20], vec![0, 30]]);
    for leaf in [colors(2, 3), planar] {
        let file = LITTLE.file(&[leaf]);
        let volume = load_bytes(&file).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(vec![54, 19]));
        assert!(volume.remarks().iter().any(|remark| remark.contains("luminance")));
        let choice = VolumeChoice { component: Some(2), ..VolumeChoice::default() };
        let volume = load_chosen(&file, choice).unwrap();
        assert_eq!((volume.samples(), volume.remarks().len()), (&Samples::U8(vec![0, 30]), 0));
        let choice = VolumeChoice { component: Some(3), ..VolumeChoice::default() };
        assert_refused(load_chosen(&file, choice), LoadErrorKind::BadInput, &["component 3", "its 3"]);
    }
    // Several samples without a colour space are channels.
    let file = LITTLE.file(&[colors(1, 3)]);
    assert_refused(load_bytes(&file), LoadErrorKind::BadInput, &["3 channels", "--channel"]);
    let choice = VolumeChoice { channel: Some(1), ..VolumeChoice::default() };
    assert_eq!(*load_chosen(&file, choice).unwrap().samples(), Samples::U8(vec![0, 20]));
    // Grey with opacity.
    let leaf = LITTLE.leaf([2, 1], 8, &[7, 255, 9, 0]).with(tag::SAMPLES, SHORT, &[2]);
    let file = LITTLE.file(&[leaf.with(tag::EXTRA_SAMPLES, SHORT, &[2])]);
    assert_eq!(samples_of(&file), Samples::U8(vec![7, 9]));
}

#[test]
fn values_are_those_that_are_stored_whichever_is_white() {
    let white = |bits, pixels: &[u8]| LITTLE.leaf([2, 1], bits, pixels).with(tag::PHOTOMETRIC, SHORT, &[0]);
    // A mask of one bit, one of bytes, and greys: the object of a mask is what was marked.
    for (bits, pixels, expected) in [
        (1, &[0b0100_0000][..], [0, 1]),
        (8, &[0, 1], [0, 1]),
        (8, &[0, 255], [0, 255]),
        (8, &[0, 200], [0, 200]),
        (4, &[0x0F], [0, 15]),
    ] {
        let volume = load_bytes(&LITTLE.file(&[white(bits, pixels)])).unwrap();
        assert_eq!(*volume.samples(), Samples::U8(expected.to_vec()), "{bits}");
        assert!(volume.remarks()[0].contains("stands for white"));
    }
    let wide = LITTLE.leaf([2, 1], 16, &[0, 0, 0x10, 0x27]).with(tag::PHOTOMETRIC, SHORT, &[0]);
    assert_eq!(samples_of(&LITTLE.file(&[wide])), Samples::U16(vec![0, 10_000]));
}

#[test]
fn numbers_of_few_bits_are_widened() {
    let reversed = LITTLE.leaf([2, 1], 1, &[0b0000_0001]).with(tag::FILL_ORDER, SHORT, &[2]);
    assert_eq!(samples_of(&LITTLE.file(&[reversed])), Samples::U8(vec![1, 0]));
    let twelve = LITTLE.leaf([3, 2], 12, &[0xAB, 0xC1, 0x23, 0, 0x10, 0, 0x10, 2, 0, 0x30]);
    let expected = vec![0xABC, 0x123, 1, 1, 2, 3];
    assert_eq!(samples_of(&LITTLE.file(&[twelve])), Samples::U16(expected));
}

#[test]
fn labels_have_the_colours_of_their_table() {
    // Red, green and blue of 256 entries.
    let table: Vec<u64> = (0..768).map(|at| if at < 256 { 257 * at } else { 0 }).collect();
    let read = |number: fn(usize, usize) -> u8| {
        let pixels: Vec<u8> = (0..64 * 64).map(|at| number(at % 64, at / 64)).collect();
        let leaf = LITTLE.leaf([64, 64], 8, &pixels).with(tag::PHOTOMETRIC, SHORT, &[3]);
        load_bytes(&LITTLE.file(&[leaf.with(tag::COLOR_MAP, SHORT, &table)])).unwrap()
    };
    let labels = read(|x, y| [0, 90, 20, 60, 120, 30, 0, 150, 10][x / 22 + 3 * (y / 22)]);
    assert!(labels.remarks()[0].contains("colour table"));
    let found = &labels.metadata().labels;
    assert_eq!(found.get(90).and_then(|label| label.color), Some([90.0 / 255.0, 0.0, 0.0]));
    assert_eq!(found.get(91), None, "no voxel has it");
    // An image that is not a label map keeps its numbers only.
    let smooth = read(|x, y| (x * 2 + y) as u8);
    assert!(smooth.metadata().labels.is_empty() && smooth.remarks()[0].contains("colour table"));
}
