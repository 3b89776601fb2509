//! Whether the desktop has a dialog in which files are chosen.
//!
//! Windows and macOS have one. Elsewhere it is that of the desktop portal, a service on the session bus, or a program that
//! shows one; a desktop may have neither. A dialog that cannot be shown looks like one that was cancelled, so the desktop
//! is asked before.

/// Whether there is such a dialog. Waits for an answer from the desktop, for seconds in the worst case.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub(crate) fn has_file_dialog() -> bool {
    true
}

#[cfg(all(unix, not(target_os = "macos")))]
pub(crate) use super::portal::has_file_dialog;
