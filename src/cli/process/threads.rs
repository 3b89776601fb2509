//! The threads that read and prepare volumes, started before anything needs them: whoever needs them later has no way
//! to say that they could not be.

use crate::cli::CliError;
use crate::data::address_bytes_left;

/// Addresses that a thread takes: 2 MiB of stack, and the 64 MiB that glibc reserves for its memory, of which it asks
/// for twice as many to find an even place.
const OF_A_THREAD: u64 = 130 << 20;

/// Starts as many as there are cores, fewer where a limit leaves few addresses: they may take a quarter of those.
pub(in crate::cli) fn start() -> Result<(), CliError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = match address_bytes_left() {
        Some(left) => usize::try_from(left / 4 / OF_A_THREAD).unwrap_or(usize::MAX).clamp(1, cores),
        // As many as cores, or as `RAYON_NUM_THREADS` says.
        None => 0,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().map_err(|err| CliError::Threads(err.to_string()))
}
