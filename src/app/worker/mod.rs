//! Background threads of the window: the renderer of its pictures, the loader, and other tasks.

mod brightness;
pub(super) mod difference;
mod exposure_compensation;
pub(super) mod jobs;
pub(super) mod loader;
pub(super) mod mailbox;
pub(super) mod memory_estimate;
pub(super) mod quality;
mod render_schedule;
pub(super) mod render_thread;
mod render_worker;
pub(super) mod request;
pub(super) mod response_times;
mod warm_up;
