//! Outputs made of finished pictures and light volumes: display colours, slices, distances, drawing in the window.

pub(super) mod display;
pub(super) mod light_volume_export;
pub(super) mod painter;
pub(super) mod picture_distance;
pub(super) mod render_target;
pub(super) mod window_painter;
