//! Progress and cancellation of a load, shared between threads.

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::error::LoadError;
use super::memory_estimate::VolumeSize;
use crate::cancellation::CancelToken;

/// Progress counter and cancel token of a load, shared by the loading thread and the waiting one.
///
/// The token is checked before every block of at most 1 MiB that is read, and between pieces of the later analysis of
/// the voxels. Counts are bytes of voxels after decompression.
#[derive(Debug, Default)]
pub struct LoadControl {
    token: CancelToken,
    /// Bytes of voxels read until now.
    pub done_bytes: AtomicU64,
    /// Bytes of voxels in the whole volume; 0 until the header has been read.
    pub total_bytes: AtomicU64,
    /// Time of the analysis after reading, in nanoseconds.
    analysis_ns: AtomicU64,
    size_check: SizeCheck,
    /// Callback that says which sizes need no question, if there is one.
    comfortable_size: SizeCheck,
    /// Files that were read: a header names others, and a slice brings its series.
    read_files: Mutex<BTreeSet<PathBuf>>,
    /// True if blocks are averaged while they are read although all voxels fit into memory; only tests set it.
    is_memory_scarce: bool,
}

/// Callback that decides, by the size of a volume, whether its voxels are read.
type SizeCallback = dyn Fn(&VolumeSize) -> bool + Send + Sync;

/// Callback that is asked before a volume's voxels are read, if there is one.
#[derive(Default)]
struct SizeCheck(Option<Box<SizeCallback>>);

impl fmt::Debug for SizeCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "SizeCheck(set)" } else { "SizeCheck(none)" })
    }
}

impl LoadControl {
    /// Creates a control that is not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a control of work that is cancelled by the token.
    pub fn with_token(token: CancelToken) -> Self {
        Self { token, ..Self::default() }
    }

    /// Creates a control that asks `accepts` once the size of a volume is known, before its voxels take any memory.
    /// Loading fails with [`LoadError::Cancelled`] if it returns false. It is not asked if the user has already
    /// chosen a portion.
    pub fn with_size_check(accepts: impl Fn(&VolumeSize) -> bool + Send + Sync + 'static) -> Self {
        Self { size_check: SizeCheck(Some(Box::new(accepts))), ..Self::default() }
    }

    /// Adds a callback that says, without asking anybody, whether a volume of a size fits well: of several resolution
    /// levels the finest such is read.
    #[must_use]
    pub fn with_comfortable_size(self, fits: impl Fn(&VolumeSize) -> bool + Send + Sync + 'static) -> Self {
        Self { comfortable_size: SizeCheck(Some(Box::new(fits))), ..self }
    }

    /// Returns true if a volume of this size fits well.
    pub(super) fn is_size_comfortable(&self, size: &VolumeSize) -> bool {
        self.comfortable_size.0.as_ref().is_none_or(|fits| fits(size))
    }

    pub(super) fn accepts_size(&self, size: &VolumeSize) -> bool {
        self.size_check.0.as_ref().is_none_or(|accepts| accepts(size))
    }

    /// Returns the token by which the load is cancelled.
    pub fn token(&self) -> &CancelToken {
        &self.token
    }

    /// Requests the load to stop; it then fails with [`LoadError::Cancelled`].
    pub fn cancel(&self) {
        self.token.cancel();
    }

    /// Returns true if cancellation was requested.
    pub fn is_cancelled(&self) -> bool {
        self.token.is_cancelled()
    }

    /// Returns the completed share, 0 … 1, once the total size is known.
    pub fn fraction(&self) -> Option<f64> {
        self.bytes().map(|[done, total]| done as f64 / total as f64)
    }

    /// Returns completed and total bytes, once the total is known.
    pub fn bytes(&self) -> Option<[u64; 2]> {
        let total = self.total_bytes.load(Ordering::Relaxed);
        (total > 0).then(|| [self.done_bytes.load(Ordering::Relaxed).min(total), total])
    }

    /// Records a file from which voxels or metadata are read.
    pub fn record_read(&self, path: &Path) {
        let mut files = self.read_files.lock().unwrap_or_else(PoisonError::into_inner);
        // Series are recorded once for each slice.
        if !files.contains(path) {
            files.insert(path.to_owned());
        }
    }

    /// Returns the paths that were read until now, as they were opened.
    pub fn read_files(&self) -> Vec<PathBuf> {
        self.read_files.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    pub(super) fn is_memory_scarce(&self) -> bool {
        self.is_memory_scarce
    }

    /// Creates a control under which blocks are averaged while they are read, as if memory were scarce.
    #[cfg(any(test, feature = "testing"))]
    pub fn with_scarce_memory() -> Self {
        Self { is_memory_scarce: true, ..Self::default() }
    }

    /// Starts the count of voxels' bytes: none read until now, of `total_bytes` in the whole volume.
    pub fn start(&self, total_bytes: u64) {
        self.done_bytes.store(0, Ordering::Relaxed);
        self.total_bytes.store(total_bytes, Ordering::Relaxed);
    }

    /// Adds bytes of voxels that have been read, after decompression.
    pub fn advance(&self, bytes: u64) {
        self.done_bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Records how long the voxels' ranges and hash took, once they were read.
    pub fn set_analysis_time(&self, took: Duration) {
        self.analysis_ns.store(u64::try_from(took.as_nanos()).unwrap_or(u64::MAX), Ordering::Relaxed);
    }

    /// Returns the time taken for the voxels' ranges and hash: the part of loading that was neither reading nor
    /// decoding. Zero for volumes that come from no file.
    pub fn analysis_time(&self) -> Duration {
        Duration::from_nanos(self.analysis_ns.load(Ordering::Relaxed))
    }

    /// Counts a piece of work about to begin, and returns an error if it must not be done.
    ///
    /// # Errors
    /// [`LoadError::Cancelled`] if cancellation was requested.
    pub fn check(&self) -> Result<(), LoadError> {
        if self.token.should_stop() { Err(LoadError::Cancelled) } else { Ok(()) }
    }

    /// Runs work that stops early when this control is cancelled; its result must be discarded in that case.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> T {
        self.token.run(work)
    }

    /// Number of pieces of work that were begun, such as blocks read or slices counted. No piece takes longer than
    /// one slice.
    #[cfg(any(test, feature = "testing"))]
    pub fn pieces_begun(&self) -> u64 {
        self.token.pieces_begun()
    }

    /// Cancels the load automatically after the given number of pieces.
    #[cfg(any(test, feature = "testing"))]
    pub fn cancel_after(&self, pieces: u64) {
        self.token.cancel_after(pieces);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_recorded_once_for_each_load() {
        let [control, other] = [(); 2].map(|()| LoadControl::new());
        for name in ["b", "a", "b"] {
            control.record_read(Path::new(name));
        }
        assert_eq!(control.read_files(), [PathBuf::from("a"), PathBuf::from("b")]);
        assert!(other.read_files().is_empty());
    }
}
