//! Standard output that is closed (`>&-`): the runtime opens /dev/null in its place before `main`, so that everything written
//! there would be lost without an error.

use std::sync::atomic::{AtomicBool, Ordering};

static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Notes that standard output was closed when the process began. For who runs before the runtime does.
pub fn note_closed_output() {
    IS_CLOSED.store(true, Ordering::Relaxed);
}

/// Whether standard output was closed when the process began.
pub(in crate::cli) fn is_output_closed() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}
