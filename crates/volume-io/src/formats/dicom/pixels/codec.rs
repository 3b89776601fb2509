//! Decompression of single images, to pixels as they would be stored without compression.
//!
//! The decoders accept images from untrusted sources; still, nothing is decoded before the size that an image itself
//! states is compared with that of the header.

use std::io::Read as _;
use std::panic::{AssertUnwindSafe, catch_unwind};

use flate2::bufread::DeflateDecoder;
use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};
use jpeg_decoder::{CodingProcess, ColorTransform, Decoder, Error, PixelFormat, UnsupportedFeature};

use super::super::header::transfer_syntax::PixelCodec;
use super::layout::{PhotometricKind, PixelLayout};
use super::rle;
use chiaroscuro_codecs::{jpeg_ls, lossy_jpeg};
use chiaroscuro_files::sanitised;

/// Decompressed image: little-endian numbers, colours interleaved.
#[derive(Debug)]
pub(super) struct DecodedImage {
    pub(super) bytes: Vec<u8>,
    /// Pixel layout of the decompressed image.
    pub(super) shape: PixelLayout,
}

/// Decompresses an image.
///
/// # Errors
/// A message that tells what is wrong with the image.
pub(super) fn decode_image(
    codec: PixelCodec,
    compressed: Vec<u8>,
    shape: PixelLayout,
) -> Result<DecodedImage, String> {
    let interleaved = PixelLayout {
        is_planar: false,
        colors: if shape.colors == PhotometricKind::Ybr422 { PhotometricKind::YbrFull } else { shape.colors },
        ..shape
    };
    // A decoder that panics must cost the image, not the program.
    let catching_panics = |decode: &mut dyn FnMut() -> Result<DecodedImage, String>| {
        catch_unwind(AssertUnwindSafe(decode))
            .unwrap_or_else(|_| Err("an image is broken: its decoder failed unexpectedly".to_owned()))
    };
    match codec {
        PixelCodec::Native => Ok(DecodedImage { bytes: compressed, shape }),
        PixelCodec::Deflated => {
            let size = usize::try_from(shape.bytes_per_frame()).unwrap_or(usize::MAX);
            inflate(&compressed, size).map(|bytes| DecodedImage { bytes, shape })
        }
        PixelCodec::Rle => {
            rle::decode(&compressed, shape.pixel_count(), shape.samples, shape.bytes_per_number())
                .map(|bytes| DecodedImage { bytes, shape: interleaved })
        }
        PixelCodec::Jpeg => catching_panics(&mut || decode_jpeg(&compressed, interleaved)),
        PixelCodec::JpegLs => catching_panics(&mut || decode_jpeg_ls(&compressed, interleaved)),
        PixelCodec::Jpeg2000 => catching_panics(&mut || decode_jpeg_2000(&compressed, interleaved)),
    }
}

/// Inflates an image of `size` bytes; more are not read.
pub(super) fn inflate(compressed: &[u8], size: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = DeflateDecoder::new(compressed).take(size as u64).read_to_end(&mut bytes);
    match read {
        Ok(found) if found == size => Ok(bytes),
        Ok(found) => Err(format!("an image is truncated: it has {found} of {size} bytes")),
        Err(error) => Err(decoder_error(error)),
    }
}

/// Formats a decoder's error for the user.
fn decoder_error(error: impl std::fmt::Display) -> String {
    format!("an image is broken, or of an unsupported kind: {}", sanitised(&error.to_string(), 120))
}

fn check_size(found: [u64; 2], shape: &PixelLayout) -> Result<(), String> {
    let expected = [shape.columns as u64, shape.rows as u64];
    if found == expected {
        return Ok(());
    }
    let ([x, y], [columns, rows]) = (found, expected);
    Err(format!("an image has {x} x {y} pixels, the header states {columns} x {rows}"))
}

fn check_samples(found: usize, shape: &PixelLayout) -> Result<(), String> {
    let expected = shape.samples;
    if found == expected {
        return Ok(());
    }
    Err(format!("an image has {found} samples per pixel, the header states {expected}"))
}

/// Decodes JPEG (ITU-T T.81): sequential of 8 and 12 bits, progressive, and lossless up to 16 bits.
fn decode_jpeg(packed: &[u8], shape: PixelLayout) -> Result<DecodedImage, String> {
    let mut decoder = Decoder::new(packed);
    match decoder.read_info() {
        Ok(()) => {}
        Err(Error::Unsupported(UnsupportedFeature::SamplePrecision(12))) => {
            return decode_jpeg_extended(packed, shape);
        }
        Err(error) => return Err(decoder_error(error)),
    }
    let Some(info) = decoder.info() else { return Err(decoder_error("it states no size")) };
    check_size([info.width.into(), info.height.into()], &shape)?;
    let samples = match info.pixel_format {
        PixelFormat::L8 | PixelFormat::L16 => 1,
        PixelFormat::RGB24 => 3,
        PixelFormat::CMYK32 => 4,
    };
    check_samples(samples, &shape)?;
    let is_lossless = info.coding_process == CodingProcess::Lossless;
    if samples == 3 {
        let is_ybr = shape.colors == PhotometricKind::YbrFull;
        decoder.set_color_transform(if is_ybr { ColorTransform::YCbCr } else { ColorTransform::RGB });
    }
    let numbers = shape.pixel_count() * samples;
    decoder.set_max_decoding_buffer_size(numbers.saturating_mul(2));
    let mut decoded = decoder.decode().map_err(decoder_error)?;
    // Lossless JPEG leaves the colour space unchanged.
    let colors = if samples == 3 && !is_lossless { PhotometricKind::Rgb } else { shape.colors };
    let bytes = match (decoded.len() == numbers, shape.bytes_per_number()) {
        (true, 1) => decoded,
        (true, size) => to_bytes(decoded.into_iter().map(u32::from), size),
        (false, 2) => {
            let words = decoded.as_chunks_mut().0.iter_mut();
            words.for_each(|word| *word = u16::from_ne_bytes(*word).to_le_bytes());
            decoded
        }
        (false, size) => {
            let words = decoded.as_chunks().0.iter();
            to_bytes(words.map(|&word| u32::from(u16::from_ne_bytes(word))), size)
        }
    };
    check_length(bytes, PixelLayout { colors, ..shape })
}

/// Decodes lossy JPEG of 12 bits (JPEG Extended, 1.2.840.10008.1.2.4.51).
fn decode_jpeg_extended(packed: &[u8], shape: PixelLayout) -> Result<DecodedImage, String> {
    let lossy_jpeg::JpegFrameHeader { width, height, components, .. } =
        lossy_jpeg::header(packed).map_err(decoder_error)?;
    let decode = || lossy_jpeg::decode(packed).map(|picture| picture.samples);
    decode_if_matching([width, height], components, shape, decode)
}

/// Decodes an image if its size and number of components are those of the header.
fn decode_if_matching(
    [width, height]: [usize; 2],
    components: usize,
    shape: PixelLayout,
    decode: impl FnOnce() -> Result<Vec<u16>, String>,
) -> Result<DecodedImage, String> {
    check_size([width as u64, height as u64], &shape)?;
    check_samples(components, &shape)?;
    let numbers = decode().map_err(decoder_error)?.into_iter().map(u32::from);
    check_length(to_bytes(numbers, shape.bytes_per_number()), shape)
}

/// Decodes JPEG-LS (ITU-T T.87), lossless or near-lossless.
fn decode_jpeg_ls(packed: &[u8], shape: PixelLayout) -> Result<DecodedImage, String> {
    let jpeg_ls::JpegLsHeader { width, height, components, .. } =
        jpeg_ls::header(packed).map_err(decoder_error)?;
    let decode = || jpeg_ls::decode(packed).map(|picture| picture.samples);
    decode_if_matching([width, height], components, shape, decode)
}

/// Size and components of a JPEG 2000 image, from its SIZ segment (ITU-T T.800 section A.5.1).
struct Jpeg2000Size {
    pixels: [u64; 2],
    tiles: u64,
    /// Sign flag and bit depth of each component.
    components: Vec<(bool, u32)>,
}

impl Jpeg2000Size {
    fn parse(stream: &[u8]) -> Option<Self> {
        let word = |at: usize| Some(u64::from(u32::from_be_bytes(*stream.get(at..)?.first_chunk()?)));
        let [x, y, x0, y0, tile_x, tile_y, tile_x0, tile_y0] =
            [8, 12, 16, 20, 24, 28, 32, 36].map(|at| word(at).unwrap_or(0));
        let across = |end: u64, start: u64, size: u64| {
            (size > 0).then_some(end.checked_sub(start)?.div_ceil(size.max(1)))
        };
        let count = u16::from_be_bytes(*stream.get(40..)?.first_chunk()?);
        let numbers = stream.get(42..42 + 3 * usize::from(count))?.as_chunks().0.iter();
        let numbers = numbers.map(|&[bits, dx, dy]| {
            let is_whole = dx == 1 && dy == 1;
            is_whole.then_some((bits & 0x80 != 0, u32::from(bits & 0x7f) + 1))
        });
        Some(Self {
            pixels: [x.checked_sub(x0)?, y.checked_sub(y0)?],
            tiles: across(x, tile_x0, tile_x)?.checked_mul(across(y, tile_y0, tile_y)?)?,
            components: numbers.collect::<Option<_>>()?,
        })
    }
}

/// Magic bytes of a codestream: its start, and the SIZ segment.
const JPEG_2000_MAGIC: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];

/// Maximum offset at which the codestream is searched for: some programs wrap it in a file format.
const MAX_STREAM_OFFSET: usize = 1 << 16;

/// Maximum number of tiles: their indices have 16 bits.
const MAX_TILES: u64 = 1 << 16;

/// Maximum bit depth: the decoder's numbers are exact up to this many bits.
const MAX_BITS: u32 = 24;

/// Decodes JPEG 2000 (ITU-T T.800), lossless or lossy.
fn decode_jpeg_2000(packed: &[u8], shape: PixelLayout) -> Result<DecodedImage, String> {
    let within = &packed[..packed.len().min(MAX_STREAM_OFFSET)];
    let start = within.windows(4).position(|four| four == JPEG_2000_MAGIC);
    let Some(stream) = start.and_then(|start| packed.get(start..)) else {
        return Err(decoder_error("it has no codestream"));
    };
    let Some(size) = Jpeg2000Size::parse(stream) else {
        return Err(decoder_error("its SIZ segment is broken, or its components differ in resolution"));
    };
    check_size(size.pixels, &shape)?;
    if let Some((_, bits)) = size.components.iter().find(|(_, bits)| *bits > MAX_BITS) {
        return Err(format!("JPEG 2000 of {bits} bits is not supported"));
    }
    if size.components.len() != shape.samples || size.tiles > MAX_TILES {
        return Err(decoder_error(format_args!(
            "{} samples per pixel, {} tiles",
            size.components.len(),
            size.tiles
        )));
    }
    let settings = DecodeSettings { resolve_palette_indices: false, strict: true, target_resolution: None };
    let image = Image::new(stream, &settings).map_err(decoder_error)?;
    check_size([image.width().into(), image.height().into()], &shape)?;
    let mut context = DecoderContext::default();
    let decoded = image.decode(&mut context).map_err(decoder_error)?;
    let components = decoded.components();
    let is_whole = |samples: &[f32]| samples.len() == shape.pixel_count();
    if components.len() != shape.samples || !components.iter().all(|component| is_whole(component.samples()))
    {
        return Err(decoder_error("some of its pixels are missing"));
    }
    let numbers = (0..shape.pixel_count()).flat_map(|pixel| {
        components.iter().zip(&size.components).map(move |(component, &(is_signed, bits))| {
            // The decoder outputs all components from 0 up: signed ones are half a range too high.
            let most = 2f64.powi(bits as i32) - 1.0;
            let value = f64::from(component.samples()[pixel]).round().clamp(0.0, most) as i64;
            (if is_signed { value - (1 << (bits - 1)) } else { value }) as u32
        })
    });
    check_length(to_bytes(numbers, shape.bytes_per_number()), shape)
}

/// Stores numbers in `size` bytes each, little-endian.
fn to_bytes(numbers: impl Iterator<Item = u32>, size: usize) -> Vec<u8> {
    match size {
        1 => numbers.map(|number| number as u8).collect(),
        2 => numbers.flat_map(|number| (number as u16).to_le_bytes()).collect(),
        _ => numbers.flat_map(u32::to_le_bytes).collect(),
    }
}

fn check_length(bytes: Vec<u8>, shape: PixelLayout) -> Result<DecodedImage, String> {
    if bytes.len() as u64 == shape.bytes_per_frame() {
        Ok(DecodedImage { bytes, shape })
    } else {
        Err(decoder_error(format_args!("it has {} of {} bytes", bytes.len(), shape.bytes_per_frame())))
    }
}
