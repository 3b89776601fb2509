//! What happens when the process is told to end: Ctrl+C, the end of the terminal, logging out.

#[cfg(unix)]
use std::sync::Arc;

use crate::export::remove_unfinished;

/// What shells have for a process that a signal has ended: this and the signal's number.
const SIGNALLED: i32 = 128;

/// Does what must be done before the process ends, and ends it without the destructors of threads that are in the
/// middle of something.
fn end(last_acts: &[fn()], signal: i32) -> ! {
    for act in last_acts {
        act();
    }
    remove_unfinished();
    leave(SIGNALLED + signal)
}

/// Ends the process at once: what libraries do at an exit, such as drivers that take their threads down, would crash
/// where these are drawing.
#[cfg(unix)]
fn leave(code: i32) -> ! {
    signal_hook::low_level::exit(code)
}

/// Ends the process.
#[cfg(not(unix))]
#[expect(
    clippy::exit,
    reason = "whoever sent the signal waits for the process, and all that matters is on the disk"
)]
fn leave(code: i32) -> ! {
    std::process::exit(code)
}

/// Listens, from now on, on a thread of its own. Before the process ends, some things are done.
pub(in crate::cli) fn listen(last_acts: &'static [fn()]) {
    if let Err(err) = start(last_acts) {
        log::warn!("files that are being written will stay when this is interrupted: {err}");
    }
}

#[cfg(unix)]
fn start(last_acts: &'static [fn()]) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    // Beyond a limit of the user's (`ulimit -f`) the system would end the process; where the signal is taken, the write fails
    // as on a full disk, and nothing unfinished stays.
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;

    let ignored = ignored_signals(&std::fs::read_to_string("/proc/self/status").unwrap_or_default());
    // Whoever starts this with `nohup`, or behind a shell script, has said that it goes on.
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = Signals::new(heard)?;
    let listen = move || {
        if let Some(signal) = signals.forever().next() {
            end(last_acts, signal);
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(listen).map(drop)
}

#[cfg(not(unix))]
fn start(last_acts: &'static [fn()]) -> Result<(), ctrlc::Error> {
    // The number that Ctrl+C has elsewhere.
    ctrlc::set_handler(move || end(last_acts, 2))
}

/// The signals that a process ignores, one bit for each, the first for signal 1: from what Linux says of it in
/// `/proc/self/status`. None where nothing is said.
#[cfg(unix)]
fn ignored_signals(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_read() {
        assert_eq!(ignored_signals("Name:\tx\nSigBlk:\t01\nSigIgn:\t0000000000001001\n"), 0x1001);
        assert_eq!((ignored_signals(""), ignored_signals("SigIgn:\tmany\n")), (0, 0));
    }
}
