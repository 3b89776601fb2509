//! Slot for the one job that the window runs at a place, with the inputs that its result belongs to.

use std::io;
use std::time::Duration;

use eframe::egui;

use super::{JobControl, JobHandle, JobKind, JobProgress};
use chiaroscuro_volume::CancelToken;

/// Slot for one job. A new job replaces the one before, which is cancelled and its result discarded.
#[derive(Debug)]
pub(crate) struct JobSlot<T, I = ()> {
    running: Option<(I, JobHandle<T>)>,
}

impl<T, I> Default for JobSlot<T, I> {
    fn default() -> Self {
        Self { running: None }
    }
}

impl<T: Send + 'static, I> JobSlot<T, I> {
    /// Starts a job and remembers its inputs. Where no thread can be started, the job before goes on.
    pub(crate) fn start(
        &mut self,
        kind: JobKind,
        ctx: &egui::Context,
        inputs: I,
        task: impl FnOnce(&JobControl) -> T + Send + 'static,
    ) -> io::Result<()> {
        self.start_with(kind, ctx, JobControl::default(), inputs, task)
    }

    /// Starts a job as [`Self::start`] does, with a control that was made before.
    pub(crate) fn start_with(
        &mut self,
        kind: JobKind,
        ctx: &egui::Context,
        control: JobControl,
        inputs: I,
        task: impl FnOnce(&JobControl) -> T + Send + 'static,
    ) -> io::Result<()> {
        self.running = Some((inputs, JobHandle::start_with(kind, ctx, control, task)?));
        Ok(())
    }
}

impl<T, I> JobSlot<T, I> {
    /// Returns true until the result of the job is taken.
    pub(crate) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Returns the inputs of the running job.
    pub(crate) fn inputs(&self) -> Option<&I> {
        self.running.as_ref().map(|(inputs, _)| inputs)
    }

    /// Returns the inputs of the running job, to be changed.
    pub(crate) fn inputs_mut(&mut self) -> Option<&mut I> {
        self.running.as_mut().map(|(inputs, _)| inputs)
    }

    /// Returns the token that cancels the running job.
    pub(crate) fn token(&self) -> Option<&CancelToken> {
        self.running.as_ref().map(|(_, job)| job.token())
    }

    /// Returns the progress that the running job has reported.
    pub(crate) fn progress(&self) -> Option<JobProgress> {
        self.running.as_ref().map(|(_, job)| job.progress())
    }

    /// Requests the running job to end early; its result is still taken.
    pub(crate) fn cancel(&self) {
        if let Some(token) = self.token() {
            token.cancel();
        }
    }

    /// Returns true if there is a job that was cancelled and has not ended.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.token().is_some_and(CancelToken::is_cancelled)
    }

    /// Cancels the running job and discards its result.
    pub(crate) fn discard(&mut self) {
        self.running = None;
    }

    /// Takes a job that has ended: its inputs and, once, its result; an error contains the message of a panic.
    pub(crate) fn take_ended(&mut self) -> Option<(I, Result<T, String>)> {
        let result = self.running.as_ref()?.1.take_result()?;
        self.running.take().map(|(inputs, _)| (inputs, result))
    }

    /// Waits for the end of the job, at most for `longest`, and discards its result.
    pub(crate) fn wait(&mut self, longest: Duration) {
        if self.running.as_ref().is_some_and(|(_, job)| job.wait(longest).is_some()) {
            self.running = None;
        }
    }
}

impl<T> JobSlot<T> {
    /// Takes the result of a job without inputs that has ended, once; an error contains the message of a panic.
    pub(crate) fn take_result(&mut self) -> Option<Result<T, String>> {
        self.take_ended().map(|((), result)| result)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn a_late_result_replaces_nothing() {
        let ctx = egui::Context::default();
        let (release, gate) = mpsc::channel::<()>();
        let mut slot = JobSlot::default();
        let slow = move |_: &JobControl| {
            gate.recv().ok();
            1
        };
        slot.start(JobKind::Outline, &ctx, "first", slow).unwrap();
        let first = slot.token().unwrap().clone();
        assert!(slot.take_ended().is_none() && slot.is_running() && !slot.is_cancelled());
        slot.start(JobKind::Outline, &ctx, "second", |_| 2).unwrap();
        assert!(first.is_cancelled() && !slot.is_cancelled());
        release.send(()).unwrap();
        let result = loop {
            if let Some(result) = slot.take_ended() {
                break result;
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        assert_eq!(result, ("second", Ok(2)));
        assert!(!slot.is_running() && slot.inputs().is_none());
        slot.start(JobKind::Outline, &ctx, "third", |_| 3).unwrap();
        slot.cancel();
        assert!(slot.is_cancelled() && slot.inputs() == Some(&"third"), "its end is awaited");
        slot.wait(Duration::from_mins(1));
        assert!(!slot.is_running());
    }
}
