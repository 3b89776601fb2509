//! Errors of writing and opening files.

use std::path::{Path, PathBuf};

/// Reason why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file system reported an error.
    #[error("could not write: {source} ({path}); choose an existing, writable folder")]
    Io {
        /// Path of the file to be written.
        path: PathBuf,
        /// Cause of the failure.
        source: std::io::Error,
    },
    /// The name cannot be given to the requested content.
    #[error("{what} ({path})")]
    Unsupported {
        /// Limitation of the name or the format, and a suggestion.
        what: &'static str,
        /// Path of the file to be written.
        path: PathBuf,
    },
}

impl WriteError {
    /// Returns a function that wraps an I/O error with the path of the file.
    pub fn io_error_for(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| Self::Io { path: path.to_owned(), source }
    }
}

/// Reason why a file could not be opened for reading.
#[derive(Debug, thiserror::Error)]
#[error("could not read: {why} ({path})")]
pub struct OpenFileError {
    /// Path of the file.
    pub path: PathBuf,
    /// Error of the operating system, or that the file is not a regular one.
    pub why: String,
}

impl OpenFileError {
    /// Creates an error for a file, with a reason.
    pub(crate) fn new(path: &Path, why: &dyn std::fmt::Display) -> Self {
        Self { path: path.to_owned(), why: why.to_string() }
    }
}
