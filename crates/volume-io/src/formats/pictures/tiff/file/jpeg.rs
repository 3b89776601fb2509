//! JPEG in strips and tiles (ITU-R T.81, and TIFF Technical Note 2 of 1995): each is a picture of its own, whose
//! tables may be stored once for all in the directory of the page.

use std::io::{self, Read as _};
use std::panic::{AssertUnwindSafe, catch_unwind};

use jpeg_decoder::{ColorTransform, Decoder, PixelFormat};

use crate::reading::samples::ReadFault;

/// Markers at the beginning and end of a stream (SOI and EOI).
const START: [u8; 2] = [0xff, 0xd8];
const END: [u8; 2] = [0xff, 0xd9];

/// Parameters of a strip or tile from the page's directory.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct JpegPart<'a> {
    /// Stream of tables only; empty where each picture has its own.
    pub(super) tables: &'a [u8],
    /// Pixels across and down; a last strip may have fewer rows.
    pub(super) size: [u64; 2],
    /// Uncompressed bytes of a strip or tile with all its rows.
    pub(super) full_bytes: usize,
    /// Number of samples per pixel.
    pub(super) samples: usize,
    /// True for `YCbCr` data, which is converted to RGB.
    pub(super) is_ycbcr: bool,
}

/// Decodes a picture into `out`, row by row; returns the number of bytes.
///
/// # Errors
/// `Io` with a description of the defect.
pub(super) fn expand(picture: JpegPart<'_>, packed: &[u8], out: &mut [u8]) -> Result<usize, ReadFault> {
    // A panic of the decoder becomes an error of this picture, and does not end the program.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(picture, packed, out.len())))
        .unwrap_or_else(|_| Err("its decoder failed unexpectedly".to_owned()));
    let decoded = decoded.map_err(|why| ReadFault::Io(io::Error::other(why)))?;
    let count = decoded.len().min(out.len());
    out[..count].copy_from_slice(&decoded[..count]);
    Ok(count)
}

fn decode(picture: JpegPart<'_>, packed: &[u8], wanted: usize) -> Result<Vec<u8>, String> {
    let JpegPart { tables, size: [across, down], full_bytes: _, samples, is_ycbcr: is_ybr } = picture;
    let Some(rest) = packed.strip_prefix(&START) else {
        return Err("it does not begin as a JPEG picture".to_owned());
    };
    let tables = tables.strip_suffix(&END).filter(|tables| tables.starts_with(&START));
    let mut decoder = Decoder::new(tables.unwrap_or(&START).chain(rest));
    decoder.read_info().map_err(|error| error.to_string())?;
    let Some(info) = decoder.info() else { return Err("it states no size".to_owned()) };
    let [width, height] = [info.width, info.height].map(u64::from);
    let row = across.saturating_mul(samples as u64).max(1);
    let rows = wanted as u64 / row;
    if width != across || height > down || height < rows {
        return Err(format!("its picture has {width} x {height} pixels, {across} x {rows} were expected"));
    }
    match (info.pixel_format, samples) {
        (PixelFormat::L8, 1) | (PixelFormat::RGB24, 3) => {}
        (found, _) => return Err(format!("its picture has the pixel format {found:?}, unlike its page")),
    }
    if samples == 3 {
        // The directory of the page decides on the colour space, whatever other programs write into the picture.
        decoder.set_color_transform(if is_ybr { ColorTransform::YCbCr } else { ColorTransform::RGB });
    }
    let whole = usize::try_from(row.saturating_mul(height)).unwrap_or(usize::MAX);
    decoder.set_max_decoding_buffer_size(whole);
    decoder.decode().map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ExtendedColorType, codecs::jpeg::JpegEncoder};

    fn encoded(pixels: &[u8], width: u32, height: u32, color: ExtendedColorType) -> Vec<u8> {
        let mut stream = Vec::new();
        JpegEncoder::new_with_quality(&mut stream, 100).encode(pixels, width, height, color).unwrap();
        stream
    }

    /// Splits a stream into one with the tables only, and the stream without them.
    fn apart(stream: &[u8]) -> [Vec<u8>; 2] {
        let (mut tables, mut rest) = (START.to_vec(), START.to_vec());
        let mut at = 2;
        loop {
            let end = at + 2 + usize::from(u16::from_be_bytes([stream[at + 2], stream[at + 3]]));
            // Quantisation and Huffman tables (DQT and DHT).
            let is_table = matches!(stream[at + 1], 0xdb | 0xc4);
            if is_table { &mut tables } else { &mut rest }.extend(&stream[at..end]);
            if stream[at + 1] == 0xda {
                rest.extend(&stream[end..]);
                tables.extend(END);
                return [tables, rest];
            }
            at = end;
        }
    }

    fn expanded(picture: JpegPart<'_>, packed: &[u8], count: usize) -> Result<Vec<u8>, String> {
        let mut out = vec![0; count];
        match expand(picture, packed, &mut out) {
            Ok(found) => Ok(out[..found].to_vec()),
            Err(ReadFault::Io(error)) => Err(error.to_string()),
            Err(other) => panic!("{other:?}"),
        }
    }

    #[test]
    fn tables_stand_in_the_picture_or_once_for_all() {
        let pixels: Vec<u8> = (0..16 * 12).map(|at| (at % 16 * 12 + at / 16 * 3) as u8).collect();
        let stream = encoded(&pixels, 16, 12, ExtendedColorType::L8);
        let picture = JpegPart { size: [16, 12], samples: 1, ..JpegPart::default() };
        let whole = expanded(picture, &stream, pixels.len()).unwrap();
        let off = whole.iter().zip(&pixels).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(whole.len() == pixels.len() && off <= Some(3), "{off:?}");
        let [tables, rest] = apart(&stream);
        assert!(expanded(picture, &rest, pixels.len()).is_err(), "its tables are elsewhere");
        assert_eq!(expanded(JpegPart { tables: &tables, ..picture }, &rest, pixels.len()), Ok(whole.clone()));
        // The last strip of a page has fewer rows, but its picture may have all.
        assert_eq!(expanded(picture, &stream, 16 * 5).unwrap(), whole[..16 * 5]);
    }

    #[test]
    fn the_page_says_what_colours_are() {
        let stream = encoded(&[200, 30, 90].repeat(64), 8, 8, ExtendedColorType::Rgb8);
        let picture = JpegPart { size: [8, 8], samples: 3, is_ycbcr: true, ..JpegPart::default() };
        let first =
            |picture| expanded(picture, &stream, 8 * 8 * 3).map(|found| [found[0], found[1], found[2]]);
        let near =
            |found: [u8; 3], wanted: [u8; 3]| found.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 2);
        assert!(near(first(picture).unwrap(), [200, 30, 90]));
        // Luma and colour differences without conversion, by the weights of ITU-R BT.601.
        assert!(near(first(JpegPart { is_ycbcr: false, ..picture }).unwrap(), [88, 129, 208]));
    }

    #[test]
    fn what_is_not_as_the_page_says_is_refused() {
        let stream = encoded(&[9; 64], 8, 8, ExtendedColorType::L8);
        let picture = JpegPart { size: [8, 8], samples: 1, ..JpegPart::default() };
        for (picture, packed, words) in [
            (JpegPart { size: [9, 8], ..picture }, &stream[..], "8 x 8 pixels"),
            (JpegPart { size: [8, 7], ..picture }, &stream, "8 x 8 pixels"),
            (JpegPart { samples: 3, size: [8, 8], ..picture }, &stream, "L8"),
            (picture, b"\x55\x55\x55", "does not begin"),
            (picture, &stream[..40], ""),
        ] {
            let refused = expanded(picture, packed, 64).unwrap_err();
            assert!(refused.contains(words), "{refused}");
        }
    }
}
