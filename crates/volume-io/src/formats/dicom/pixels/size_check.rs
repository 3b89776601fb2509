//! Plausibility of file sizes: the announced frames must fit in the file before memory for them is allocated.

use super::super::header::DicomHeader;
use super::super::header::transfer_syntax::{PixelCodec, UnsupportedSyntax};
use super::layout::{PixelLayout, PixelNumber};
use chiaroscuro_volume::{LoadContext, LoadError};

/// Advice for files that are incomplete.
pub(super) const COPY_ADVICE: &str = "copy or export the file again";

impl PixelCodec {
    /// Returns the maximum number of pixel bytes that `packed` bytes of a file can encode. Decoders take time and
    /// memory for all announced pixels, whatever the data hold.
    fn max_decoded_bytes(self, packed: u64, frames: u64, shape: &PixelLayout) -> u64 {
        let of_number = shape.bytes_per_number() as u64;
        // Codecs of bytes hold eight pixels of one bit in each, which are a byte each once they are unpacked.
        let of_byte = if shape.number == PixelNumber::Bit { 8 } else { 1 };
        match self {
            Self::Native if shape.number == PixelNumber::Bit => packed.saturating_mul(of_byte),
            Self::Native => u64::MAX,
            Self::Deflated => packed.saturating_mul(MAX_DEFLATE_RATIO * of_byte),
            // Two bytes repeat a byte at most 128 times (PS3.5, G.3.1).
            Self::Rle => packed.saturating_mul(64 * of_byte),
            // At least one bit per block of 8 x 8 numbers, some of which stand for four pixels each.
            Self::Jpeg => packed.saturating_mul(8 * 64 * 2 * of_number),
            // Runs and empty packets have no bound; uniform images take a few hundred bytes.
            Self::JpegLs | Self::Jpeg2000 => {
                let with_empty = packed.saturating_add(frames.saturating_mul(MAX_EMPTY_RATIO));
                with_empty.saturating_mul(MAX_EMPTY_RATIO * of_number)
            }
        }
    }
}

/// Bytes added to the size of each compressed image, as nearly empty ones take hardly any; also the numbers that a
/// byte may encode. A uniform image of 4096² pixels thus fits in no bytes at all.
const MAX_EMPTY_RATIO: u64 = 4096;

/// Maximum expansion ratio of Deflate, in bytes per compressed byte.
const MAX_DEFLATE_RATIO: u64 = 1032;

/// Returns the codec of a file's pixels.
///
/// # Errors
/// `BadInput` if the codec is not supported.
pub(crate) fn supported_codec(
    context: LoadContext<'_>,
    header: &DicomHeader,
) -> Result<PixelCodec, LoadError> {
    header.syntax.codec.as_ref().copied().map_err(|UnsupportedSyntax { name, advice: help, .. }| {
        context.bad_input_error(
            "Transfer Syntax",
            format!("its pixel compression is not supported: {name}"),
            *help,
        )
    })
}

/// Checks that the file is large enough for the frames that it announces, before memory for them is allocated.
pub(crate) fn check_file_size(
    context: LoadContext<'_>,
    header: &DicomHeader,
    shape: &PixelLayout,
) -> Result<(), LoadError> {
    let Some(pixels) = header.pixels else { return Ok(()) };
    let count = header.frame_count();
    let available = header.file_bytes.saturating_sub(pixels.offset);
    let fits = |codec: PixelCodec| {
        shape.bytes_per_frame().saturating_mul(count) <= codec.max_decoded_bytes(available, count, shape)
    };
    match pixels.length {
        // Each fragment begins with 8 bytes of tag and length.
        None if count > available / 8 => Err(context.bad_input_error(
            "Number of Frames",
            format!("the file is too short for the {count} frames that it announces"),
            COPY_ADVICE,
        )),
        None if header.syntax.codec.as_ref().is_ok_and(|codec| !fits(*codec)) => {
            let PixelLayout { columns, rows, .. } = shape;
            let found = format!(
                "the data are truncated: {count} frames of {columns} x {rows} pixels do not fit in {available} \
                 compressed bytes"
            );
            Err(context.bad_input_error("Pixel Data", found, COPY_ADVICE))
        }
        None => Ok(()),
        Some(length) => {
            // Bounds the number of frames even if they have no pixels.
            let least = if shape.number == PixelNumber::Bit { 0 } else { count };
            let expected = shape.stored_bytes(count).max(least);
            let most = if header.syntax.is_deflated {
                header.file_bytes.saturating_mul(MAX_DEFLATE_RATIO)
            } else {
                length
            };
            if expected <= most { Ok(()) } else { Err(truncated_error(context, shape, count, length)) }
        }
    }
}

pub(super) fn truncated_error(
    context: LoadContext<'_>,
    shape: &PixelLayout,
    count: u64,
    found: u64,
) -> LoadError {
    let expected = shape.stored_bytes(count);
    let (columns, rows) = (shape.columns, shape.rows);
    context.bad_input_error(
        "Pixel Data",
        format!(
            "the data are truncated: {expected} bytes expected for {count} frames of {columns} x {rows} pixels, \
             {found} found"
        ),
        COPY_ADVICE,
    )
}
