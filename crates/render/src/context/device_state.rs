//! State of a device that all clones of its context share: whether it is lost, and how long it took to open.

use std::sync::atomic::AtomicBool;

/// State of a device that all clones of its context share.
#[derive(Debug)]
pub(super) struct DeviceState {
    /// Set when the device is lost.
    pub(super) is_lost: AtomicBool,
    /// Time in which the device was opened.
    pub(super) opening_times: OpeningTimes,
}

/// Wall-clock time in which a context was opened without a window; zero for devices of the caller.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OpeningTimes {
    /// Loading of the drivers and listing of their adapters, in milliseconds.
    pub instance_ms: f64,
    /// Opening of the device, in milliseconds.
    pub device_ms: f64,
}
