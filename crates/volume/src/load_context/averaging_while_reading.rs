//! Averaging of blocks while they are read, which tests can force although everything fits into memory.

/// Returns true if blocks are averaged while reading although everything fits; only tests can switch this on.
#[cfg(not(any(test, feature = "testing")))]
pub(super) const fn is_short_of_room() -> bool {
    false
}

#[cfg(any(test, feature = "testing"))]
pub(super) use forced::is_short_of_room;
#[cfg(any(test, feature = "testing"))]
pub use forced::with_forced_averaging;

#[cfg(any(test, feature = "testing"))]
mod forced {
    use std::cell::Cell;

    thread_local! {
        static FORCED: Cell<bool> = const { Cell::new(false) };
    }

    pub(crate) fn is_short_of_room() -> bool {
        FORCED.get()
    }

    /// Runs `what` as if memory were too short to average blocks after reading.
    pub fn with_forced_averaging<T>(what: impl FnOnce() -> T) -> T {
        FORCED.set(true);
        let done = what();
        FORCED.set(false);
        done
    }
}
