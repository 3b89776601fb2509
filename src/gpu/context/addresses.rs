//! Addresses that graphics drivers need. Where a user's limit (`ulimit -v`) leaves fewer, drivers do not refuse: they
//! end the program in the middle of what they do, so we look first.

use super::GpuError;
use crate::data::address_bytes_left;

/// For loading the drivers and opening a device. Mesa 22.3.6 with its compiler took 900 MB on two cores, and ended
/// programs that had 600 MB.
const OF_DRIVERS: u64 = 1 << 30;

/// More for each core: a software adapter has a thread for each, with 8 MiB of stack, and a thread that asks for memory
/// reserves 64 MiB (glibc).
const OF_EACH_CORE: u64 = 72 << 20;

/// Mesa's software adapter has no more threads than this.
const MOST_THREADS: usize = 32;

/// For the compiler of a software adapter: with 128 MiB that of Mesa 22.3.6 still crashed.
pub(in crate::gpu) const OF_THE_COMPILER: u64 = 256 << 20;

/// Whether drivers can be loaded.
///
/// # Errors
/// When a limit leaves too few addresses for them.
pub(crate) fn check_room_for_drivers() -> Result<(), GpuError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS);
    check_room("the graphics driver", OF_DRIVERS + OF_EACH_CORE * cores as u64)
}

/// Whether `bytes` of addresses are left.
///
/// # Errors
/// When they are not.
pub(in crate::gpu) fn check_room(what: &str, bytes: u64) -> Result<(), GpuError> {
    match address_bytes_left() {
        Some(left) if left < bytes => Err(GpuError::FewAddresses {
            what: what.to_owned(),
            needed_mebibytes: bytes >> 20,
            left_mebibytes: left >> 20,
        }),
        _ => Ok(()),
    }
}
