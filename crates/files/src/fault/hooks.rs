//! Fault hooks of builds for tests: the faults chosen for this process, and the queries about them.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock};
use std::time::Duration;

use super::{FaultThread, InjectedFault};

impl FromStr for InjectedFault {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let expected = "expected lost@N, pictures-lost@N, oom@K, panic:loader|worker|ui|export, shader, slow:MS, \
                        slow-frames:MS, full-disk or read-error@N";
        let unknown = || format!("{expected}; found {text:?}");
        let number = |digits: &str| digits.parse::<u64>().ok().ok_or_else(unknown);
        if let Some((what, count)) = text.split_once('@') {
            let count = number(count)?;
            return match what {
                "lost" => Ok(Self::DeviceLost(count)),
                "pictures-lost" => Ok(Self::RendererDeviceLost(count)),
                "oom" => Ok(Self::OutOfMemory(count)),
                "read-error" => Ok(Self::ReadError(count)),
                _ => Err(unknown()),
            };
        }
        match text {
            "shader" => Ok(Self::Shader),
            "full-disk" => Ok(Self::FullDisk),
            "panic:loader" => Ok(Self::Panic(FaultThread::Loader)),
            "panic:worker" => Ok(Self::Panic(FaultThread::Worker)),
            "panic:ui" => Ok(Self::Panic(FaultThread::Window)),
            "panic:export" => Ok(Self::Panic(FaultThread::Export)),
            _ => {
                let (what, millis) = text.split_once(':').ok_or_else(unknown)?;
                let longer = || number(millis).map(Duration::from_millis);
                match what {
                    "slow" => longer().map(Self::Slow),
                    "slow-frames" => longer().map(Self::SlowFrames),
                    _ => Err(unknown()),
                }
            }
        }
    }
}

/// Injected faults of this process, and a flag that is set if there are any.
static FAULTS: RwLock<Vec<InjectedFault>> = RwLock::new(Vec::new());
static HAS_FAULTS: AtomicBool = AtomicBool::new(false);

/// Counter of events that a fault refers to.
#[derive(Debug, Default)]
pub struct FaultCounter(AtomicU64);

impl FaultCounter {
    /// Creates a counter at zero.
    pub const fn new() -> Self {
        Self(AtomicU64::new(0))
    }

    /// Counts one event and returns the total, this one included.
    pub fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Returns the events counted since faults were first chosen.
    pub fn so_far(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Sets the faults to be injected into this process.
pub fn set_faults(faults: Vec<InjectedFault>) {
    HAS_FAULTS.store(!faults.is_empty(), Ordering::Relaxed);
    *FAULTS.write().unwrap_or_else(PoisonError::into_inner) = faults;
}

/// Returns true if one of the chosen faults satisfies a condition.
fn any(is_it: impl FnMut(&InjectedFault) -> bool) -> bool {
    HAS_FAULTS.load(Ordering::Relaxed)
        && FAULTS.read().unwrap_or_else(PoisonError::into_inner).iter().any(is_it)
}

/// Returns true if a fault was chosen.
pub fn is_on(fault: InjectedFault) -> bool {
    any(|chosen| *chosen == fault)
}

/// Counts one event and returns true if a fault is due at it. Nothing is counted unless faults were chosen.
pub fn is_due(count: &FaultCounter, fault: impl Fn(u64) -> InjectedFault) -> bool {
    HAS_FAULTS.load(Ordering::Relaxed) && is_on(fault(count.next()))
}

/// Panics if that was chosen for this thread.
pub fn panic_if_injected(place: FaultThread) {
    assert!(!is_on(InjectedFault::Panic(place)), "a fault was injected: panic in {place:?}");
}

/// Sums the durations that `of` returns for the chosen faults.
fn sum(of: impl Fn(&InjectedFault) -> Option<Duration>) -> Duration {
    let mut by = Duration::ZERO;
    any(|chosen| {
        by += of(chosen).unwrap_or_default();
        false
    });
    by
}

/// Returns the additional delay of waits for the adapter.
pub fn adapter_delay() -> Duration {
    sum(|chosen| if let InjectedFault::Slow(longer) = chosen { Some(*longer) } else { None })
}

/// Returns the additional delay of the window's frames.
pub fn frame_delay() -> Duration {
    sum(|chosen| if let InjectedFault::SlowFrames(longer) = chosen { Some(*longer) } else { None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_read_and_what_is_none_is_refused() {
        let read = |text: &str| text.parse::<InjectedFault>();
        assert_eq!(read("lost@10"), Ok(InjectedFault::DeviceLost(10)));
        assert_eq!(read("oom@3"), Ok(InjectedFault::OutOfMemory(3)));
        assert_eq!(read("panic:ui"), Ok(InjectedFault::Panic(FaultThread::Window)));
        assert_eq!(read("slow:250"), Ok(InjectedFault::Slow(Duration::from_millis(250))));
        assert_eq!(read("slow-frames:300"), Ok(InjectedFault::SlowFrames(Duration::from_millis(300))));
        for wrong in [
            "slow-frames",
            "slowly:3",
            "",
            "lost",
            "lost@",
            "lost@x",
            "oom@-1",
            "panic:",
            "slow:",
            "slow:1.5",
            "fire@3",
        ] {
            assert!(read(wrong).unwrap_err().contains("oom@K"), "{wrong}");
        }
    }

    #[test]
    fn nothing_fails_unless_it_is_asked_for() {
        let count = FaultCounter::new();
        assert!(!is_due(&count, InjectedFault::OutOfMemory) && !is_on(InjectedFault::FullDisk));
        assert_eq!(count.0.load(Ordering::Relaxed), 0, "nor is anything counted");
        panic_if_injected(FaultThread::Loader);
        assert_eq!((adapter_delay(), frame_delay()), (Duration::ZERO, Duration::ZERO));
    }
}
