//! Clock for the host's own work on a picture.

use std::time::{Duration, Instant};

/// Clock for the work of one thread: its CPU time, without that of a driver's threads. Software drivers draw on the
/// processors that the thread needs, and take them as soon as a submission wakes them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HostClock {
    started: Instant,
    /// CPU time of the thread at the start; `None` if the system does not tell.
    cpu: Option<Duration>,
}

impl HostClock {
    /// Starts the clock of the calling thread.
    pub(crate) fn start() -> Self {
        Self { started: Instant::now(), cpu: thread_cpu_time() }
    }

    /// Returns the CPU time since the start of the thread that started the clock, in milliseconds; wall time if the
    /// system does not tell.
    pub(crate) fn cpu_ms(&self) -> f64 {
        let worked = thread_cpu_time().zip(self.cpu).map(|(now, start)| now.saturating_sub(start));
        worked.unwrap_or_else(|| self.started.elapsed()).as_secs_f64() * 1000.0
    }

    /// Returns the milliseconds of wall time since the start.
    pub(crate) fn wall_ms(&self) -> f64 {
        self.started.elapsed().as_secs_f64() * 1000.0
    }
}

/// Returns the CPU time of the calling thread; `None` if the system does not tell.
#[cfg(unix)]
fn thread_cpu_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
}

/// Returns the CPU time of the calling thread; `None` if the system does not tell.
#[cfg(not(unix))]
fn thread_cpu_time() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_sleeps_does_not_work() {
        let clock = HostClock::start();
        std::thread::sleep(Duration::from_millis(30));
        assert!(clock.wall_ms() >= 30.0);
        if clock.cpu.is_some() {
            assert!(clock.cpu_ms() < 20.0, "{}", clock.cpu_ms());
        }
        let mut sum = 0_u64;
        while clock.wall_ms() < 5000.0 && clock.cpu_ms() < 5.0 {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        assert!(clock.cpu_ms() >= 5.0, "{sum}");
    }
}
