//! Watching a load from another thread, and stopping it.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::LoadError;
use super::size::Size;
use crate::data::interrupt::{Interrupt, Signal};

/// Shared by the thread that loads and the one that waits.
///
/// Whether it is cancelled is looked at before every block of at most 1 MiB that is read, and between pieces of what is
/// found out of the voxels. The counts are bytes of voxels, after inflating.
#[derive(Debug, Default)]
pub struct LoadControl {
    signal: Arc<Signal>,
    /// Bytes of voxels that are there.
    pub done_bytes: AtomicU64,
    /// Bytes of voxels in the whole volume; 0 until the header has been read.
    pub total_bytes: AtomicU64,
    weigh: Weigh,
}

/// Says of a volume whose size is known whether its voxels are read.
type Accepts = dyn Fn(&Size) -> bool + Send + Sync;

/// Who is asked, if anybody.
#[derive(Default)]
struct Weigh(Option<Box<Accepts>>);

impl fmt::Debug for Weigh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Weigh(somebody)" } else { "Weigh(nobody)" })
    }
}

impl LoadControl {
    /// A control that nobody has cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// A control for volumes of which somebody says whether they are read, once their size is known and before their voxels
    /// take any memory. Loading fails with [`LoadError::Cancelled`] where they are not; of what the user has said how much
    /// is read of it nobody is asked.
    pub fn weighing(accepts: impl Fn(&Size) -> bool + Send + Sync + 'static) -> Self {
        Self { weigh: Weigh(Some(Box::new(accepts))), ..Self::default() }
    }

    pub(super) fn accepts(&self, size: &Size) -> bool {
        self.weigh.0.as_ref().is_none_or(|accepts| accepts(size))
    }

    /// Asks the load to stop; it then fails with [`LoadError::Cancelled`].
    pub fn cancel(&self) {
        self.signal.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.signal.is_cancelled.load(Ordering::Relaxed)
    }

    /// The share that is there, 0 … 1, once the size is known.
    pub fn fraction(&self) -> Option<f64> {
        self.bytes().map(|[done, total]| done as f64 / total as f64)
    }

    /// Bytes that are there, and all of them, once that is known.
    pub fn bytes(&self) -> Option<[u64; 2]> {
        let total = self.total_bytes.load(Ordering::Relaxed);
        (total > 0).then(|| [self.done_bytes.load(Ordering::Relaxed).min(total), total])
    }

    pub(in crate::data) fn start(&self, total_bytes: u64) {
        self.done_bytes.store(0, Ordering::Relaxed);
        self.total_bytes.store(total_bytes, Ordering::Relaxed);
    }

    pub(in crate::data) fn advance(&self, bytes: u64) {
        self.done_bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    pub(in crate::data) fn check(&self) -> Result<(), LoadError> {
        if self.signal.is_due() { Err(LoadError::Cancelled) } else { Ok(()) }
    }

    /// Does work that is given up when this is cancelled. What comes of it then is to be thrown away.
    pub(crate) fn during<T>(&self, work: impl FnOnce() -> T) -> T {
        Interrupt::of(&self.signal).during(work)
    }

    /// Pieces of work that were begun: blocks that were read, slices that were counted. None of them takes longer than a
    /// slice does.
    pub fn begun(&self) -> u64 {
        self.signal.begun.load(Ordering::Relaxed)
    }

    /// Cancels it by itself after so many pieces.
    #[cfg(any(test, feature = "testing"))]
    pub fn cancel_after(&self, pieces: u64) {
        self.signal.last.store(pieces.max(1), Ordering::Relaxed);
    }
}
