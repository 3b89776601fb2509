//! Slice in a file of its own: recognition, header and decoding of PNG, JPEG, BMP and TIFF.

use std::io::{self, BufRead as _, BufReader, Read as _};

use image::error::{ImageError, LimitErrorKind};
use image::{ColorType, ImageDecoder as _, ImageFormat, ImageReader, Limits};

use super::super::tiff;
use crate::reading::input::{FileChangeGuard, InputFile};
use crate::reading::number::{FileNumberType, ScalarReduction, VoxelEncoding};
use crate::reading::samples::alloc_with_capacity;
use crate::{Endian, LoadOptions};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, human_bytes};

/// Number of bytes that picture formats are detected by.
pub(super) const MAGIC_BYTES: usize = 32;

/// Lengths of BMP headers (`BITMAPCOREHEADER` to `BITMAPV5HEADER`): "BM" alone may begin a text.
const BMP_HEADERS: [u8; 7] = [12, 40, 52, 56, 64, 108, 124];

const HELP: &str = "copy the file again, or save it anew as PNG or TIFF";

/// File format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum SliceFormat {
    Png,
    Jpeg,
    Bmp,
    Tiff,
}

impl SliceFormat {
    /// Detects the format by the first bytes of a file.
    pub(super) fn detect(start: &[u8]) -> Option<Self> {
        let is_bmp = || {
            let header = start.get(14..18);
            start.starts_with(b"BM")
                && header.is_some_and(|header| BMP_HEADERS.contains(&header[0]) && header[1..] == [0; 3])
        };
        if start.starts_with(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else if start.starts_with(&[0xFF, 0xD8, 0xFF]) {
            Some(Self::Jpeg)
        } else if tiff::is_tiff(start) {
            Some(Self::Tiff)
        } else {
            is_bmp().then_some(Self::Bmp)
        }
    }

    /// Detects the format of a file; `None` if it is not a picture.
    ///
    /// # Errors
    /// `Io` where it cannot be read.
    pub(super) fn detect_file(context: LoadContext<'_>) -> Result<Option<Self>, LoadError> {
        let input = InputFile::open(context)?;
        let mut start = Vec::new();
        // Without the large buffer, for a few bytes.
        let mut file = input.reader.into_inner();
        let read = file.by_ref().take(MAGIC_BYTES as u64).read_to_end(&mut start);
        read.map_err(|error| context.io_error(error))?;
        Ok(Self::detect(&start))
    }

    /// Name of the format, of one picture or of a folder of them.
    pub(super) fn name(self, is_folder: bool) -> &'static str {
        match (self, is_folder) {
            (Self::Png, false) => "PNG",
            (Self::Jpeg, false) => "JPEG",
            (Self::Bmp, false) => "BMP",
            (Self::Tiff, false) => "TIFF",
            (Self::Png, true) => "folder of PNG pictures",
            (Self::Jpeg, true) => "folder of JPEG pictures",
            (Self::Bmp, true) => "folder of BMP pictures",
            (Self::Tiff, true) => "folder of TIFF pictures",
        }
    }

    fn format(self) -> Option<ImageFormat> {
        match self {
            Self::Png => Some(ImageFormat::Png),
            Self::Jpeg => Some(ImageFormat::Jpeg),
            Self::Bmp => Some(ImageFormat::Bmp),
            Self::Tiff => None,
        }
    }
}

/// Properties of a picture that are known before it is decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PictureHeader {
    /// Width and height, in pixels.
    pub(super) size: [u64; 2],
    /// Storage of its numbers after decoding.
    pub(super) stored: VoxelEncoding,
    /// Number of pages that could be slices.
    pub(super) pages: usize,
}

/// Reads the header of a picture, and decodes it if `is_decoded`; otherwise the bytes are empty.
///
/// # Errors
/// `BadInput` for a broken file, or an unsupported number type; `Limit` over the budget.
pub(super) fn read_picture(
    context: LoadContext<'_>,
    kind: SliceFormat,
    options: &LoadOptions,
    control: &LoadControl,
    is_decoded: bool,
) -> Result<(PictureHeader, Vec<u8>), LoadError> {
    control.check()?;
    if let Some(format) = kind.format() {
        return read_image(context, format, options, is_decoded, control);
    }
    let picture = tiff::SingleSlice::open(context, control)?;
    let (size, pages) = (picture.size(), picture.pages);
    let header = PictureHeader { size, stored: picture.stored(context, options)?, pages };
    let bytes = if is_decoded { picture.decode(context, control)? } else { Vec::new() };
    Ok((header, bytes))
}

/// Bytes of a BMP up to the end of its compression field.
const BMP_HEADER: usize = 34;

/// Upper bound of the pixels in a file of some length. Decoders allocate as many as the header announces, and some
/// fill the missing ones with grey.
fn max_pixels(format: ImageFormat, length: u64, first: &[u8]) -> u64 {
    match format {
        // One bit for each block of 8 x 8 pixels: the shortest code of a DC coefficient.
        ImageFormat::Jpeg => length.saturating_mul(8 * 64),
        ImageFormat::Bmp => max_bmp_pixels(length, first),
        // Deflate expands a byte to at most 1032 (RFC 1951: 258 bytes from two bits), and a byte holds up to eight
        // pixels.
        _ => length.saturating_mul(1032 * 8),
    }
}

/// Upper bound of the pixels in a BMP with these first bytes.
fn max_bmp_pixels(length: u64, first: &[u8]) -> u64 {
    let word = |at: usize| first.get(at..at + 2).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    // Headers of twelve bytes have no compression, and their bit depth is elsewhere.
    let is_old = word(14) < 40;
    match word(30) {
        // Run-length encoding: at most 255 pixels in two bytes.
        1 | 2 if !is_old => length.saturating_mul(128),
        _ => length.saturating_mul(8) / if is_old { 1 } else { u64::from(word(28)).max(1) },
    }
}

/// Returns true if a JPEG has an end-of-image marker after its first scan, which its decoder does not check (ITU-T
/// T.81, B.1.1.3 and B.2.1). Entropy-coded data cannot contain this marker.
fn has_end_of_image(input: &mut InputFile) -> io::Result<bool> {
    let mut bytes = Vec::new();
    input.seek(0)?;
    input.reader.read_to_end(&mut bytes)?;
    input.seek(0)?;
    let mut at = 2;
    while let Some(&[0xFF, marker, high, low]) = bytes.get(at..).and_then(<[u8]>::first_chunk) {
        at += match marker {
            // Fill byte before a marker.
            0xFF => 1,
            // Marker without a length field.
            0x01 | 0xD0..=0xD7 => 2,
            _ => 2 + usize::from(u16::from_be_bytes([high, low])),
        };
        if marker == 0xDA {
            return Ok(bytes.get(at..).is_some_and(|data| data.windows(2).any(|two| two == [0xFF, 0xD9])));
        }
    }
    // Not a valid sequence of markers: left to the decoder to report.
    Ok(true)
}

fn read_image(
    context: LoadContext<'_>,
    format: ImageFormat,
    options: &LoadOptions,
    is_decoded: bool,
    control: &LoadControl,
) -> Result<(PictureHeader, Vec<u8>), LoadError> {
    let mut input = InputFile::open(context)?;
    let first_bytes = input.reader.fill_buf().map_err(|error| context.io_error(error))?;
    let first_bytes = first_bytes[..first_bytes.len().min(BMP_HEADER)].to_vec();
    let budget = options.memory_budget_bytes;
    let too_large = |bytes: u64| {
        context.limit_error(
            "size",
            format!(
                "the picture needs {}, {} are allowed",
                human_bytes(bytes.into()),
                human_bytes(budget.into())
            ),
            "close other programs, or load a smaller picture",
        )
    };
    // A JPEG file is read whole before it is decoded.
    if input.len > budget {
        return Err(too_large(input.len));
    }
    let guard = FileChangeGuard::new(context, &input, control)?;
    let fault = |error: ImageError| match error {
        ImageError::Limits(limit) if limit.kind() != LimitErrorKind::DimensionError => context.limit_error(
            "size",
            format!("the picture needs more than the {} that are allowed", human_bytes(budget.into())),
            "close other programs, or load a smaller picture",
        ),
        ImageError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            context.bad_input_error("data", "the picture is truncated: the file ends too early", HELP)
        }
        error => {
            context.bad_input_error("data", sanitised(&format!("the picture is broken: {error}"), 200), HELP)
        }
    };
    if is_decoded
        && format == ImageFormat::Jpeg
        && !has_end_of_image(&mut input).map_err(|error| context.io_error(error))?
    {
        return Err(context.bad_input_error(
            "data",
            "the picture is truncated: its end marker is missing",
            HELP,
        ));
    }
    let (length, most_pixels) = (input.len, max_pixels(format, input.len, &first_bytes));
    let mut reader: ImageReader<BufReader<_>> = ImageReader::with_format(input.reader, format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(budget);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(fault)?;
    let (width, height) = decoder.dimensions();
    let (number, components) = match decoder.color_type() {
        ColorType::L8 => (FileNumberType::U8, 1),
        ColorType::La8 => (FileNumberType::U8, 2),
        ColorType::Rgb8 => (FileNumberType::U8, 3),
        ColorType::Rgba8 => (FileNumberType::U8, 4),
        ColorType::L16 => (FileNumberType::U16, 1),
        ColorType::La16 => (FileNumberType::U16, 2),
        ColorType::Rgb16 => (FileNumberType::U16, 3),
        ColorType::Rgba16 => (FileNumberType::U16, 4),
        other => {
            return Err(context.bad_input_error(
                "data",
                format!("its colour type {other:?} is not supported"),
                HELP,
            ));
        }
    };
    let component = options.choice.resolve_component(components, true);
    let part = ScalarReduction::require(context, component, components, true)?;
    // Decoders return numbers in machine byte order.
    let endian = if cfg!(target_endian = "big") { Endian::Big } else { Endian::Little };
    let stored = VoxelEncoding { number, endian, components, reduction: part };
    let header = PictureHeader { size: [width.into(), height.into()], stored, pages: 1 };
    let total = decoder.total_bytes();
    if total > budget {
        return Err(too_large(total));
    }
    if u64::from(width).saturating_mul(height.into()) > most_pixels {
        let found =
            format!("the picture is truncated: {width} x {height} pixels do not fit in {length} bytes");
        return Err(context.bad_input_error("data", found, HELP));
    }
    let mut bytes = Vec::new();
    if is_decoded {
        let count = usize::try_from(total).ok();
        bytes = count.and_then(|count| alloc_with_capacity(count).ok()).ok_or_else(|| too_large(total))?;
        bytes.resize(bytes.capacity().min(count.unwrap_or(0)), 0);
        decoder.read_image(&mut bytes).map_err(fault)?;
    }
    guard.check_unchanged(context, Ok((header, bytes)))
}
