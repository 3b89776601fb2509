//! Frame: one picture from request to pixels, with the plan, the steps and the caches.

pub(super) mod caches;
mod double_buffer;
pub(super) mod downsample_to_fit;
pub(super) mod encode;
mod frame_plan;
pub(super) mod light_fill;
mod loaded_volume;
#[cfg(test)]
mod out_of_memory_tests;
pub(super) mod picture_painter;
pub(super) mod render_job;
pub(super) mod renderer;
pub(super) mod report;
pub(super) mod step;
pub(super) mod warm_up;
