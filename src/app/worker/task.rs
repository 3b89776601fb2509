//! Work that would keep the window waiting: a named thread whose result comes by channel.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, TryRecvError};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use eframe::egui;

use crate::app::text;

/// How many tasks of this process run.
static RUNNING: Mutex<usize> = Mutex::new(0);

/// One of them has ended.
static ENDED: Condvar = Condvar::new();

/// Counts a task from its beginning to its end, however that comes.
struct Counted;

impl Counted {
    fn begin() -> Self {
        *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        Self
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        ENDED.notify_all();
    }
}

/// Waits until no task runs, but not for longer than that: a graphics driver must not be unloaded while a thread is
/// in it.
pub(crate) fn wait_for_all(longest: Duration) {
    let running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    drop(ENDED.wait_timeout_while(running, longest, |running| *running > 0));
}

/// A task on its own thread. Dropping this forgets the result, so a late one replaces nothing.
#[derive(Debug)]
pub(crate) struct Work<T> {
    receiver: mpsc::Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Work<T> {
    /// Runs a task on a thread of that name; the window is woken when it is done.
    pub(crate) fn start(
        name: &str,
        ctx: &egui::Context,
        task: impl FnOnce() -> T + Send + 'static,
    ) -> io::Result<Self> {
        let (sender, receiver) = mpsc::channel();
        let ctx = ctx.clone();
        let counted = Counted::begin();
        std::thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _counted = counted;
            let result = catch_unwind(AssertUnwindSafe(task)).map_err(|panic| panic_message(&*panic));
            // Nobody waits any more when the receiver is gone.
            drop(sender.send(result));
            ctx.request_repaint();
        })?;
        Ok(Self { receiver })
    }

    /// The result, once; an error says how the task panicked.
    pub(crate) fn take(&self) -> Option<Result<T, String>> {
        match self.receiver.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(text::work::NO_RESULT.to_owned())),
        }
    }
}

/// What a panic said.
pub(crate) fn panic_message(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<&str>().copied();
    said.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or(text::work::NO_REASON)
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(work: &Work<T>) -> Result<T, String> {
        loop {
            if let Some(result) = work.take() {
                return result;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn tasks_that_nobody_wants_are_waited_for() {
        let ctx = egui::Context::default();
        let (sender, receiver) = mpsc::channel();
        drop(Work::start("slow", &ctx, move || {
            std::thread::sleep(Duration::from_millis(50));
            sender.send(()).unwrap();
        }));
        wait_for_all(Duration::from_secs(10));
        receiver.try_recv().expect("the task has ended");
    }

    #[test]
    fn results_and_panics_arrive() {
        let ctx = egui::Context::default();
        assert_eq!(wait(&Work::start("sum", &ctx, || 1 + 2).unwrap()), Ok(3));
        let broken: Work<()> = Work::start("broken", &ctx, || panic!("no luck")).unwrap();
        assert_eq!(wait(&broken), Err("no luck".to_owned()));
    }
}
