//! Python exceptions for the errors of the layers below.

use chiaroscuro_render::{BandError, GpuError};
use chiaroscuro_scene::PresetError;
use chiaroscuro_volume::{AddFieldError, LoadError, LoadErrorKind, VolumeError};
use pyo3::prelude::*;
use pyo3::types::PyType;

/// Python module that defines the exceptions, with their base classes.
const EXCEPTIONS: &str = "chiaroscuro._errors";

/// Class of a Python exception, see `python/chiaroscuro/_errors.py`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ExceptionClass {
    /// Base class of all others.
    Error,
    /// An argument has a wrong value.
    InvalidArgument,
    /// A file is damaged, of an unknown kind, or cannot be read.
    UnreadableFile,
    /// There is no usable graphics adapter, or it was lost.
    NoAdapter,
    /// Memory is exhausted, or a limit is exceeded.
    OutOfMemory,
    /// The process is a fork of the one that imported the package.
    ForkedProcess,
}

impl ExceptionClass {
    /// Creates an exception of this class.
    pub(crate) fn error(self, message: impl Into<String>) -> PyErr {
        let message = message.into();
        Python::attach(|py| {
            let class = py
                .import(EXCEPTIONS)
                .and_then(|module| module.getattr(format!("{self:?}")))
                .and_then(|class| Ok(class.cast_into::<PyType>()?));
            match class {
                Ok(class) => PyErr::from_type(class, message),
                // The package is incomplete; its message says what is missing.
                Err(err) => err,
            }
        })
    }
}

/// Converts an error of reading a volume.
pub(crate) fn from_load(err: &LoadError) -> PyErr {
    let class = match err.kind() {
        LoadErrorKind::BadInput | LoadErrorKind::Io => ExceptionClass::UnreadableFile,
        LoadErrorKind::Limit => ExceptionClass::OutOfMemory,
        LoadErrorKind::Cancelled => ExceptionClass::Error,
    };
    class.error(err.to_string())
}

/// Converts an error of the renderer.
pub(crate) fn from_gpu(err: &GpuError) -> PyErr {
    let class = match err {
        GpuError::NoAdapter { .. } | GpuError::DeviceLost(_) => ExceptionClass::NoAdapter,
        GpuError::OutOfMemory { .. } | GpuError::AddressSpaceTooSmall { .. } | GpuError::OverLimit { .. } => {
            ExceptionClass::OutOfMemory
        }
        GpuError::NothingDrawn(_)
        | GpuError::Cancelled
        | GpuError::Volume(_)
        | GpuError::Refused(_)
        | GpuError::Internal(_) => ExceptionClass::Error,
    };
    class.error(err.to_string())
}

/// Converts an error of drawing a picture in bands.
pub(crate) fn from_band(err: &BandError) -> PyErr {
    match err {
        BandError::Gpu(err) => from_gpu(err),
        BandError::Pages(err) => from_load(err),
        BandError::PoolTooSmall { .. } => ExceptionClass::OutOfMemory.error(err.to_string()),
    }
}

/// Converts an error of a setting.
pub(crate) fn from_preset(err: &PresetError) -> PyErr {
    ExceptionClass::InvalidArgument.error(err.to_string())
}

/// Converts an error of creating a volume from voxels.
pub(crate) fn from_volume(err: &VolumeError) -> PyErr {
    ExceptionClass::InvalidArgument.error(err.to_string())
}

/// Converts an error of adding a field to a volume.
pub(crate) fn from_field(err: AddFieldError) -> PyErr {
    ExceptionClass::InvalidArgument.error(err.to_string())
}
