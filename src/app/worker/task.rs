//! Work that would keep the window waiting: a named thread whose result comes by channel.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, TryRecvError};

use eframe::egui;

use crate::app::text;

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
        std::thread::Builder::new().name(name.to_owned()).spawn(move || {
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
    use std::time::Duration;

    fn wait<T: Send + 'static>(work: &Work<T>) -> Result<T, String> {
        loop {
            if let Some(result) = work.take() {
                return result;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn results_and_panics_arrive() {
        let ctx = egui::Context::default();
        assert_eq!(wait(&Work::start("sum", &ctx, || 1 + 2).unwrap()), Ok(3));
        let broken: Work<()> = Work::start("broken", &ctx, || panic!("no luck")).unwrap();
        assert_eq!(wait(&broken), Err("no luck".to_owned()));
    }
}
