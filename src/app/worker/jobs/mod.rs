//! Jobs: the background tasks of a window, each on a thread of its own.
//!
//! [`Jobs`] knows those that run. A [`JobHandle`] belongs to one, and a [`JobSlot`] to the place of the window where at
//! most one of a kind runs; dropping either cancels the job and discards its result, so that a late one replaces
//! nothing. The threads that serve a window as long as it lives, for pictures and for the autosave, are no jobs.

mod handle;
mod kind;
mod slot;

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use eframe::egui;

pub(crate) use self::handle::{JobControl, JobHandle, JobProgress, panic_message};
pub(crate) use self::kind::JobKind;
pub(crate) use self::slot::JobSlot;
use chiaroscuro_volume::CancelToken;

/// Job that has a thread.
#[derive(Debug)]
struct RunningJob {
    /// Number of the job in order of their starts.
    generation: u64,
    kind: JobKind,
    token: CancelToken,
}

/// Running jobs, and the number of those that were ever started.
#[derive(Debug, Default)]
struct JobList {
    started: u64,
    running: Vec<RunningJob>,
}

/// State of a registry, which its jobs share.
#[derive(Debug, Default)]
struct SharedJobs {
    list: Mutex<JobList>,
    /// Signalled whenever a job has ended.
    ended: Condvar,
}

/// Registry of the running jobs of a window, and of the windows that it replaces after the loss of a device.
///
/// The window's context holds it as a plugin. Every job needs the context to request a repaint when it ends, so that
/// no job can start without being listed here.
#[derive(Debug, Clone, Default)]
pub(crate) struct Jobs(Arc<SharedJobs>);

impl egui::Plugin for Jobs {
    fn debug_name(&self) -> &'static str {
        "jobs"
    }
}

impl Jobs {
    /// Returns the registry of the window with this context.
    pub(crate) fn from_context(ctx: &egui::Context) -> Self {
        ctx.plugin_or_default::<Self>().lock().clone()
    }

    /// Hands this registry to a successor window, which has none yet.
    pub(crate) fn hand_to(self, ctx: &egui::Context) {
        ctx.add_plugin(self);
    }

    /// Cancels all jobs and waits until none runs, at most for `longest`: a graphics driver must not be unloaded while
    /// a thread executes in it.
    pub(crate) fn cancel_and_wait(&self, longest: Duration) {
        let list = self.list();
        list.running.iter().for_each(|job| job.token.cancel());
        let is_busy = |list: &mut JobList| !list.running.is_empty();
        let waited = self.0.ended.wait_timeout_while(list, longest, is_busy);
        let (list, _) = waited.unwrap_or_else(PoisonError::into_inner);
        for RunningJob { generation, kind, .. } in &list.running {
            log::warn!("job {generation} ({}) has not ended after {longest:?}", kind.thread_name());
        }
    }

    fn list(&self) -> MutexGuard<'_, JobList> {
        self.0.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lists a job until the returned guard is dropped, after a panic too.
    fn register(&self, kind: JobKind, token: CancelToken) -> JobRegistration {
        let mut list = self.list();
        list.started += 1;
        let generation = list.started;
        list.running.push(RunningJob { generation, kind, token });
        JobRegistration { jobs: self.clone(), generation }
    }
}

/// Guard that keeps a job in the registry.
struct JobRegistration {
    jobs: Jobs,
    generation: u64,
}

impl Drop for JobRegistration {
    fn drop(&mut self) {
        self.jobs.list().running.retain(|job| job.generation != self.generation);
        self.jobs.0.ended.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    const LONGEST: Duration = Duration::from_secs(10);

    #[test]
    fn tasks_that_nobody_wants_are_waited_for() {
        let ctx = egui::Context::default();
        let (sender, receiver) = mpsc::channel();
        drop(JobHandle::start(JobKind::Outline, &ctx, move |_| {
            std::thread::sleep(Duration::from_millis(50));
            sender.send(()).unwrap();
        }));
        Jobs::from_context(&ctx).cancel_and_wait(LONGEST);
        receiver.try_recv().expect("the task has ended");
    }

    #[test]
    fn a_successor_waits_for_the_jobs_of_the_window_before() {
        let [first, second, other] = [(); 3].map(|()| egui::Context::default());
        let (sender, receiver) = mpsc::channel::<()>();
        let _job = JobHandle::start(JobKind::Export, &first, move |job| {
            while !job.token().is_cancelled() {
                std::thread::sleep(Duration::from_millis(1));
            }
            drop(sender);
        })
        .unwrap();
        Jobs::from_context(&first).hand_to(&second);
        Jobs::from_context(&other).cancel_and_wait(LONGEST);
        assert_eq!(receiver.try_recv(), Err(mpsc::TryRecvError::Empty), "it belongs to another window");
        let jobs = Jobs::from_context(&second);
        drop(JobHandle::start(JobKind::Outline, &second, |_| ()));
        assert_eq!(jobs.list().started, 2, "the generations of both windows differ");
        jobs.cancel_and_wait(LONGEST);
        assert_eq!(receiver.try_recv(), Err(mpsc::TryRecvError::Disconnected), "it has ended");
    }
}
