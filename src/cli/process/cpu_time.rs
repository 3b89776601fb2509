//! CPU time of this process: on a shared machine it is more meaningful than wall-clock time.

/// Returns the CPU time of all threads so far, in milliseconds; `None` if the system does not report it.
pub(crate) fn process_cpu_ms() -> Option<f64> {
    // The first number of a thread's schedstat is its time on a CPU, in nanoseconds (Linux).
    let mut total = 0u64;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        total += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(total as f64 / 1e6)
}
