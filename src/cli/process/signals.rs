//! Termination signals: Ctrl+C, a closed terminal, logging out.

#[cfg(unix)]
use std::sync::Arc;

use chiaroscuro_files::remove_own_temporary_files;

/// Base of the exit code that shells report for a process ended by a signal; the signal's number is added.
const SIGNAL_EXIT_BASE: i32 = 128;

/// Runs the last acts and ends the process without running destructors of threads that are still working.
fn run_last_acts_and_exit(last_acts: &[fn()], signal: i32) -> ! {
    for act in last_acts {
        act();
    }
    remove_own_temporary_files();
    exit_now(SIGNAL_EXIT_BASE + signal)
}

/// Ends the process immediately: exit handlers of libraries, such as drivers that stop their threads, would crash
/// while those threads are rendering.
#[cfg(unix)]
fn exit_now(code: i32) -> ! {
    signal_hook::low_level::exit(code)
}

/// Ends the process with an exit code.
#[cfg(not(unix))]
#[expect(
    clippy::exit,
    reason = "the sender of the signal waits for the process, and all files have been saved"
)]
fn exit_now(code: i32) -> ! {
    std::process::exit(code)
}

/// Starts a thread that listens for termination signals and runs `last_acts` before the process ends.
pub(crate) fn listen_for_signals(last_acts: &'static [fn()]) {
    if let Err(err) = spawn_listener(last_acts) {
        log::warn!(
            "signals cannot be handled, so temporary files remain if the program is interrupted: {err}"
        );
    }
}

#[cfg(unix)]
fn spawn_listener(last_acts: &'static [fn()]) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    // Beyond a file size limit (`ulimit -f`) SIGXFSZ would end the process; with a handler, the write fails as on a
    // full disk, and no unfinished file remains.
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;

    let ignored = ignored_signals(&std::fs::read_to_string("/proc/self/status").unwrap_or_default());
    // Signals that are already ignored stay ignored, as `nohup` and background jobs of shell scripts require.
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = Signals::new(heard)?;
    let listen = move || {
        if let Some(signal) = signals.forever().next() {
            run_last_acts_and_exit(last_acts, signal);
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(listen).map(drop)
}

#[cfg(not(unix))]
fn spawn_listener(last_acts: &'static [fn()]) -> Result<(), ctrlc::Error> {
    // Signal number of Ctrl+C (SIGINT) on other systems.
    ctrlc::set_handler(move || run_last_acts_and_exit(last_acts, 2))
}

/// Parses the mask of ignored signals from Linux's `/proc/self/status`: one bit per signal, bit 0 for signal 1.
/// Returns 0 if the field is missing.
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
