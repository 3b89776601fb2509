//! Background tasks: work on a named thread that would block the window, with the result in a channel.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, TryRecvError};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use eframe::egui;

use crate::app::text;

/// Number of running tasks in this process.
static RUNNING_TASKS: Mutex<usize> = Mutex::new(0);

/// Signalled whenever a task has ended.
static TASK_ENDED: Condvar = Condvar::new();

/// Guard that counts a task as running until it is dropped, after a panic too.
struct RunningTaskGuard;

impl RunningTaskGuard {
    fn new() -> Self {
        *RUNNING_TASKS.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        Self
    }
}

impl Drop for RunningTaskGuard {
    fn drop(&mut self) {
        *RUNNING_TASKS.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        TASK_ENDED.notify_all();
    }
}

/// Waits until no task runs, at most for `longest`: a graphics driver must not be unloaded while a thread executes in
/// it.
pub(crate) fn wait_for_all_tasks(longest: Duration) {
    let running = RUNNING_TASKS.lock().unwrap_or_else(PoisonError::into_inner);
    drop(TASK_ENDED.wait_timeout_while(running, longest, |running| *running > 0));
}

/// Handle to a task on its own thread. Dropping it discards the result, so that a late one replaces nothing.
#[derive(Debug)]
pub(crate) struct BackgroundTask<T> {
    receiver: mpsc::Receiver<Result<T, String>>,
}

impl<T: Send + 'static> BackgroundTask<T> {
    /// Runs a task on a thread with the given name; the window is repainted when it has ended.
    pub(crate) fn start(
        name: &str,
        ctx: &egui::Context,
        task: impl FnOnce() -> T + Send + 'static,
    ) -> io::Result<Self> {
        let (sender, receiver) = mpsc::channel();
        let ctx = ctx.clone();
        let counted = RunningTaskGuard::new();
        std::thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _counted = counted;
            let result = catch_unwind(AssertUnwindSafe(task)).map_err(|panic| panic_message(&*panic));
            // If the receiver was dropped, the result is discarded.
            drop(sender.send(result));
            ctx.request_repaint();
        })?;
        Ok(Self { receiver })
    }

    /// Takes the result, once; an error contains the message of a panic.
    pub(crate) fn take_result(&self) -> Option<Result<T, String>> {
        match self.receiver.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(text::thread_errors::NO_RESULT.to_owned())),
        }
    }
}

/// Returns the message of a panic.
pub(crate) fn panic_message(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<&str>().copied();
    said.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or(text::thread_errors::NO_REASON)
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(work: &BackgroundTask<T>) -> Result<T, String> {
        loop {
            if let Some(result) = work.take_result() {
                return result;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn tasks_that_nobody_wants_are_waited_for() {
        let ctx = egui::Context::default();
        let (sender, receiver) = mpsc::channel();
        drop(BackgroundTask::start("slow", &ctx, move || {
            std::thread::sleep(Duration::from_millis(50));
            sender.send(()).unwrap();
        }));
        wait_for_all_tasks(Duration::from_secs(10));
        receiver.try_recv().expect("the task has ended");
    }

    #[test]
    fn results_and_panics_arrive() {
        let ctx = egui::Context::default();
        assert_eq!(wait(&BackgroundTask::start("sum", &ctx, || 1 + 2).unwrap()), Ok(3));
        let broken: BackgroundTask<()> = BackgroundTask::start("broken", &ctx, || panic!("no luck")).unwrap();
        assert_eq!(wait(&broken), Err("no luck".to_owned()));
    }
}
