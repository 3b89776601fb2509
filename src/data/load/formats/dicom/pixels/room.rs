//! Plausibility of file sizes: the announced frames must fit in the file before memory for them is allocated.

use super::super::header::Header;
use super::super::header::syntax::{Codec, NotRead};
use super::shape::{PixelNumber, Shape};
use crate::data::attempt::Attempt;
use crate::data::load::LoadError;

/// Advice for files that are incomplete.
pub(super) const HELP_COPY: &str = "copy or export the file again";

impl Codec {
    /// Returns the maximum number of pixel bytes that `packed` bytes of a file can encode. Decoders take time and
    /// memory for all announced pixels, whatever the data hold.
    fn most(self, packed: u64, frames: u64, shape: &Shape) -> u64 {
        let of_number = shape.bytes() as u64;
        match self {
            Self::Native => u64::MAX,
            // Two bytes repeat a byte at most 128 times (PS3.5, G.3.1).
            Self::Rle => packed.saturating_mul(64),
            // At least one bit per block of 8 x 8 numbers, some of which stand for four pixels each.
            Self::Jpeg => packed.saturating_mul(8 * 64 * 2 * of_number),
            // Runs and empty packets have no bound; uniform images take a few hundred bytes.
            Self::JpegLs | Self::Jpeg2000 => {
                let with_empty = packed.saturating_add(frames.saturating_mul(MOST_EMPTY));
                with_empty.saturating_mul(MOST_EMPTY * of_number)
            }
        }
    }
}

/// Bytes added to the size of each compressed image, as nearly empty ones take hardly any; also the numbers that a
/// byte may encode. A uniform image of 4096² pixels thus fits in no bytes at all.
const MOST_EMPTY: u64 = 4096;

/// Maximum expansion ratio of Deflate, in bytes per compressed byte.
const MOST_DEFLATED: u64 = 1032;

/// Returns the codec of a file's pixels.
///
/// # Errors
/// `BadInput` if the codec is not supported.
pub(crate) fn readable_codec(attempt: Attempt<'_>, header: &Header) -> Result<Codec, LoadError> {
    header.syntax.codec.as_ref().copied().map_err(|NotRead { name, help, .. }| {
        attempt.bad_input(
            "Transfer Syntax",
            format!("its pixels are compressed in a way that is not read: {name}"),
            *help,
        )
    })
}

/// Checks that the file is large enough for the frames that it announces, before memory for them is allocated.
pub(in crate::data::load::formats::dicom) fn check_room(
    attempt: Attempt<'_>,
    header: &Header,
    shape: &Shape,
) -> Result<(), LoadError> {
    let Some(pixels) = header.pixels else { return Ok(()) };
    let count = header.frame_count();
    let left = header.len.saturating_sub(pixels.offset);
    let is_roomy =
        |codec: Codec| shape.bytes_of_frame().saturating_mul(count) <= codec.most(left, count, shape);
    match pixels.length {
        // Each fragment begins with 8 bytes of tag and length.
        None if count > left / 8 => Err(attempt.bad_input(
            "Number of Frames",
            format!("the file has no room for the {count} frames that it announces"),
            HELP_COPY,
        )),
        None if header.syntax.codec.as_ref().is_ok_and(|codec| !is_roomy(*codec)) => {
            let Shape { columns, rows, .. } = shape;
            let found = format!(
                "the data are truncated: {count} frames of {columns} x {rows} pixels do not fit in {left} \
                 compressed bytes"
            );
            Err(attempt.bad_input("Pixel Data", found, HELP_COPY))
        }
        None => Ok(()),
        Some(length) => {
            // Bounds the number of frames even if they have no pixels.
            let least = if shape.number == PixelNumber::Bit { 0 } else { count };
            let expected = shape.stored_bytes(count).max(least);
            let most =
                if header.syntax.is_deflated { header.len.saturating_mul(MOST_DEFLATED) } else { length };
            if expected <= most { Ok(()) } else { Err(truncated(attempt, shape, count, length)) }
        }
    }
}

pub(super) fn truncated(attempt: Attempt<'_>, shape: &Shape, count: u64, found: u64) -> LoadError {
    let expected = shape.stored_bytes(count);
    let (columns, rows) = (shape.columns, shape.rows);
    attempt.bad_input(
        "Pixel Data",
        format!(
            "the data are truncated: {expected} bytes expected for {count} frames of {columns} x {rows} pixels, \
             {found} found"
        ),
        HELP_COPY,
    )
}
