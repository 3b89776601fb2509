//! Replacements of the fault hooks in builds without the feature `faults`: no fault is ever due.

use std::time::Duration;

use super::{FaultEvent, FaultThread, InjectedFault};

/// Returns zero, since nothing is counted.
#[inline]
pub const fn count(_event: FaultEvent) -> u64 {
    0
}

/// Returns false: no fault was chosen.
#[inline]
pub const fn is_on(_fault: InjectedFault) -> bool {
    false
}

/// Returns false: no fault is due at any event.
#[inline]
pub fn is_due(_event: FaultEvent, _fault: impl Fn(u64) -> InjectedFault) -> bool {
    false
}

/// Does nothing: no thread was chosen to panic.
#[inline]
pub const fn panic_if_injected(_place: FaultThread) {}

/// Returns zero, the additional delay of waits for the adapter.
#[inline]
pub const fn adapter_delay() -> Duration {
    Duration::ZERO
}

/// Returns zero, the additional delay of the window's frames.
#[inline]
pub const fn frame_delay() -> Duration {
    Duration::ZERO
}

/// Does nothing: the reading of files is not held up.
#[inline]
pub const fn wait_while_files_are_held() {}
