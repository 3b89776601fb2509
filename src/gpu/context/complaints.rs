//! Device errors by thread. Several threads share the rendering device; an error caused by one thread's work is
//! reported to that thread only.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};

use crate::gpu::GpuError;

/// First error of each thread's work, kept until that thread takes it. The loss of the device is reported to every
/// thread.
#[derive(Debug, Clone, Default)]
pub(super) struct Complaints {
    kept: Arc<Mutex<Kept>>,
}

#[derive(Debug, Default)]
struct Kept {
    /// Errors by the thread that caused them: wgpu calls its handlers on the thread whose call failed.
    of_threads: HashMap<ThreadId, GpuError>,
    loss: Option<GpuError>,
}

impl Complaints {
    /// Stores an error of this thread, unless one is already stored; the loss of the device is stored for all
    /// threads.
    pub(super) fn keep(&self, err: GpuError) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if matches!(err, GpuError::Lost(_)) {
            kept.loss.get_or_insert(err);
        } else {
            kept.of_threads.entry(thread::current().id()).or_insert(err);
        }
    }

    /// Takes the pending error of this thread, if any, so that it is reported once.
    pub(super) fn take(&self) -> Option<GpuError> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let own = kept.of_threads.remove(&thread::current().id());
        own.or_else(|| kept.loss.take())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_hear_of_their_own_work_alone() {
        let complaints = Complaints::default();
        let elsewhere = |work: fn(&Complaints) -> Option<String>| {
            let theirs = complaints.clone();
            let thread = thread::Builder::new().name("other".to_owned()).spawn(move || work(&theirs));
            thread.unwrap().join().unwrap()
        };
        let said = elsewhere(|theirs| {
            theirs.keep(GpuError::Refused("first".to_owned()));
            theirs.keep(GpuError::Refused("second".to_owned()));
            let said = theirs.take().map(|err| err.to_string());
            assert!(theirs.take().is_none(), "once");
            said
        });
        assert_eq!(said, Some(GpuError::Refused("first".to_owned()).to_string()));
        elsewhere(|theirs| {
            theirs.keep(GpuError::Refused("theirs".to_owned()));
            None
        });
        assert!(complaints.take().is_none(), "what another does is no matter of this one");
        elsewhere(|theirs| {
            theirs.keep(GpuError::Lost("gone".to_owned()));
            None
        });
        assert!(matches!(complaints.take(), Some(GpuError::Lost(_))), "but that the device is gone is");
    }
}
