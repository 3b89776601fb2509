//! What happens when the process is told to end: Ctrl+C, the end of the terminal, logging out.

use std::sync::{Mutex, PoisonError};

use crate::export::remove_unfinished;

/// What the shell has for a process that was interrupted.
const INTERRUPTED: i32 = 130;

/// What is done first.
static LAST_ACTS: Mutex<Vec<fn()>> = Mutex::new(Vec::new());

/// Does something before the process ends.
pub(super) fn before_the_end(act: fn()) {
    LAST_ACTS.lock().unwrap_or_else(PoisonError::into_inner).push(act);
}

/// Ends the process without the destructors of threads that are in the middle of something.
#[expect(
    clippy::exit,
    reason = "whoever sent the signal waits for the process, and all that matters is on the disk"
)]
fn end() -> ! {
    std::process::exit(INTERRUPTED)
}

/// Listens, from now on, on a thread of its own.
pub(super) fn listen() {
    let handler = || {
        for act in LAST_ACTS.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            act();
        }
        remove_unfinished();
        end();
    };
    if let Err(err) = ctrlc::set_handler(handler) {
        log::warn!("files that are being written will stay when this is interrupted: {err}");
    }
}
