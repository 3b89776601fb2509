//! Fault injection: the hidden option `--fault` makes memory, disk, device or a thread fail, so that tests see how
//! the ordinary program reacts.
//!
//! Code that can fail queries this module. Only builds with the feature `faults` have the option: in others, such as
//! those for distribution, the queries are constants. With the feature, but without the option, each query reads one
//! atomic flag.

use std::time::Duration;

#[cfg(any(test, feature = "faults"))]
mod hooks;
#[cfg(not(any(test, feature = "faults")))]
mod no_hooks;

#[cfg(any(test, all(feature = "faults", feature = "testing")))]
pub use hooks::count_so_far;
#[cfg(any(test, feature = "faults"))]
pub use hooks::{
    adapter_delay, count, frame_delay, is_due, is_on, panic_if_injected, set_faults,
    wait_while_files_are_held,
};
#[cfg(not(any(test, feature = "faults")))]
pub use no_hooks::{
    adapter_delay, count, frame_delay, is_due, is_on, panic_if_injected, wait_while_files_are_held,
};

/// Thread that can be made to panic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultThread {
    /// Thread that opens volumes.
    Loader,
    /// Thread that renders the window's pictures.
    Worker,
    /// Main thread of the window.
    Window,
    /// Thread that exports pictures.
    Export,
}

/// Fault to be injected, as given by `--fault`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InjectedFault {
    /// Loss of the window's and the renderer's devices in the window's N-th frame.
    DeviceLost(u64),
    /// Loss of the renderer's device alone in the window's N-th frame.
    RendererDeviceLost(u64),
    /// Allocation failure of the adapter for the K-th texture or buffer.
    OutOfMemory(u64),
    /// Panic of a thread at its next task.
    Panic(FaultThread),
    /// Failure to compile any shader.
    Shader,
    /// Additional delay of every wait for the adapter.
    Slow(Duration),
    /// Additional delay of every frame of the window.
    SlowFrames(Duration),
    /// Failure of every write to a file.
    FullDisk,
    /// Failure to read the N-th block of a volume.
    ReadError(u64),
    /// Delay of reading looks and other small files for as long as this is chosen, for tests that see the window wait.
    HeldFiles,
}

/// Event that is counted, so that a fault can name the N-th one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultEvent {
    /// Request for a texture or buffer of the adapter.
    Allocation,
    /// Block read from the file of a volume.
    BlockRead,
    /// Frame of any window of this process.
    WindowFrame,
}
