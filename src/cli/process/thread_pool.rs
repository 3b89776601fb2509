//! Start-up of the thread pool that reads and prepares volumes: a later failure to start threads could not be
//! reported.

use crate::cli::CliError;
use chiaroscuro_volume::address_bytes_left;

/// Address space of a thread, in bytes: 2 MiB of stack, and the 64 MiB that glibc reserves for its heap, of which it
/// requests twice as many for alignment.
const ADDRESS_BYTES_PER_THREAD: u64 = 130 << 20;

/// Starts one thread per core, or fewer if an address-space limit is low: they may use a quarter of what is left.
pub(crate) fn start_thread_pool() -> Result<(), CliError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = match address_bytes_left() {
        Some(left) => {
            usize::try_from(left / 4 / ADDRESS_BYTES_PER_THREAD).unwrap_or(usize::MAX).clamp(1, cores)
        }
        // One thread per core, or as many as `RAYON_NUM_THREADS` says.
        None => 0,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().map_err(|err| CliError::ThreadStart(err.to_string()))
}
