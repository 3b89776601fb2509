//! Detection of a closed standard output (`>&-`): the runtime opens /dev/null in its place before `main`, so that
//! output would be lost without an error.

use std::sync::atomic::{AtomicBool, Ordering};

/// True if standard output was closed. It stays static: nothing else exists when it is set, before `main`.
static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Records that standard output was closed when the process started. To be called before the runtime starts.
pub fn note_closed_output() {
    IS_CLOSED.store(true, Ordering::Relaxed);
}

/// Returns true if standard output was closed when the process started.
pub(crate) fn is_output_closed() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}
