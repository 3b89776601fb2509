//! Process-wide facilities: signals, threads, CPU time, times of stages, and the state of standard output.

mod closed_output;
mod cpu_time;
mod signals;
mod stage_times;
mod thread_pool;

pub(super) use closed_output::is_output_closed;
pub use closed_output::note_closed_output;
pub(super) use cpu_time::process_cpu_ms;
pub(super) use signals::listen_for_signals;
pub(super) use stage_times::StageTimes;
pub(super) use thread_pool::start_thread_pool;
