//! Decompression warning for volumes that take far more memory than their well-compressed files.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::super::output::warn_line;
use chiaroscuro_volume::{LoadControl, LoadError, Portion, Volume, VolumeSize, human_bytes};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Bytes of voxels below which there is no warning: they are read in seconds.
const SMALL_BYTES: u64 = 1 << 30;

/// Ratio of voxel bytes to file bytes above which a warning is printed: photographs and scans have up to 10, label
/// maps up to 200, and zeros 1000 (zlib's maximum).
const MAX_USUAL_RATIO: u64 = 256;

/// Bytes of voxels that are read for an overview of the values: quick, and enough for percentiles.
const OVERVIEW_BYTES: u64 = 64 << 20;

/// Size of a file, in bytes, up to which it may be a header that refers to other files.
const MAX_HEADER_FILE_BYTES: u64 = 64 << 10;

/// Maximum number of files in a folder that are counted.
const MAX_COUNTED_FILES: usize = 100_000;

/// Largest stride between voxels that are read.
const MAX_STRIDE: usize = 64;

/// Opens a volume, with a warning if its files decompress to far more bytes than they have.
pub(crate) fn open_with_size_warning(source: &Path, options: &LoadOptions) -> Result<Volume, LoadError> {
    open(source, options, &control_with_size_warning(source))
}

/// Creates the control of a load, which warns if the volume's files decompress to far more bytes than they have.
pub(crate) fn control_with_size_warning(source: &Path) -> LoadControl {
    let stored = stored_bytes(source);
    let is_said = AtomicBool::new(false);
    LoadControl::with_size_check(move |size| {
        // Readers may call this more than once.
        if let Some(stored) = decompression_exceeds(stored, size)
            && !is_said.swap(true, Ordering::Relaxed)
        {
            let every = overview_stride(size)
                .map_or_else(String::new, |step| format!("; --every {step} reads a subsample"));
            warn_line(&format!("warning: {}{every}", size_text(stored, size)));
        }
        true
    })
}

/// Opens a volume for an overview of its values. If its files decompress to far more bytes than they have, only every
/// Nth voxel is read, unless the options specify a portion.
pub(crate) fn open_for_overview(source: &Path, options: &LoadOptions) -> Result<Volume, LoadError> {
    let stored = stored_bytes(source);
    let thinned = Arc::new(Mutex::new(None));
    let to = Arc::clone(&thinned);
    let control = LoadControl::with_size_check(move |size| {
        let Some((stored, step)) = decompression_exceeds(stored, size).zip(overview_stride(size)) else {
            return true;
        };
        warn_line(&format!(
            "warning: {}; they are read with a stride of {step} along each axis, --every 1 reads all of them",
            size_text(stored, size)
        ));
        *to.lock().unwrap_or_else(PoisonError::into_inner) = Some(step);
        false
    });
    let opened = open(source, options, &control);
    let step = thinned.lock().unwrap_or_else(PoisonError::into_inner).take();
    let Some(step) = step else { return opened };
    let mut options = options.clone();
    options.choice.portion = Some(Portion::with_stride(step));
    open(source, &options, &LoadControl::new())
}

/// Returns the bytes of a file, or of the files in a folder; `None` if they do not indicate the size of the voxels.
fn stored_bytes(source: &Path) -> Option<u64> {
    let metadata = std::fs::metadata(source).ok()?;
    if metadata.is_file() {
        return Some(metadata.len()).filter(|&bytes| bytes > MAX_HEADER_FILE_BYTES);
    }
    let files = std::fs::read_dir(source).ok()?.flatten().take(MAX_COUNTED_FILES);
    Some(
        files
            .filter_map(|file| file.metadata().ok())
            .filter(std::fs::Metadata::is_file)
            .map(|file| file.len())
            .sum(),
    )
}

/// Returns the bytes of the files, if they decompress to far more.
fn decompression_exceeds(stored: Option<u64>, size: &VolumeSize) -> Option<u64> {
    let bytes = size.bytes();
    stored.filter(|&stored| bytes >= SMALL_BYTES && bytes / MAX_USUAL_RATIO >= stored)
}

/// Returns the smallest stride at which few enough bytes are read.
fn overview_stride(size: &VolumeSize) -> Option<usize> {
    let of_voxel = size.voxel_type.bytes() as u64;
    (2..=MAX_STRIDE).find(|&step| {
        let dims = size.portion_dims(&Portion::with_stride(step)).unwrap_or(size.dims);
        dims.into_iter().fold(of_voxel, |bytes, n| bytes.saturating_mul(n as u64)) <= OVERVIEW_BYTES
    })
}

fn size_text(stored: u64, size: &VolumeSize) -> String {
    let [x, y, z] = size.dims;
    let [stored, bytes] = [stored, size.bytes()].map(|bytes| human_bytes(bytes.into()));
    format!("{stored} of files decompress to {x} × {y} × {z} voxels ({bytes})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::VoxelType;

    #[test]
    fn files_that_unfold_are_known_and_thinned() {
        let size = |dims: [usize; 3]| VolumeSize { dims, voxel_type: VoxelType::U8, is_read_whole: false };
        // Forty slices of 16000² zeros, compressed to 10 MB.
        let slices = size([16_000, 16_000, 40]);
        assert_eq!(decompression_exceeds(Some(10_000_000), &slices), Some(10_000_000));
        assert_eq!(overview_stride(&slices), Some(6));
        let words = size_text(10_000_000, &slices);
        assert_eq!(words, "9.5 MiB of files decompress to 16000 × 16000 × 40 voxels (9.5 GiB)");
        // Poorly compressible data, small data, and files of unknown size.
        assert_eq!(decompression_exceeds(Some(1 << 30), &slices), None);
        assert_eq!(decompression_exceeds(Some(1000), &size([512, 512, 512])), None);
        assert_eq!(decompression_exceeds(None, &slices), None);
        assert_eq!(overview_stride(&size([usize::MAX; 3])), None);
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
