//! Start and end of a window: its options, its construction, and the hand-over of its state after a lost device.

mod begin;
pub(super) mod carried;
pub(super) mod error;
mod icon;
pub(super) mod no_adapter;
pub(super) mod options;
pub(super) mod run;
