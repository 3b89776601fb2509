//! How a window begins and ends: what it is opened with, and what goes into the next one when its graphics device is
//! lost.

mod begin;
pub(super) mod carried;
pub(super) mod error;
mod icon;
pub(super) mod no_adapter;
pub(super) mod options;
pub(super) mod run;
