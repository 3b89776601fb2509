//! Native part of the Python package `chiaroscuro`: volumes, looks and renderers as Python objects.
//!
//! The classes here are thin; the package's own classes around them (`python/chiaroscuro/`) convert arrays, check
//! arguments and carry the documentation. Array order is that of NumPy everywhere: z, y, x, with x varying fastest,
//! which is also the order of voxels in memory.

#![expect(clippy::needless_pass_by_value, reason = "arguments from Python are values of their own")]

mod errors;
mod interruptible;
mod look;
mod renderer;
mod volume;
mod voxel_buffer;

use chiaroscuro_media::encode_shown;
use numpy::{PyReadonlyArray3, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use self::errors::ExceptionClass;

/// Native part of the package `chiaroscuro`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::encode_png;
    #[pymodule_export]
    use super::look::{NativeLook, color_map_names, preset_names};
    #[pymodule_export]
    use super::renderer::NativeRenderer;
    #[pymodule_export]
    use super::volume::NativeVolume;
    #[pymodule_export]
    use super::voxel_buffer::VoxelBuffer;

    /// Version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

/// Encodes a picture of (height, width, 4) bytes in sRGB as PNG.
#[pyfunction]
fn encode_png<'py>(py: Python<'py>, picture: PyReadonlyArray3<'py, u8>) -> PyResult<Bound<'py, PyBytes>> {
    let [height, width, channels] = *picture.shape() else { return Err(not_a_picture()) };
    let Ok(bytes) = picture.as_slice() else { return Err(not_a_picture()) };
    if channels != 4 {
        return Err(not_a_picture());
    }
    let encoded = encode_shown([width as u32, height as u32], bytes, true, None);
    Ok(PyBytes::new(py, &encoded.map_err(|err| ExceptionClass::Error.error(err.to_string()))?))
}

/// Error for an array that is not a picture.
fn not_a_picture() -> PyErr {
    ExceptionClass::InvalidArgument
        .error("picture: expected a contiguous array of shape (height, width, 4) and type uint8")
}
