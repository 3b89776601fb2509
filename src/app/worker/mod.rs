//! Threads beside the window: the renderer of its pictures, the loader, and other tasks.

pub(super) mod difference;
pub(super) mod exposure;
pub(super) mod loader;
pub(super) mod quality;
pub(super) mod render_thread;
pub(super) mod render_worker;
pub(super) mod request;
pub(super) mod response;
pub(super) mod task;
