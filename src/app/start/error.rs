//! Errors that keep a window from opening.

use crate::app::text;
use chiaroscuro_render::GpuError;

/// Error of a start without a window.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// Failure to find a usable graphics device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Window without a graphics device.
    #[error("{}", text::messages::NO_DEVICE)]
    NoDevice,
    /// Failure of the window system.
    #[error("the window could not be opened: {}; a running desktop session is needed", window_error_reason(.0))]
    Window(#[from] eframe::Error),
    /// Failure of the operating system to start a thread.
    #[error("no thread could be started: {0}")]
    Thread(#[from] std::io::Error),
}

/// Returns the window system's reason, without the source location in its library, which is a path on the build
/// machine: `winit EventLoopError: os error at FILE:LINE: REASON`.
fn window_error_reason(error: &eframe::Error) -> String {
    let text = error.to_string();
    let reason = text.split_once(".rs:").and_then(|(_, rest)| {
        let (line, reason) = rest.split_once(": ")?;
        line.bytes().all(|byte| byte.is_ascii_digit()).then(|| reason.trim_end_matches('.').to_owned())
    });
    reason.unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_in_libraries_are_no_reasons() {
        let says = |text: &str| AppError::from(eframe::Error::AppCreation(text.into())).to_string();
        let found = says(
            "winit EventLoopError: os error at /home/a/.cargo/registry/b/mod.rs:757: neither A nor B is set.",
        );
        assert!(found.contains("could not be opened: neither A nor B is set; a running"), "{found}");
        for other in ["no adapter", "os error at all", "os error at a.rs:x: b"] {
            assert!(says(other).contains(other), "{other}");
        }
    }
}
