//! What can go wrong on the GPU.

/// Why a picture could not be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum GpuError {
    /// No adapter at all, or none that can do what we need.
    #[error("no usable graphics adapter: {why}; {help}")]
    NoAdapter {
        /// What was looked for and not found.
        why: String,
        /// What the user can do.
        help: &'static str,
    },
    /// The GPU has no memory left, or not in one piece.
    #[error(
        "out of graphics memory while making {what} ({mebibytes} MiB); a smaller picture, a lower light-volume resolution or a smaller volume helps"
    )]
    OutOfMemory {
        /// What was to be made.
        what: String,
        /// Size of what was to be made.
        mebibytes: u64,
    },
    /// A user's limit leaves too few addresses for something that would end the program without them.
    #[error(
        "{what} needs {needed_mebibytes} MiB of addresses and a limit of this process leaves {left_mebibytes}; `ulimit -v unlimited` helps"
    )]
    FewAddresses {
        /// What needs them.
        what: String,
        /// How many it needs.
        needed_mebibytes: u64,
        /// How many there are.
        left_mebibytes: u64,
    },
    /// A size is beyond what the adapter can do.
    #[error("{what} needs {size}, this adapter allows {limit}; {help}")]
    OverLimit {
        /// What is too large.
        what: String,
        /// How large it is.
        size: u64,
        /// How large it may be.
        limit: u64,
        /// What the user can do.
        help: &'static str,
    },
    /// Something was read back that was never drawn.
    #[error("there is no {0} to read back: it was never drawn")]
    NothingDrawn(&'static str),
    /// A bug of ours or of the driver.
    #[error("the graphics driver refused: {0}")]
    Refused(String),
    /// The device is gone: driver update, sleep, watchdog.
    #[error("the graphics device was lost ({0})")]
    Lost(String),
}
