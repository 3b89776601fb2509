//! Detection of a file dialog of the desktop.
//!
//! Windows and macOS have one. Elsewhere it is that of the desktop portal, a service on the session bus, or a helper
//! program; a desktop may have neither. A dialog that cannot be shown looks like a cancelled one, so the desktop is
//! queried first.

/// Returns true if the desktop has a file dialog. Blocks until the desktop answers, for seconds in the worst case.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub(crate) fn has_file_dialog() -> bool {
    true
}

#[cfg(all(unix, not(target_os = "macos")))]
pub(crate) use super::portal::has_file_dialog;
