//! What can keep a window from opening.

use crate::gpu::GpuError;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// No device that can be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The window system refused.
    #[error("the window could not be opened: {0}; a running desktop session is needed")]
    Window(#[from] eframe::Error),
    /// The operating system gave no thread.
    #[error("no thread could be started: {0}")]
    Thread(#[from] std::io::Error),
}
