//! Check of the address space before a graphics driver is loaded.
//!
//! Where a user's limit (`ulimit -v`) leaves too little, drivers do not return an error: they abort the process in
//! the middle of their work. So the free address space is checked first.

use super::GpuError;
use chiaroscuro_volume::address_bytes_left;

/// Bytes of address space for loading the drivers and opening a device. Mesa 22.3.6 with its compiler took 900 MB on
/// two cores, and aborted processes that had 600 MB.
const DRIVER_ADDRESS_BYTES: u64 = 1 << 30;

/// Additional bytes per core: a software adapter runs a thread on each, with 8 MiB of stack, and a thread that
/// allocates reserves 64 MiB for its arena (glibc).
const ADDRESS_BYTES_PER_CORE: u64 = 72 << 20;

/// Maximum number of threads of Mesa's software adapter.
const MAX_DRIVER_THREADS: usize = 32;

/// Bytes of address space for the shader compiler of a software adapter: with 128 MiB that of Mesa 22.3.6 still
/// crashed.
pub(crate) const COMPILER_ADDRESS_BYTES: u64 = 256 << 20;

/// Checks that the address space suffices for loading the drivers.
///
/// # Errors
/// Returns [`GpuError::AddressSpaceTooSmall`] if a limit leaves too little.
pub fn check_driver_address_space() -> Result<(), GpuError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(MAX_DRIVER_THREADS);
    check_address_space("the graphics driver", DRIVER_ADDRESS_BYTES + ADDRESS_BYTES_PER_CORE * cores as u64)
}

/// Checks that `bytes` of address space are free; `what` names their purpose in the message.
///
/// # Errors
/// Returns [`GpuError::AddressSpaceTooSmall`] if they are not.
pub(crate) fn check_address_space(what: &str, bytes: u64) -> Result<(), GpuError> {
    match address_bytes_left() {
        Some(left) if left < bytes => Err(GpuError::AddressSpaceTooSmall {
            what: what.to_owned(),
            needed_mebibytes: bytes >> 20,
            left_mebibytes: left >> 20,
        }),
        _ => Ok(()),
    }
}
