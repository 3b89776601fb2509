//! Decompression warning for volumes that take far more memory than their well-compressed files.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::super::outputs::warn_line;
use crate::data::load::{LoadControl, LoadError, LoadOptions, Portion, Size, human_bytes};
use crate::data::{Volume, open};

/// Bytes of voxels below which there is no warning: they are read in seconds.
const SMALL_BYTES: u64 = 1 << 30;

/// Ratio of voxel bytes to file bytes above which a warning is printed: photographs and scans have up to 10, label
/// maps up to 200, and zeros 1000 (zlib's maximum).
const USUAL_RATIO: u64 = 256;

/// Bytes of voxels that are read for an overview of the values: quick, and enough for percentiles.
const GLANCE_BYTES: u64 = 64 << 20;

/// Size of a file, in bytes, up to which it may be a header that refers to other files.
const DESCRIPTION_BYTES: u64 = 64 << 10;

/// Maximum number of files in a folder that are counted.
const MOST_FILES: usize = 100_000;

/// Largest stride between voxels that are read.
const LONGEST_STEP: usize = 64;

/// Opens a volume, with a warning if its files decompress to far more bytes than they have.
pub(in crate::cli) fn open_with_word(source: &Path, options: &LoadOptions) -> Result<Volume, LoadError> {
    let stored = stored_bytes(source);
    let is_said = AtomicBool::new(false);
    let control = LoadControl::weighing(move |size| {
        // Readers may call this more than once.
        if let Some(stored) = unfolds(stored, size)
            && !is_said.swap(true, Ordering::Relaxed)
        {
            let every = glance(size).map_or_else(String::new, |step| format!("; --every {step} reads fewer"));
            warn_line(&format!("warning: {}{every}", in_words(stored, size)));
        }
        true
    });
    open(source, options, &control)
}

/// Opens a volume for an overview of its values. If its files decompress to far more bytes than they have, only every
/// Nth voxel is read, unless the options specify a portion.
pub(in crate::cli) fn open_for_a_glance(source: &Path, options: &LoadOptions) -> Result<Volume, LoadError> {
    let stored = stored_bytes(source);
    let thinned = Arc::new(Mutex::new(None));
    let to = Arc::clone(&thinned);
    let control = LoadControl::weighing(move |size| {
        let Some((stored, step)) = unfolds(stored, size).zip(glance(size)) else { return true };
        warn_line(&format!(
            "warning: {}; of every {step} along each axis one is read, --every 1 reads all of them",
            in_words(stored, size)
        ));
        *to.lock().unwrap_or_else(PoisonError::into_inner) = Some(step);
        false
    });
    let opened = open(source, options, &control);
    let step = thinned.lock().unwrap_or_else(PoisonError::into_inner).take();
    let Some(step) = step else { return opened };
    let mut options = options.clone();
    options.choice.portion = Some(Portion::every(step));
    open(source, &options, &LoadControl::new())
}

/// Returns the bytes of a file, or of the files in a folder; `None` if they do not indicate the size of the voxels.
fn stored_bytes(source: &Path) -> Option<u64> {
    let metadata = std::fs::metadata(source).ok()?;
    if metadata.is_file() {
        return Some(metadata.len()).filter(|&bytes| bytes > DESCRIPTION_BYTES);
    }
    let files = std::fs::read_dir(source).ok()?.flatten().take(MOST_FILES);
    Some(
        files
            .filter_map(|file| file.metadata().ok())
            .filter(std::fs::Metadata::is_file)
            .map(|file| file.len())
            .sum(),
    )
}

/// Returns the bytes of the files, if they decompress to far more.
fn unfolds(stored: Option<u64>, size: &Size) -> Option<u64> {
    let bytes = size.bytes();
    stored.filter(|&stored| bytes >= SMALL_BYTES && bytes / USUAL_RATIO >= stored)
}

/// Returns the smallest stride at which few enough bytes are read.
fn glance(size: &Size) -> Option<usize> {
    let of_voxel = size.voxel_type.bytes() as u64;
    (2..=LONGEST_STEP).find(|&step| {
        let dims = size.dims_of(&Portion::every(step)).unwrap_or(size.dims);
        dims.into_iter().fold(of_voxel, |bytes, n| bytes.saturating_mul(n as u64)) <= GLANCE_BYTES
    })
}

fn in_words(stored: u64, size: &Size) -> String {
    let [x, y, z] = size.dims;
    let [stored, bytes] = [stored, size.bytes()].map(|bytes| human_bytes(bytes.into()));
    format!("{stored} of files unfold to {x} × {y} × {z} voxels in {bytes}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::VoxelType;

    #[test]
    fn files_that_unfold_are_known_and_thinned() {
        let size = |dims: [usize; 3]| Size { dims, voxel_type: VoxelType::U8, is_read_whole: false };
        // Forty slices of 16000² zeros, compressed to 10 MB.
        let slices = size([16_000, 16_000, 40]);
        assert_eq!(unfolds(Some(10_000_000), &slices), Some(10_000_000));
        assert_eq!(glance(&slices), Some(6));
        let words = in_words(10_000_000, &slices);
        assert_eq!(words, "9.5 MiB of files unfold to 16000 × 16000 × 40 voxels in 9.5 GiB");
        // Poorly compressible data, small data, and files of unknown size.
        assert_eq!(unfolds(Some(1 << 30), &slices), None);
        assert_eq!(unfolds(Some(1000), &size([512, 512, 512])), None);
        assert_eq!(unfolds(None, &slices), None);
        assert_eq!(glance(&size([usize::MAX; 3])), None);
    }

    #[test]
    fn files_are_counted_and_descriptions_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, [0; 1000]).unwrap();
        assert_eq!((stored_bytes(&path), stored_bytes(folder.path())), (None, Some(1000)));
        std::fs::write(folder.path().join("b"), vec![0; 100_000]).unwrap();
        assert_eq!(stored_bytes(&folder.path().join("b")), Some(100_000));
        assert_eq!(
            (stored_bytes(folder.path()), stored_bytes(Path::new("builtin:box:16"))),
            (Some(101_000), None)
        );
    }
}
