//! Decompression of single images, to pixels as they would be stored without compression.
//!
//! The decoders accept images from untrusted sources; still, nothing is decoded before the size that an image itself
//! states is compared with that of the header.

use std::panic::{AssertUnwindSafe, catch_unwind};

use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};
use jpeg_decoder::{CodingProcess, ColorTransform, Decoder, Error, PixelFormat, UnsupportedFeature};

use super::super::header::syntax::Codec;
use super::shape::{Colors, Shape};
use super::{extended, jpeg_ls, rle};
use crate::data::plain;

/// Decompressed image: little-endian numbers, colours interleaved.
#[derive(Debug)]
pub(super) struct Unpacked {
    pub(super) bytes: Vec<u8>,
    /// Pixel layout of the decompressed image.
    pub(super) shape: Shape,
}

/// Decompresses an image.
///
/// # Errors
/// A message that tells what is wrong with the image.
pub(super) fn unpack(codec: Codec, packed: Vec<u8>, shape: Shape) -> Result<Unpacked, String> {
    let interleaved = Shape {
        is_planar: false,
        colors: if shape.colors == Colors::YbrPairs { Colors::Ybr } else { shape.colors },
        ..shape
    };
    // A decoder that panics must cost the image, not the program.
    let guarded = |decode: &mut dyn FnMut() -> Result<Unpacked, String>| {
        catch_unwind(AssertUnwindSafe(decode))
            .unwrap_or_else(|_| Err("a picture is broken in a way that its decoder does not know".to_owned()))
    };
    match codec {
        Codec::Native => Ok(Unpacked { bytes: packed, shape }),
        Codec::Rle => rle::decode(&packed, shape.pixels(), shape.samples, shape.bytes())
            .map(|bytes| Unpacked { bytes, shape: interleaved }),
        Codec::Jpeg => guarded(&mut || jpeg(&packed, interleaved)),
        Codec::JpegLs => guarded(&mut || jpeg_ls(&packed, interleaved)),
        Codec::Jpeg2000 => guarded(&mut || jpeg_2000(&packed, interleaved)),
    }
}

/// Formats a decoder's error for the user.
fn broken(error: impl std::fmt::Display) -> String {
    format!("a picture is broken, or of a kind that is not read: {}", plain(&error.to_string(), 120))
}

fn check_size(found: [u64; 2], shape: &Shape) -> Result<(), String> {
    let expected = [shape.columns as u64, shape.rows as u64];
    if found == expected {
        return Ok(());
    }
    let ([x, y], [columns, rows]) = (found, expected);
    Err(format!("a picture has {x} x {y} pixels where the header says {columns} x {rows}"))
}

fn check_samples(found: usize, shape: &Shape) -> Result<(), String> {
    let expected = shape.samples;
    if found == expected {
        return Ok(());
    }
    Err(format!("a picture has {found} numbers a pixel where the header says {expected}"))
}

/// Decodes JPEG (ITU-T T.81): sequential of 8 and 12 bits, progressive, and lossless up to 16 bits.
fn jpeg(packed: &[u8], shape: Shape) -> Result<Unpacked, String> {
    let mut decoder = Decoder::new(packed);
    match decoder.read_info() {
        Ok(()) => {}
        Err(Error::Unsupported(UnsupportedFeature::SamplePrecision(12))) => return extended(packed, shape),
        Err(error) => return Err(broken(error)),
    }
    let Some(info) = decoder.info() else { return Err(broken("it has no size")) };
    check_size([info.width.into(), info.height.into()], &shape)?;
    let samples = match info.pixel_format {
        PixelFormat::L8 | PixelFormat::L16 => 1,
        PixelFormat::RGB24 => 3,
        PixelFormat::CMYK32 => 4,
    };
    check_samples(samples, &shape)?;
    let is_lossless = info.coding_process == CodingProcess::Lossless;
    if samples == 3 {
        let is_ybr = shape.colors == Colors::Ybr;
        decoder.set_color_transform(if is_ybr { ColorTransform::YCbCr } else { ColorTransform::RGB });
    }
    let numbers = shape.pixels() * samples;
    decoder.set_max_decoding_buffer_size(numbers.saturating_mul(2));
    let mut decoded = decoder.decode().map_err(broken)?;
    // Lossless JPEG leaves the colour space unchanged.
    let colors = if samples == 3 && !is_lossless { Colors::Rgb } else { shape.colors };
    let bytes = match (decoded.len() == numbers, shape.bytes()) {
        (true, 1) => decoded,
        (true, size) => contained(decoded.into_iter().map(u32::from), size),
        (false, 2) => {
            let words = decoded.as_chunks_mut().0.iter_mut();
            words.for_each(|word| *word = u16::from_ne_bytes(*word).to_le_bytes());
            decoded
        }
        (false, size) => {
            let words = decoded.as_chunks().0.iter();
            contained(words.map(|&word| u32::from(u16::from_ne_bytes(word))), size)
        }
    };
    checked(bytes, Shape { colors, ..shape })
}

/// Decodes lossy JPEG of 12 bits (JPEG Extended, 1.2.840.10008.1.2.4.51).
fn extended(packed: &[u8], shape: Shape) -> Result<Unpacked, String> {
    let extended::Header { width, height, components, .. } = extended::header(packed).map_err(broken)?;
    let decode = || extended::decode(packed).map(|picture| picture.numbers);
    if_as_said([width, height], components, shape, decode)
}

/// Decodes an image if its size and number of components are those of the header.
fn if_as_said(
    [width, height]: [usize; 2],
    components: usize,
    shape: Shape,
    decode: impl FnOnce() -> Result<Vec<u16>, String>,
) -> Result<Unpacked, String> {
    check_size([width as u64, height as u64], &shape)?;
    check_samples(components, &shape)?;
    let numbers = decode().map_err(broken)?.into_iter().map(u32::from);
    checked(contained(numbers, shape.bytes()), shape)
}

/// Decodes JPEG-LS (ITU-T T.87), lossless or near-lossless.
fn jpeg_ls(packed: &[u8], shape: Shape) -> Result<Unpacked, String> {
    let jpeg_ls::Header { width, height, components, .. } = jpeg_ls::header(packed).map_err(broken)?;
    let decode = || jpeg_ls::decode(packed).map(|picture| picture.numbers);
    if_as_said([width, height], components, shape, decode)
}

/// Size and components of a JPEG 2000 image, from its SIZ segment (ITU-T T.800 section A.5.1).
struct Size {
    pixels: [u64; 2],
    tiles: u64,
    /// Sign flag and bit depth of each component.
    numbers: Vec<(bool, u32)>,
}

impl Size {
    fn of(stream: &[u8]) -> Option<Self> {
        let word = |at: usize| Some(u64::from(u32::from_be_bytes(*stream.get(at..)?.first_chunk()?)));
        let [x, y, x0, y0, tile_x, tile_y, tile_x0, tile_y0] =
            [8, 12, 16, 20, 24, 28, 32, 36].map(|at| word(at).unwrap_or(0));
        let across = |end: u64, start: u64, size: u64| Some(end.checked_sub(start)?.checked_div(size)? + 1);
        let count = u16::from_be_bytes(*stream.get(40..)?.first_chunk()?);
        let numbers = stream.get(42..42 + 3 * usize::from(count))?.as_chunks().0.iter();
        let numbers = numbers.map(|&[bits, dx, dy]| {
            let is_whole = dx == 1 && dy == 1;
            is_whole.then_some((bits & 0x80 != 0, u32::from(bits & 0x7f) + 1))
        });
        Some(Self {
            pixels: [x.checked_sub(x0)?, y.checked_sub(y0)?],
            tiles: across(x, tile_x0, tile_x)?.checked_mul(across(y, tile_y0, tile_y)?)?,
            numbers: numbers.collect::<Option<_>>()?,
        })
    }
}

/// Magic bytes of a codestream: its start, and the SIZ segment.
const JPEG_2000_START: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];

/// Maximum offset at which the codestream is searched for: some programs wrap it in a file format.
const STREAM_WITHIN: usize = 1 << 16;

/// Maximum number of tiles: their indices have 16 bits.
const MOST_TILES: u64 = 1 << 16;

/// Maximum bit depth: the decoder's numbers are exact up to this many bits.
const MOST_BITS: u32 = 24;

/// Decodes JPEG 2000 (ITU-T T.800), lossless or lossy.
fn jpeg_2000(packed: &[u8], shape: Shape) -> Result<Unpacked, String> {
    let within = &packed[..packed.len().min(STREAM_WITHIN)];
    let start = within.windows(4).position(|four| four == JPEG_2000_START);
    let Some(stream) = start.and_then(|start| packed.get(start..)) else {
        return Err(broken("it has no stream"));
    };
    let Some(size) = Size::of(stream) else { return Err(broken("its numbers are not all of one size")) };
    check_size(size.pixels, &shape)?;
    if let Some((_, bits)) = size.numbers.iter().find(|(_, bits)| *bits > MOST_BITS) {
        return Err(format!("JPEG 2000 of {bits} bits is not read"));
    }
    if size.numbers.len() != shape.samples || size.tiles > MOST_TILES {
        return Err(broken(format_args!("{} numbers a pixel, {} tiles", size.numbers.len(), size.tiles)));
    }
    let settings = DecodeSettings { resolve_palette_indices: false, strict: true, target_resolution: None };
    let image = Image::new(stream, &settings).map_err(broken)?;
    check_size([image.width().into(), image.height().into()], &shape)?;
    let mut context = DecoderContext::default();
    let decoded = image.decode(&mut context).map_err(broken)?;
    let components = decoded.components();
    let is_whole = |samples: &[f32]| samples.len() == shape.pixels();
    if components.len() != shape.samples || !components.iter().all(|component| is_whole(component.samples()))
    {
        return Err(broken("it has not all of its pixels"));
    }
    let numbers = (0..shape.pixels()).flat_map(|pixel| {
        components.iter().zip(&size.numbers).map(move |(component, &(is_signed, bits))| {
            // The decoder outputs all components from 0 up: signed ones are half a range too high.
            let most = 2f64.powi(bits as i32) - 1.0;
            let value = f64::from(component.samples()[pixel]).round().clamp(0.0, most) as i64;
            (if is_signed { value - (1 << (bits - 1)) } else { value }) as u32
        })
    });
    checked(contained(numbers, shape.bytes()), shape)
}

/// Stores numbers in `size` bytes each, little-endian.
fn contained(numbers: impl Iterator<Item = u32>, size: usize) -> Vec<u8> {
    match size {
        1 => numbers.map(|number| number as u8).collect(),
        2 => numbers.flat_map(|number| (number as u16).to_le_bytes()).collect(),
        _ => numbers.flat_map(u32::to_le_bytes).collect(),
    }
}

fn checked(bytes: Vec<u8>, shape: Shape) -> Result<Unpacked, String> {
    if bytes.len() as u64 == shape.bytes_of_frame() {
        Ok(Unpacked { bytes, shape })
    } else {
        Err(broken(format_args!("it has {} of {} bytes", bytes.len(), shape.bytes_of_frame())))
    }
}
