//! Errors of writing files and of reading pictures.

use std::path::{Path, PathBuf};

use chiaroscuro_files::{OpenFileError, WriteError};

/// Reason why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The PNG encoder reported an error.
    #[error("the picture could not be encoded: {0}")]
    Encode(#[from] png::EncodingError),
    /// The EXR encoder reported an error.
    #[error("the picture could not be encoded: {0}")]
    Exr(#[from] exr::error::Error),
    /// The GIF encoder reported an error.
    #[error("the picture could not be encoded: {0}")]
    Gif(#[from] gif::EncodingError),
    /// The file could not be created, written or replaced.
    #[error(transparent)]
    File(#[from] WriteError),
    /// The file format cannot hold the requested content.
    #[error("{what} ({path})")]
    UnsupportedByFormat {
        /// Limitation of the format, and a suggestion.
        what: &'static str,
        /// Path of the file to be written.
        path: PathBuf,
    },
    /// The program ffmpeg, which encodes videos, was not found.
    #[error(
        "MP4 needs ffmpeg, and `{program}` could not be started: {source}; install it, or write .gif or .png"
    )]
    NoFfmpeg {
        /// Name of the program that was tried.
        program: String,
        /// Cause of the failure to start it.
        source: std::io::Error,
    },
    /// The program ffmpeg failed.
    #[error("ffmpeg failed: {said} ({path})")]
    Ffmpeg {
        /// Path of the file to be written.
        path: PathBuf,
        /// Last line of ffmpeg's error output.
        said: String,
    },
}

impl ExportError {
    /// Returns a function that wraps an I/O error with the path of the file.
    pub(super) fn io_error_for(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| WriteError::io_error_for(path)(source).into()
    }

    /// Returns a function that replaces an encoder's wrapped I/O error by one with the path of the file.
    pub(super) fn with_path(path: &Path) -> impl Fn(Self) -> Self {
        move |err| match err {
            Self::Encode(png::EncodingError::IoError(source))
            | Self::Exr(exr::error::Error::Io(source))
            | Self::Gif(gif::EncodingError::Io(source)) => WriteError::io_error_for(path)(source).into(),
            other => other,
        }
    }
}

/// Reason why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[error("could not read the picture: {why} ({path}); choose a PNG or EXR file exported by this program")]
pub struct ReadPictureError {
    /// Path of the picture file.
    path: PathBuf,
    /// Description of the problem.
    why: String,
}

impl ReadPictureError {
    /// Creates an error for a file, with a reason.
    pub(super) fn new(path: &Path, why: &dyn std::fmt::Display) -> Self {
        Self { path: path.to_owned(), why: why.to_string() }
    }
}

impl From<OpenFileError> for ReadPictureError {
    fn from(OpenFileError { path, why }: OpenFileError) -> Self {
        Self { path, why }
    }
}
