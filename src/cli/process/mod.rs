//! This process: its signals, its threads, the time that it takes.

mod cpu_time;
mod signals;
mod threads;

pub(super) use cpu_time::process_cpu_ms;
pub(super) use signals::listen;
pub(super) use threads::start;
