//! Error messages about defects of TIFF files.

use std::io;

use chiaroscuro_volume::{LoadContext, LoadError};

/// Help text for broken files.
pub(super) const HELP: &str = "copy the file again, or save it anew with the program that wrote it";

/// Error for an unreadable or invalid part of a file, which `field` names.
pub(super) fn unreadable_error(context: LoadContext<'_>, field: &str, error: io::Error) -> LoadError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            context.bad_input_error(field, "the file is truncated: it points to bytes beyond its end", HELP)
        }
        io::ErrorKind::InvalidData => context.bad_input_error(field, "it holds invalid values", HELP),
        io::ErrorKind::Unsupported => {
            let why = "its pages have several layers (ImageDepth): only the first would be read";
            context.bad_input_error(field, why, "save it anew with a page for each slice")
        }
        _ => context.io_error(error),
    }
}

/// Name of an unsupported compression scheme for messages.
pub(super) fn compression_name(compression: u64) -> &'static str {
    match compression {
        2..=4 => "CCITT fax",
        34892 | 65000 => "camera JPEG",
        33003 | 33004 | 33005 | 34712 => "JPEG 2000",
        34925 => "LZMA",
        34887 => "LERC",
        34934 | 22610 => "JPEG XR",
        50001 => "WebP",
        50002 | 52546 => "JPEG XL",
        _ => "unknown",
    }
}
