//! Fuzz target: a reader of the program on bytes from libFuzzer. `CHIAROSCURO_READER` selects the reader by the name of
//! its sample (`tests/faults/samples.rs`); without it, the names are printed. A valid file is added to the corpus first.

#![no_main]

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use samples::{SampleFile, samples};

#[path = "../../tests/faults/samples.rs"]
mod samples;

/// Reader under test.
struct Reader {
    /// Path of the file into which each input is written.
    path: PathBuf,
    read: fn(&Path) -> bool,
    /// Temporary folder, removed when the process ends normally.
    _folder: tempfile::TempDir,
}

static READER: OnceLock<Reader> = OnceLock::new();

/// Creates a temporary folder, in memory if possible: a disk would be the slowest part.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a folder")
}

fn begin() {
    let folder = folder();
    let samples = samples(folder.path());
    let wanted = std::env::var("CHIAROSCURO_READER").unwrap_or_default();
    let Some(SampleFile { name, bytes, read }) = samples.iter().find(|sample| sample.name == wanted) else {
        samples.iter().for_each(|sample| println!("{}", sample.name));
        std::process::exit(i32::from(!wanted.is_empty()));
    };
    if let Some(corpus) = std::env::var_os("CHIAROSCURO_CORPUS") {
        std::fs::create_dir_all(&corpus).expect("a folder");
        std::fs::write(Path::new(&corpus).join("valid"), bytes).expect("room");
    }
    READER.get_or_init(|| Reader { path: folder.path().join(name), read: *read, _folder: folder });
}

fuzz_target!(init: begin(), |bytes: &[u8]| {
    if let Some(Reader { path, read, .. }) = READER.get() {
        std::fs::write(path, bytes).expect("room");
        read(path);
    }
});
