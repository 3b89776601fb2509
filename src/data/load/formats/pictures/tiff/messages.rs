//! Error messages about defects of TIFF files.

use std::io;

use crate::data::load::LoadError;
use crate::data::load_context::LoadContext;

/// Help text for broken files.
pub(super) const HELP: &str = "copy the file again, or save it anew with the program that wrote it";

/// Error for an unreadable or invalid part of a file, which `field` names.
pub(super) fn unreadable_error(attempt: LoadContext<'_>, field: &str, error: io::Error) -> LoadError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            attempt.bad_input_error(field, "the file is truncated: it points to bytes beyond its end", HELP)
        }
        io::ErrorKind::InvalidData => attempt.bad_input_error(field, "it holds what cannot be there", HELP),
        io::ErrorKind::Unsupported => {
            let why = "its pages have a depth (ImageDepth), of which only the first layer would be read";
            attempt.bad_input_error(field, why, "save it anew with a page for each slice")
        }
        _ => attempt.io_error(error),
    }
}

/// Name of an unsupported compression scheme for messages.
pub(super) fn compression_name(compression: u64) -> &'static str {
    match compression {
        2..=4 => "for fax machines (CCITT)",
        34892 | 65000 => "as JPEG of a camera",
        33003 | 33004 | 33005 | 34712 => "as JPEG 2000",
        34925 => "as LZMA",
        34887 => "as LERC",
        34934 | 22610 => "as JPEG XR",
        50001 => "as WebP",
        50002 | 52546 => "as JPEG XL",
        _ => "in a way that is not known",
    }
}
