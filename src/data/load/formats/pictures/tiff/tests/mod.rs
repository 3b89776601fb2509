//! TIFF files from the outside: what is read and what is refused.

mod broken;
mod numbers;
mod ome;
mod stacks;
mod writer;

use std::path::Path;

use crate::data::load::{Choice, LoadControl, LoadError, LoadErrorKind, LoadOptions, load};
use crate::data::{Samples, Volume};

fn load_with(path: &Path, choice: Choice) -> Result<Volume, LoadError> {
    let options = LoadOptions { memory_budget_bytes: 1 << 20, choice, ..LoadOptions::default() };
    load(path, &options, &LoadControl::new())
}

fn load_chosen(bytes: &[u8], choice: Choice) -> Result<Volume, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    // Without its ending: it is told by how it begins.
    let path = folder.path().join("stack.bin");
    std::fs::write(&path, bytes).unwrap();
    load_with(&path, choice)
}

fn load_bytes(bytes: &[u8]) -> Result<Volume, LoadError> {
    load_chosen(bytes, Choice::default())
}

#[track_caller]
fn samples_of(bytes: &[u8]) -> Samples {
    load_bytes(bytes).unwrap().samples().clone()
}

#[track_caller]
fn assert_refused<T: std::fmt::Debug>(result: Result<T, LoadError>, kind: LoadErrorKind, words: &[&str]) {
    let error = result.unwrap_err();
    let message = error.to_string();
    assert_eq!(error.kind(), kind, "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}
