//! Device errors by thread. Several threads share the rendering device; an error caused by one thread's work is
//! reported to that thread only.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};

use crate::GpuError;

/// First error of each thread's work, kept until that thread takes it. The loss of the device is reported to every
/// thread.
#[derive(Debug, Clone, Default)]
pub(super) struct DeviceErrors {
    pending: Arc<Mutex<PendingErrors>>,
}

#[derive(Debug, Default)]
struct PendingErrors {
    /// Errors by the thread that caused them: wgpu calls its handlers on the thread whose call failed.
    by_thread: HashMap<ThreadId, GpuError>,
    loss: Option<GpuError>,
}

impl DeviceErrors {
    /// Stores an error of this thread, unless one is already stored; the loss of the device is stored for all
    /// threads.
    pub(super) fn store(&self, err: GpuError) {
        let mut kept = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
        if matches!(err, GpuError::DeviceLost(_)) {
            kept.loss.get_or_insert(err);
        } else {
            kept.by_thread.entry(thread::current().id()).or_insert(err);
        }
    }

    /// Takes the pending error of this thread, if any, so that it is reported once.
    pub(super) fn take(&self) -> Option<GpuError> {
        let mut kept = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
        let own = kept.by_thread.remove(&thread::current().id());
        own.or_else(|| kept.loss.take())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_reported_to_the_thread_that_caused_them() {
        let complaints = DeviceErrors::default();
        let on_another_thread = |work: fn(&DeviceErrors) -> Option<String>| {
            let shared = complaints.clone();
            let thread = thread::Builder::new().name("other".to_owned()).spawn(move || work(&shared));
            thread.unwrap().join().unwrap()
        };
        let said = on_another_thread(|theirs| {
            theirs.store(GpuError::Refused("first".to_owned()));
            theirs.store(GpuError::Refused("second".to_owned()));
            let said = theirs.take().map(|err| err.to_string());
            assert!(theirs.take().is_none(), "once");
            said
        });
        assert_eq!(said, Some(GpuError::Refused("first".to_owned()).to_string()));
        on_another_thread(|theirs| {
            theirs.store(GpuError::Refused("theirs".to_owned()));
            None
        });
        assert!(complaints.take().is_none(), "what another does is no matter of this one");
        on_another_thread(|theirs| {
            theirs.store(GpuError::DeviceLost("gone".to_owned()));
            None
        });
        assert!(matches!(complaints.take(), Some(GpuError::DeviceLost(_))), "but that the device is gone is");
    }
}
