//! Start and end of a window: its options, its construction, and the hand-over of its state after a lost device.

pub(super) mod desktop_error;
pub(super) mod error;
pub(super) mod handover;
mod icon;
pub(super) mod main_loop;
mod new_window;
pub(super) mod options;
pub(super) mod window_device;
