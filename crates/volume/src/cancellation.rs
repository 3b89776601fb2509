//! Cooperative cancellation: the one way to ask long work to stop.
//!
//! Statistics, means and bounds of a large volume take seconds, deep in the call stack of the thread that waits for
//! them; so do light searches, exports and proposals for a file of bare voxels. Such work polls a [`CancelToken`]
//! between its pieces, and stops early if it was cancelled. The result is then garbage of the right shape, or an
//! error: the caller that started the work asks the token before using it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Number of values between two polls: at a few nanoseconds each, well below a millisecond.
pub const PIECE_VALUES: usize = 1 << 16;

thread_local! {
    /// Token of the work on this thread, for [`CancelToken::current`], which has the reason.
    static CURRENT_TOKEN: RefCell<CancelToken> = const { RefCell::new(CancelToken::never()) };
}

/// Cancellation flag of a task, and the count of its pieces that were begun.
#[derive(Debug, Default)]
struct CancelSignal {
    is_cancelled: AtomicBool,
    /// Number of pieces of work that were begun.
    begun: AtomicU64,
    /// Number of pieces after which the task cancels automatically, in tests; 0 disables this.
    cancel_after_pieces: AtomicU64,
}

/// Handle by which work is cancelled, and with which it polls for that. Clones belong to the same work; work that moves
/// to other threads carries one along.
#[derive(Debug, Clone)]
pub struct CancelToken(Option<Arc<CancelSignal>>);

impl Default for CancelToken {
    fn default() -> Self {
        Self::new()
    }
}

impl CancelToken {
    /// Creates a token of its own, which is not cancelled.
    pub fn new() -> Self {
        Self(Some(Arc::default()))
    }

    /// Creates a token that can never be cancelled.
    pub const fn never() -> Self {
        Self(None)
    }

    /// Returns the token under which this thread [runs](Self::run), or one that can never be
    /// cancelled.
    ///
    /// The loops over all voxels use it. They lie below constructors and accessors (statistics are computed when they
    /// are first asked for) that a hundred callers use without any thought of cancelling; an argument would burden
    /// all of these signatures. Work that is called directly takes a token as its argument instead.
    pub fn current() -> Self {
        CURRENT_TOKEN.with_borrow(Clone::clone)
    }

    /// Requests the work to stop at its next poll.
    pub fn cancel(&self) {
        if let Some(signal) = &self.0 {
            signal.is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Returns true if the work was requested to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.as_ref().is_some_and(|signal| signal.is_cancelled.load(Ordering::Relaxed))
    }

    /// Returns true if the work can be cancelled at all.
    pub fn is_cancellable(&self) -> bool {
        self.0.is_some()
    }

    /// Counts a piece of work about to begin, and returns true if it must not be done.
    pub fn should_stop(&self) -> bool {
        let Some(signal) = &self.0 else { return false };
        if self.is_cancelled() {
            return true;
        }
        let begun = signal.begun.fetch_add(1, Ordering::Relaxed);
        let last = signal.cancel_after_pieces.load(Ordering::Relaxed);
        let is_over = last > 0 && begun >= last;
        if is_over {
            self.cancel();
        }
        is_over
    }

    /// Returns the number of pieces of work that were begun.
    #[cfg(any(test, feature = "testing"))]
    pub(crate) fn pieces_begun(&self) -> u64 {
        self.0.as_ref().map_or(0, |signal| signal.begun.load(Ordering::Relaxed))
    }

    /// Cancels the work automatically after the given number of pieces.
    #[cfg(any(test, feature = "testing"))]
    pub(crate) fn cancel_after(&self, pieces: u64) {
        if let Some(signal) = &self.0 {
            signal.cancel_after_pieces.store(pieces.max(1), Ordering::Relaxed);
        }
    }

    /// Runs work on this thread under this token, which [`current`](Self::current) returns meanwhile.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> T {
        /// Guard that restores the previous token, also when the work panics.
        struct RestoreToken(CancelToken);
        impl Drop for RestoreToken {
            fn drop(&mut self) {
                CURRENT_TOKEN.set(std::mem::replace(&mut self.0, CancelToken::never()));
            }
        }
        let _before = RestoreToken(CURRENT_TOKEN.replace(self.clone()));
        work()
    }
}

/// Guard of work in progress that cancels it when dropped.
#[derive(Debug, Default)]
pub struct CancelOnDrop(CancelToken);

impl CancelOnDrop {
    /// Returns the token that is cancelled when this guard is dropped.
    pub fn token(&self) -> &CancelToken {
        &self.0
    }
}

impl From<CancelToken> for CancelOnDrop {
    fn from(token: CancelToken) -> Self {
        Self(token)
    }
}

impl Drop for CancelOnDrop {
    fn drop(&mut self) {
        self.0.cancel();
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
        let token = CancelToken::new();
        assert!(token.is_cancellable() && !CancelToken::current().is_cancellable());
        let count = 3 * PIECE_VALUES + 1;
        let all = token.run(|| make_values(count, |at| at));
        assert!(all.len() == count && all[count - 1] == count - 1);
        assert_eq!(token.pieces_begun(), 4);
        token.cancel();
        assert_eq!(token.run(|| make_values(count, |at| at).len()), 0);
        assert_eq!(make_values(count, |at| at).len(), count, "nobody has given this up");
    }

    #[test]
    fn dropped_guards_cancel_all_clones_of_their_token() {
        let guard = CancelOnDrop::default();
        let token = guard.token().clone();
        assert!(!token.is_cancelled() && !token.should_stop());
        drop(guard);
        assert!(token.is_cancelled() && token.should_stop());
        let never = CancelToken::never();
        drop(CancelOnDrop::from(never.clone()));
        assert!(!never.is_cancelled() && !never.should_stop());
    }
}
