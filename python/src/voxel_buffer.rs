//! Voxels that are taken from arrays, piece by piece, so that an array that is read block by block is never there twice.

use std::sync::{Mutex, PoisonError};

use chiaroscuro_volume::{Samples, VoxelType};
use numpy::{Element, PyArrayDyn, PyArrayMethods as _, PyUntypedArrayMethods as _};
use pyo3::prelude::*;

use crate::errors::ExceptionClass;
use crate::interruptible::check_process;

/// Voxels of a volume that is being taken from arrays.
#[pyclass(frozen, module = "chiaroscuro._native")]
#[derive(Debug)]
pub(crate) struct VoxelBuffer {
    /// Voxels so far; `None` after a volume was made of them.
    samples: Mutex<Option<Samples>>,
}

/// Returns an empty vector with room for `count` values.
fn with_room<T>(count: usize) -> PyResult<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_too_large| {
        ExceptionClass::OutOfMemory.error(format!(
            "no memory for {count} voxels of {} bytes; take a part of the array, or every second voxel",
            size_of::<T>()
        ))
    })?;
    Ok(values)
}

/// Appends the values of an array, in C order.
fn append<T: Element + Copy>(to: &mut Vec<T>, array: &Bound<'_, PyAny>) -> PyResult<()> {
    let array = array.cast::<PyArrayDyn<T>>()?.readonly();
    if to.capacity() - to.len() < array.len() {
        return Err(ExceptionClass::InvalidArgument.error("the array has more voxels than its shape says"));
    }
    match array.as_slice() {
        // A slice of an array in Fortran order has another order, too.
        Ok(values) if array.is_c_contiguous() => to.extend_from_slice(values),
        _ => to.extend(array.as_array().iter().copied()),
    }
    Ok(())
}

#[pymethods]
impl VoxelBuffer {
    /// Creates a buffer with room for `count` voxels of a type: `uint8`, `int8`, … `float64`.
    #[new]
    fn new(dtype: &str, count: usize) -> PyResult<Self> {
        check_process()?;
        let known = VoxelType::ALL.into_iter().find(|known| known.name() == dtype);
        let known = known.ok_or_else(|| {
            let names = VoxelType::ALL.map(VoxelType::name).join(", ");
            ExceptionClass::InvalidArgument.error(format!("dtype: expected one of {names}, found {dtype:?}"))
        })?;
        let samples = match known {
            VoxelType::U8 => Samples::U8(with_room(count)?),
            VoxelType::I8 => Samples::I8(with_room(count)?),
            VoxelType::U16 => Samples::U16(with_room(count)?),
            VoxelType::I16 => Samples::I16(with_room(count)?),
            VoxelType::U32 => Samples::U32(with_room(count)?),
            VoxelType::I32 => Samples::I32(with_room(count)?),
            VoxelType::F32 => Samples::F32(with_room(count)?),
            VoxelType::F64 => Samples::F64(with_room(count)?),
        };
        Ok(Self { samples: Mutex::new(Some(samples)) })
    }

    /// Appends the voxels of an array of the buffer's type in native byte order, in C order.
    fn append(&self, array: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut samples = self.samples.lock().unwrap_or_else(PoisonError::into_inner);
        match samples.as_mut() {
            Some(Samples::U8(values)) => append(values, array),
            Some(Samples::I8(values)) => append(values, array),
            Some(Samples::U16(values)) => append(values, array),
            Some(Samples::I16(values)) => append(values, array),
            Some(Samples::U32(values)) => append(values, array),
            Some(Samples::I32(values)) => append(values, array),
            Some(Samples::F32(values)) => append(values, array),
            Some(Samples::F64(values)) => append(values, array),
            None => Err(used()),
        }
    }
}

impl VoxelBuffer {
    /// Takes the voxels out.
    pub(crate) fn take(&self) -> PyResult<Samples> {
        self.samples.lock().unwrap_or_else(PoisonError::into_inner).take().ok_or_else(used)
    }
}

/// Error for a buffer of which a volume was made.
fn used() -> PyErr {
    ExceptionClass::Error.error("a volume was made of these voxels already")
}
