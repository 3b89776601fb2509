//! Handle to one job: its result in a channel, its progress, and the token that cancels it.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, TryRecvError};
use std::time::Duration;

use eframe::egui;

use super::{JobKind, Jobs};
use crate::app::text;
use chiaroscuro_volume::{CancelOnDrop, CancelToken};

/// Progress of a job in parts; zero parts in total while their number is unknown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct JobProgress {
    /// Number of parts that are done.
    pub done: u32,
    /// Number of parts in total.
    pub total: u32,
}

/// State that a job shares with its handle: the token that it polls, and the progress that it reports.
#[derive(Debug, Default)]
pub(crate) struct JobControl {
    token: CancelToken,
    done: AtomicU32,
    total: AtomicU32,
}

impl JobControl {
    /// Creates the control of a job that a given token cancels, and that begins with some progress.
    pub(crate) fn with_token(token: CancelToken, begin: JobProgress) -> Self {
        Self { token, done: begin.done.into(), total: begin.total.into() }
    }

    /// Returns the token that cancels the job.
    pub(crate) fn token(&self) -> &CancelToken {
        &self.token
    }

    /// Reports the progress of the job.
    pub(crate) fn set_progress(&self, done: u32, total: u32) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    fn progress(&self) -> JobProgress {
        let [done, total] = [&self.done, &self.total].map(|count| count.load(Ordering::Relaxed));
        JobProgress { done, total }
    }
}

/// Handle to a job. Dropping it cancels the job and discards its result.
#[derive(Debug)]
pub(crate) struct JobHandle<T> {
    control: Arc<JobControl>,
    receiver: mpsc::Receiver<Result<T, String>>,
    cancel_on_drop: CancelOnDrop,
}

impl<T: Send + 'static> JobHandle<T> {
    /// Runs a task on a thread; the window is repainted when it has ended.
    pub(crate) fn start(
        kind: JobKind,
        ctx: &egui::Context,
        task: impl FnOnce(&JobControl) -> T + Send + 'static,
    ) -> io::Result<Self> {
        Self::start_with(kind, ctx, JobControl::default(), task)
    }

    /// Runs a task as [`Self::start`] does, with a control that was made before.
    ///
    /// The task polls the token where it can end early. It does not run under it ([`CancelToken::run`]), unless it
    /// says so itself: what is computed then may be incomplete, and a volume would keep it.
    pub(crate) fn start_with(
        kind: JobKind,
        ctx: &egui::Context,
        control: JobControl,
        task: impl FnOnce(&JobControl) -> T + Send + 'static,
    ) -> io::Result<Self> {
        let (sender, receiver) = mpsc::channel();
        let (control, ctx) = (Arc::new(control), ctx.clone());
        let registration = Jobs::from_context(&ctx).register(kind, control.token.clone());
        let shared = Arc::clone(&control);
        std::thread::Builder::new().name(kind.thread_name().to_owned()).spawn(move || {
            let _registration = registration;
            let result =
                catch_unwind(AssertUnwindSafe(|| task(&shared))).map_err(|panic| panic_message(&*panic));
            // If the receiver was dropped, the result is discarded.
            drop(sender.send(result));
            ctx.request_repaint();
        })?;
        let cancel_on_drop = CancelOnDrop::from(control.token.clone());
        Ok(Self { control, receiver, cancel_on_drop })
    }
}

impl<T> JobHandle<T> {
    /// Returns the token that cancels the job.
    pub(crate) fn token(&self) -> &CancelToken {
        self.cancel_on_drop.token()
    }

    /// Returns the progress that the job has reported.
    pub(crate) fn progress(&self) -> JobProgress {
        self.control.progress()
    }

    /// Takes the result, once; an error contains the message of a panic.
    pub(crate) fn take_result(&self) -> Option<Result<T, String>> {
        match self.receiver.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(text::thread_errors::NO_RESULT.to_owned())),
        }
    }

    /// Waits for the result and takes it; `None` after `longest`.
    pub(crate) fn wait(&self, longest: Duration) -> Option<Result<T, String>> {
        match self.receiver.recv_timeout(longest) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(text::thread_errors::NO_RESULT.to_owned())),
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

    #[test]
    fn results_and_panics_arrive() {
        let (ctx, longest) = (egui::Context::default(), Duration::from_mins(1));
        let sum = JobHandle::start(JobKind::Outline, &ctx, |job| {
            job.set_progress(1, 2);
            1 + 2
        });
        let sum = sum.unwrap();
        assert_eq!(sum.wait(longest), Some(Ok(3)));
        assert_eq!(sum.progress(), JobProgress { done: 1, total: 2 });
        let broken = JobHandle::<()>::start(JobKind::Outline, &ctx, |_| panic!("no luck")).unwrap();
        assert_eq!(broken.wait(longest), Some(Err("no luck".to_owned())));
        let again = Some(Err(text::thread_errors::NO_RESULT.to_owned()));
        assert_eq!(broken.wait(longest), again, "a result is taken once");
        assert_eq!(broken.take_result(), again);
    }
}
