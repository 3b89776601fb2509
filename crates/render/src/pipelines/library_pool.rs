//! Pool of devices with their pipelines, for tests that run in one process: most of the time of a short test would be
//! spent on compiling pipelines that another test has compiled.

use std::cell::RefCell;
use std::sync::Mutex;

use super::shader_library::{ShaderLibrary, lock};
use crate::{GpuContext, GpuError};

/// Devices that no test uses, with their pipelines.
static POOL: Mutex<Vec<ShaderLibrary>> = Mutex::new(Vec::new());

thread_local! {
    /// Device of the test on this thread.
    static BORROWED: RefCell<Option<PooledLibrary>> = const { RefCell::new(None) };
}

/// Library that returns to the pool when its thread ends.
struct PooledLibrary(ShaderLibrary);

impl Drop for PooledLibrary {
    fn drop(&mut self) {
        // Nothing is asked of the device here: other values of the thread that it needs may be gone.
        lock(&POOL).push(self.0.clone());
    }
}

/// Returns a device with the pipelines that earlier tests have compiled on it. Until this thread ends, no other thread
/// gets the same one; further calls on this thread do.
///
/// # Errors
/// Fails like [`GpuContext::headless`].
pub fn pooled_library() -> Result<ShaderLibrary, GpuError> {
    BORROWED.with_borrow_mut(|borrowed| {
        let known = borrowed.as_ref().map(|known| known.0.clone());
        let known = known.filter(|library| !library.context().is_lost());
        if let Some(library) = known {
            return Ok(library);
        }
        let pooled = std::iter::from_fn(|| lock(&POOL).pop()).find(|library| !library.context().is_lost());
        let library = match pooled {
            Some(library) => library,
            None => ShaderLibrary::new(&GpuContext::headless()?),
        };
        *borrowed = Some(PooledLibrary(library.clone()));
        Ok(library)
    })
}
