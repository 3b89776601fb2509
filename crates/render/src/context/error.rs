//! Errors of the renderer: no adapter, out of memory, limits, lost device, cancelled pictures.

use chiaroscuro_volume::VolumeError;

/// Error of the renderer.
#[derive(Debug, Clone, thiserror::Error)]
pub enum GpuError {
    /// No adapter at all, or none with the features that rendering needs.
    #[error("no usable graphics adapter: {reason}; {help}")]
    NoAdapter {
        /// Requirement that no adapter met.
        reason: String,
        /// Advice to the user.
        help: &'static str,
    },
    /// Graphics memory is exhausted, or has no free block of that size.
    #[error(
        "out of graphics memory while creating {what} ({mebibytes} MiB); choose a smaller picture, a lower \
         light-volume resolution or a smaller volume"
    )]
    OutOfMemory {
        /// Resource that could not be allocated.
        what: String,
        /// Size of the resource, in MiB.
        mebibytes: u64,
    },
    /// A limit on the process (`ulimit -v`) leaves less address space than a driver needs; without it the driver
    /// would abort the process.
    #[error(
        "{what} needs {needed_mebibytes} MiB of address space, and a limit of this process leaves \
         {left_mebibytes} MiB; `ulimit -v unlimited` removes it"
    )]
    AddressSpaceTooSmall {
        /// Component that needs the address space.
        what: String,
        /// Address space that it needs, in MiB.
        needed_mebibytes: u64,
        /// Address space that is free, in MiB.
        left_mebibytes: u64,
    },
    /// A size exceeds a limit of the adapter.
    #[error("{what} needs {size}, the limit is {limit}; {help}")]
    OverLimit {
        /// Resource that is too large.
        what: String,
        /// Requested size, in the unit of the limit.
        size: u64,
        /// Largest size that the adapter allows.
        limit: u64,
        /// Advice to the user.
        help: &'static str,
    },
    /// A resource was read back before anything was drawn into it.
    #[error("there is no {0} to read back: it was never drawn")]
    NothingDrawn(&'static str),
    /// The picture was cancelled before it was complete.
    #[error("the picture was cancelled")]
    Cancelled,
    /// A volume cannot be averaged to one with fewer voxels.
    #[error("the volume could not be averaged: {0}")]
    Volume(#[from] VolumeError),
    /// The graphics device failed at something that the program may ask for.
    #[error("the graphics driver refused: {0}")]
    Refused(String),
    /// The program asked for something invalid, or lacks one of its parts: a bug.
    #[error("internal error, please report it: {0}")]
    Internal(String),
    /// The device is lost, after a driver update, sleep or a watchdog reset.
    #[error("the graphics device was lost ({0})")]
    DeviceLost(String),
}
