//! Outputs made of finished pictures and light volumes: display colours, slices, distances, drawing in the window.

pub(super) mod display;
pub(super) mod distance;
pub(super) mod light_slice;
pub(super) mod target;
pub(super) mod window;
