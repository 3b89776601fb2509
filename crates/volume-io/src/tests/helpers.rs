//! Helper functions for the tests of readers.

use std::fmt::Debug;
use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use tempfile::TempDir;

use super::super::{LoadOptions, load};
use chiaroscuro_volume::{LoadControl, LoadError, LoadErrorKind, Volume, VolumeChoice};

/// Loads a file with a budget of 1 MiB of voxels.
pub(crate) fn load_path(path: &Path, choice: VolumeChoice) -> Result<Volume, LoadError> {
    let options = LoadOptions { choice, memory_budget_bytes: 1 << 20, ..LoadOptions::default() };
    load(path, &options, &LoadControl::new())
}

/// Loads bytes from a file of this name, alone in its folder.
pub(crate) fn load_bytes(name: &str, bytes: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    load_path(&path, choice)
}

#[track_caller]
pub(crate) fn assert_refused<T: Debug>(result: Result<T, LoadError>, kind: LoadErrorKind, words: &[&str]) {
    let error = result.unwrap_err();
    let message = error.to_string();
    assert_eq!(error.kind(), kind, "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub(crate) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}
