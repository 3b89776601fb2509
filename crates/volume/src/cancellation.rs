//! Cooperative cancellation of long computations.
//!
//! Statistics, means and bounds of a large volume take seconds, deep in the call stack of the thread that waits for
//! them. Such work polls a [`CancelToken`] between its pieces, and stops early if it was cancelled. The result is then
//! garbage of the right shape, or an error: the caller that started the work checks its control before using it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Number of values between two polls: at a few nanoseconds each, well below a millisecond.
pub const PIECE_VALUES: usize = 1 << 16;

thread_local! {
    static HERE: RefCell<CancelToken> = const { RefCell::new(CancelToken(None)) };
}

/// Cancellation flag of a task, and the count of its pieces that were begun.
#[derive(Debug, Default)]
pub(crate) struct CancelSignal {
    pub(crate) is_cancelled: AtomicBool,
    /// Number of pieces of work that were begun.
    pub(crate) begun: AtomicU64,
    /// Number of pieces after which the task cancels automatically, in tests; 0 disables this.
    pub(crate) cancel_after_pieces: AtomicU64,
}

/// Handle with which work polls for cancellation. Work that moves to other threads carries it along.
#[derive(Debug, Clone, Default)]
pub struct CancelToken(Option<Arc<CancelSignal>>);

impl CancelToken {
    /// Returns the handle of the task that runs on this thread.
    pub fn current() -> Self {
        HERE.with_borrow(Clone::clone)
    }

    pub(crate) fn new(signal: &Arc<CancelSignal>) -> Self {
        Self(Some(Arc::clone(signal)))
    }

    /// Returns true if the current task can be cancelled at all.
    pub fn is_cancellable(&self) -> bool {
        self.0.is_some()
    }

    /// Counts a piece of work about to begin, and returns true if it must not be done.
    pub fn should_stop(&self) -> bool {
        self.0.as_ref().is_some_and(|signal| signal.should_stop())
    }

    /// Runs work on this thread under this handle, which [`current`](Self::current) returns meanwhile.
    pub(crate) fn run<T>(self, work: impl FnOnce() -> T) -> T {
        /// Guard that restores the previous handle, also when the work panics.
        struct RestoreToken(CancelToken);
        impl Drop for RestoreToken {
            fn drop(&mut self) {
                HERE.set(std::mem::take(&mut self.0));
            }
        }
        let _before = RestoreToken(HERE.replace(self));
        work()
    }
}

impl CancelSignal {
    pub(crate) fn should_stop(&self) -> bool {
        if self.is_cancelled.load(Ordering::Relaxed) {
            return true;
        }
        let begun = self.begun.fetch_add(1, Ordering::Relaxed);
        let last = self.cancel_after_pieces.load(Ordering::Relaxed);
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
    fn make_values<T>(count: usize, value: impl Fn(usize) -> T) -> Vec<T> {
        let interrupt = CancelToken::current();
        let mut made = Vec::with_capacity(count);
        for first in (0..count).step_by(PIECE_VALUES) {
            if interrupt.should_stop() {
                break;
            }
            made.extend((first..count.min(first + PIECE_VALUES)).map(&value));
        }
        made
    }

    #[test]
    fn only_work_under_the_token_is_cancelled() {
        let signal = Arc::new(CancelSignal::default());
        assert!(!CancelToken::current().is_cancellable());
        let count = 3 * PIECE_VALUES + 1;
        let all = CancelToken::new(&signal).run(|| make_values(count, |at| at));
        assert!(all.len() == count && all[count - 1] == count - 1);
        assert_eq!(signal.begun.load(Ordering::Relaxed), 4);
        signal.is_cancelled.store(true, Ordering::Relaxed);
        assert_eq!(CancelToken::new(&signal).run(|| make_values(count, |at| at).len()), 0);
        assert_eq!(make_values(count, |at| at).len(), count, "nobody has given this up");
    }
}
