//! Background threads of the window: the renderer of its pictures, the loader, and other tasks.

mod brightness;
pub(super) mod difference;
pub(super) mod jobs;
pub(super) mod loader;
pub(super) mod mailbox;
pub(super) mod memory_estimate;
mod missing_light_volumes;
pub(super) mod quality;
mod render_schedule;
pub(super) mod render_thread;
mod render_worker;
pub(super) mod request;
pub(super) mod response_times;
mod warm_up;
