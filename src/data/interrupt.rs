//! Giving up long work in the middle.
//!
//! Statistics, means and bounds of a large volume take seconds, far below whoever waits for it. Whoever does such work asks
//! between its pieces whether it is still wanted, and leaves the rest undone if it is not. What is left is nonsense of the
//! right shape, or an error: whoever has started the work looks at its control before using any of it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Values between two looks at whether they are still wanted: at a few nanoseconds each well below a millisecond.
pub(in crate::data) const PIECE: usize = 1 << 16;

thread_local! {
    static HERE: RefCell<Interrupt> = const { RefCell::new(Interrupt(None)) };
}

/// Whether work has been given up, and how many of its pieces were begun before.
#[derive(Debug, Default)]
pub(in crate::data) struct Signal {
    pub(in crate::data) is_cancelled: AtomicBool,
    /// Pieces that were begun.
    pub(in crate::data) begun: AtomicU64,
    /// After so many it is given up by itself, in tests; 0 for never.
    pub(in crate::data) last: AtomicU64,
}

/// Asks whether the work of a thread has been given up. It goes with the work to other threads.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interrupt(Option<Arc<Signal>>);

impl Interrupt {
    /// That of what this thread is doing.
    pub(crate) fn here() -> Self {
        HERE.with_borrow(Clone::clone)
    }

    pub(in crate::data) fn of(signal: &Arc<Signal>) -> Self {
        Self(Some(Arc::clone(signal)))
    }

    /// Whether anybody could give it up.
    pub(crate) fn is_possible(&self) -> bool {
        self.0.is_some()
    }

    /// Before a piece of work: whether it is to be left undone.
    pub(crate) fn is_due(&self) -> bool {
        self.0.as_ref().is_some_and(|signal| signal.is_due())
    }

    /// Does work of this thread that can be given up.
    pub(in crate::data) fn during<T>(self, work: impl FnOnce() -> T) -> T {
        /// Puts back what was, also when the work panics.
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

    /// Values made one by one, up to where they are not wanted any more.
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
