//! CPU time of this process: on a shared machine it tells more than the clock on the wall.

/// Milliseconds of CPU time over all threads so far; `None` where the system does not say.
pub(in crate::cli) fn process_cpu_ms() -> Option<f64> {
    // Nanoseconds on a CPU are the first number of each thread's schedstat (Linux).
    let mut total = 0u64;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        total += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(total as f64 / 1e6)
}
