//! What can go wrong with files.

use std::path::{Path, PathBuf};

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The encoder refused.
    #[error("the picture could not be encoded: {0}")]
    Encode(#[from] png::EncodingError),
    /// The encoder of EXR files refused.
    #[error("the picture could not be encoded: {0}")]
    Exr(#[from] exr::error::Error),
    /// The encoder of GIF files refused.
    #[error("the picture could not be encoded: {0}")]
    Gif(#[from] gif::EncodingError),
    /// The disk refused.
    #[error("could not write: {source} ({path}); a folder that exists and can be written to helps")]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// The kind of file cannot hold this.
    #[error("{what} ({path})")]
    Unfit {
        /// What it cannot, and what can.
        what: &'static str,
        /// What was to be written.
        path: PathBuf,
    },
    /// There is no program to make videos with.
    #[error(
        "MP4 needs ffmpeg, and `{program}` could not be started: {source}; install it, or write .gif or .png"
    )]
    NoFfmpeg {
        /// Which was tried.
        program: String,
        /// Why it could not be started.
        source: std::io::Error,
    },
    /// That program failed.
    #[error("ffmpeg failed: {said} ({path})")]
    Ffmpeg {
        /// What was to be written.
        path: PathBuf,
        /// The last words of ffmpeg.
        said: String,
    },
}

impl ExportError {
    /// Says which file the disk refused.
    pub(super) fn writing(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| Self::Write { path: path.to_owned(), source }
    }

    /// Says which file the disk refused, where an encoder only passes on that it did.
    pub(super) fn about(path: &Path) -> impl Fn(Self) -> Self {
        move |err| match err {
            Self::Encode(png::EncodingError::IoError(source))
            | Self::Exr(exr::error::Error::Io(source))
            | Self::Gif(gif::EncodingError::Io(source)) => Self::Write { path: path.to_owned(), source },
            other => other,
        }
    }
}

/// Why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[error("could not read the picture: {why} ({path}); a PNG or EXR file that this program has exported helps")]
pub struct ReadPictureError {
    /// Which.
    path: PathBuf,
    /// What is wrong with it.
    why: String,
}

impl ReadPictureError {
    /// Of a file, for a reason.
    pub(super) fn new(path: &Path, why: &dyn std::fmt::Display) -> Self {
        Self { path: path.to_owned(), why: why.to_string() }
    }
}
