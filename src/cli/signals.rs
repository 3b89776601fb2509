//! What happens when the process is told to end: Ctrl+C, the end of the terminal, logging out.

use crate::export::remove_unfinished;

/// What the shell has for a process that was interrupted.
const INTERRUPTED: i32 = 130;

/// Ends the process without the destructors of threads that are in the middle of something.
#[expect(
    clippy::exit,
    reason = "whoever sent the signal waits for the process, and all that matters is on the disk"
)]
fn end() -> ! {
    std::process::exit(INTERRUPTED)
}

/// Listens, from now on, on a thread of its own. Before the process ends, some things are done.
pub(super) fn listen(last_acts: &'static [fn()]) {
    let handler = move || {
        for act in last_acts {
            act();
        }
        remove_unfinished();
        end();
    };
    if let Err(err) = ctrlc::set_handler(handler) {
        log::warn!("files that are being written will stay when this is interrupted: {err}");
    }
}
