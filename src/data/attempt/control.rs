//! Watching a load from another thread, and stopping it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::error::LoadError;

/// Shared by the thread that loads and the one that waits.
///
/// Loading looks at `cancel` before every block of at most 1 MiB. The counts are bytes of voxels,
/// after inflating.
#[derive(Debug, Default)]
pub struct LoadControl {
    /// Set it to stop loading.
    pub cancel: AtomicBool,
    /// Bytes of voxels that are there.
    pub done_bytes: AtomicU64,
    /// Bytes of voxels in the whole volume; 0 until the header has been read.
    pub total_bytes: AtomicU64,
}

impl LoadControl {
    /// A control that nobody has cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the load to stop; it then fails with [`LoadError::Cancelled`].
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// The share that is there, 0 … 1, once the size is known.
    pub fn fraction(&self) -> Option<f64> {
        let total = self.total_bytes.load(Ordering::Relaxed);
        let done = self.done_bytes.load(Ordering::Relaxed);
        (total > 0).then(|| (done as f64 / total as f64).min(1.0))
    }

    pub(in crate::data) fn start(&self, total_bytes: u64) {
        self.done_bytes.store(0, Ordering::Relaxed);
        self.total_bytes.store(total_bytes, Ordering::Relaxed);
    }

    pub(in crate::data) fn advance(&self, bytes: u64) {
        self.done_bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    pub(in crate::data) fn check(&self) -> Result<(), LoadError> {
        if self.is_cancelled() { Err(LoadError::Cancelled) } else { Ok(()) }
    }
}
