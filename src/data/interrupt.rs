//! Cooperative cancellation of long computations.
//!
//! Statistics, means and bounds of a large volume take seconds, deep in the call stack of the thread that waits for
//! them. Such work polls an [`Interrupt`] between its pieces, and stops early if it was cancelled. The result is then
//! garbage of the right shape, or an error: the caller that started the work checks its control before using it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Number of values between two polls: at a few nanoseconds each, well below a millisecond.
pub(in crate::data) const PIECE: usize = 1 << 16;

thread_local! {
    static HERE: RefCell<Interrupt> = const { RefCell::new(Interrupt(None)) };
}

/// Cancellation flag of a task, and the count of its pieces that were begun.
#[derive(Debug, Default)]
pub(in crate::data) struct Signal {
    pub(in crate::data) is_cancelled: AtomicBool,
    /// Number of pieces of work that were begun.
    pub(in crate::data) begun: AtomicU64,
    /// Number of pieces after which the task cancels automatically, in tests; 0 disables this.
    pub(in crate::data) last: AtomicU64,
}

/// Handle with which work polls for cancellation. Work that moves to other threads carries it along.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interrupt(Option<Arc<Signal>>);

impl Interrupt {
    /// Returns the handle of the task that runs on this thread.
    pub(crate) fn here() -> Self {
        HERE.with_borrow(Clone::clone)
    }

    pub(in crate::data) fn of(signal: &Arc<Signal>) -> Self {
        Self(Some(Arc::clone(signal)))
    }

    /// Returns true if the current task can be cancelled at all.
    pub(crate) fn is_possible(&self) -> bool {
        self.0.is_some()
    }

    /// Counts a piece of work about to begin, and returns true if it must not be done.
    pub(crate) fn is_due(&self) -> bool {
        self.0.as_ref().is_some_and(|signal| signal.is_due())
    }

    /// Runs work on this thread under this handle, which [`here`](Self::here) returns meanwhile.
    pub(in crate::data) fn during<T>(self, work: impl FnOnce() -> T) -> T {
        /// Guard that restores the previous handle, also when the work panics.
        struct Before(Interrupt);
        impl Drop for Before {
            fn drop(&mut self) {
                HERE.set(std::mem::take(&mut self.0));
            }
        }
        let _before = Before(HERE.replace(self));
        work()
    }
}

impl Signal {
    pub(in crate::data) fn is_due(&self) -> bool {
        if self.is_cancelled.load(Ordering::Relaxed) {
            return true;
        }
        let begun = self.begun.fetch_add(1, Ordering::Relaxed);
        let last = self.last.load(Ordering::Relaxed);
        let is_over = last > 0 && begun >= last;
        if is_over {
            self.is_cancelled.store(true, Ordering::Relaxed);
        }
        is_over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes values one by one, until the task is cancelled.
    fn made<T>(count: usize, value: impl Fn(usize) -> T) -> Vec<T> {
        let interrupt = Interrupt::here();
        let mut made = Vec::with_capacity(count);
        for first in (0..count).step_by(PIECE) {
            if interrupt.is_due() {
                break;
            }
            made.extend((first..count.min(first + PIECE)).map(&value));
        }
        made
    }

    #[test]
    fn only_work_within_is_given_up() {
        let signal = Arc::new(Signal::default());
        assert!(!Interrupt::here().is_possible());
        let count = 3 * PIECE + 1;
        let all = Interrupt::of(&signal).during(|| made(count, |at| at));
        assert!(all.len() == count && all[count - 1] == count - 1);
        assert_eq!(signal.begun.load(Ordering::Relaxed), 4);
        signal.is_cancelled.store(true, Ordering::Relaxed);
        assert_eq!(Interrupt::of(&signal).during(|| made(count, |at| at).len()), 0);
        assert_eq!(made(count, |at| at).len(), count, "nobody has given this up");
    }
}
