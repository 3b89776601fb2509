//! Check of the address space before a graphics driver is loaded.
//!
//! Where a user's limit (`ulimit -v`) leaves too little, drivers do not return an error: they abort the process in
//! the middle of their work. So the free address space is checked first.

use super::GpuError;
use crate::data::address_bytes_left;

/// Bytes of address space for loading the drivers and opening a device. Mesa 22.3.6 with its compiler took 900 MB on
/// two cores, and aborted processes that had 600 MB.
const OF_DRIVERS: u64 = 1 << 30;

/// Additional bytes per core: a software adapter runs a thread on each, with 8 MiB of stack, and a thread that
/// allocates reserves 64 MiB for its arena (glibc).
const OF_EACH_CORE: u64 = 72 << 20;

/// Maximum number of threads of Mesa's software adapter.
const MOST_THREADS: usize = 32;

/// Bytes of address space for the shader compiler of a software adapter: with 128 MiB that of Mesa 22.3.6 still
/// crashed.
pub(in crate::gpu) const OF_THE_COMPILER: u64 = 256 << 20;

/// Checks that the address space suffices for loading the drivers.
///
/// # Errors
/// Returns [`GpuError::FewAddresses`] if a limit leaves too little.
pub(crate) fn check_room_for_drivers() -> Result<(), GpuError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS);
    check_room("the graphics driver", OF_DRIVERS + OF_EACH_CORE * cores as u64)
}

/// Checks that `bytes` of address space are free; `what` names their purpose in the message.
///
/// # Errors
/// Returns [`GpuError::FewAddresses`] if they are not.
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
