//! Fault hooks of builds for tests: the faults chosen for this process, and the queries about them.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock};
use std::time::Duration;

use super::{FaultEvent, FaultThread, InjectedFault};

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

/// Chosen faults, and the events counted until now.
#[derive(Debug)]
struct FaultState {
    faults: RwLock<Vec<InjectedFault>>,
    /// True if there are any faults, which is read more often than they are.
    has_faults: AtomicBool,
    /// Number of each [`FaultEvent`].
    counts: [AtomicU64; 3],
}

/// Faults of this process. They stay static: `--fault` is meant for the process, and whatever can fail asks here, from
/// the disk to the window, without being handed anything that only tests need.
static FAULTS: FaultState = FaultState {
    faults: RwLock::new(Vec::new()),
    has_faults: AtomicBool::new(false),
    counts: [const { AtomicU64::new(0) }; 3],
};

/// Counts one event and returns the total, this one included.
pub fn count(event: FaultEvent) -> u64 {
    FAULTS.counts[event as usize].fetch_add(1, Ordering::Relaxed) + 1
}

/// Returns the number of these events since faults were first chosen.
#[cfg(any(test, feature = "testing"))]
pub fn count_so_far(event: FaultEvent) -> u64 {
    FAULTS.counts[event as usize].load(Ordering::Relaxed)
}

/// Sets the faults to be injected into this process.
pub fn set_faults(faults: Vec<InjectedFault>) {
    FAULTS.has_faults.store(!faults.is_empty(), Ordering::Relaxed);
    *FAULTS.faults.write().unwrap_or_else(PoisonError::into_inner) = faults;
}

/// Returns true if one of the chosen faults satisfies a condition.
fn any(is_it: impl FnMut(&InjectedFault) -> bool) -> bool {
    FAULTS.has_faults.load(Ordering::Relaxed)
        && FAULTS.faults.read().unwrap_or_else(PoisonError::into_inner).iter().any(is_it)
}

/// Returns true if a fault was chosen.
pub fn is_on(fault: InjectedFault) -> bool {
    any(|chosen| *chosen == fault)
}

/// Counts one event and returns true if a fault is due at it. Nothing is counted unless faults were chosen.
pub fn is_due(event: FaultEvent, fault: impl Fn(u64) -> InjectedFault) -> bool {
    FAULTS.has_faults.load(Ordering::Relaxed) && is_on(fault(count(event)))
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

/// Interval at which a reader that is held up looks whether it may go on.
const HELD_POLL: Duration = Duration::from_millis(1);

/// Waits for as long as the reading of small files is held up.
pub fn wait_while_files_are_held() {
    while is_on(InjectedFault::HeldFiles) {
        std::thread::sleep(HELD_POLL);
    }
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
        let before = count_so_far(FaultEvent::Allocation);
        let is_any_due = is_due(FaultEvent::Allocation, InjectedFault::OutOfMemory);
        assert!(!is_any_due && !is_on(InjectedFault::FullDisk));
        assert_eq!(count_so_far(FaultEvent::Allocation), before, "nor is anything counted");
        panic_if_injected(FaultThread::Loader);
        assert_eq!((adapter_delay(), frame_delay()), (Duration::ZERO, Duration::ZERO));
    }
}
