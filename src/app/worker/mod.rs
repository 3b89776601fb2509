//! Background threads of the window: the renderer of its pictures, the loader, and other tasks.

mod agenda;
mod brightness;
pub(super) mod difference;
mod exposure;
pub(super) mod loader;
pub(super) mod mailbox;
pub(super) mod quality;
pub(super) mod render_thread;
mod render_worker;
pub(super) mod request;
pub(super) mod response;
pub(super) mod task;
mod warm_up;
pub(super) mod weighing;
