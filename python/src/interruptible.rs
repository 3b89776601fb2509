//! Work that Ctrl+C ends: it runs on a thread of its own, while the calling thread looks for signals.

use std::process;
use std::sync::OnceLock;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use chiaroscuro_volume::CancelToken;
use pyo3::prelude::*;

use crate::errors::ExceptionClass;

/// Interval at which signals are looked for: a quarter of the fifth of a second in which Ctrl+C is expected to act.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Process that first used the package.
static FIRST_PROCESS: OnceLock<u32> = OnceLock::new();

/// Returns an error in a fork of the process that first used the package: threads and graphics devices do not survive a
/// fork, and work would wait for them forever.
pub(crate) fn check_process() -> PyResult<()> {
    if *FIRST_PROCESS.get_or_init(process::id) == process::id() {
        return Ok(());
    }
    Err(ExceptionClass::ForkedProcess.error(
        "this process is a fork of one that has used chiaroscuro, whose threads and graphics device were not copied; \
         start workers afresh, by multiprocessing.get_context(\"spawn\") or \"forkserver\"",
    ))
}

/// Runs work without the interpreter's lock, and cancels it if a signal raises an exception, which is returned.
pub(crate) fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    check_process()?;
    let token = CancelToken::new();
    let (outcome, interrupt) = py.detach(|| {
        thread::scope(|scope| {
            let (done, is_done) = mpsc::channel::<()>();
            let worker = scope.spawn(|| {
                let result = token.run(work);
                drop(done);
                result
            });
            let mut interrupt = None;
            while is_done.recv_timeout(SIGNAL_INTERVAL) == Err(RecvTimeoutError::Timeout) {
                if interrupt.is_none() {
                    interrupt = Python::attach(|py| py.check_signals().err());
                    if interrupt.is_some() {
                        token.cancel();
                    }
                }
            }
            (worker.join(), interrupt)
        })
    });
    if let Some(interrupt) = interrupt {
        return Err(interrupt);
    }
    outcome.map_err(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        ExceptionClass::Error.error(format!("internal error, please report it: {said}"))
    })
}
