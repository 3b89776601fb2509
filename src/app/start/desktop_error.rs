//! Error message on the desktop when no window can be opened.
//!
//! A program that is started from a menu has no terminal for standard error.

use std::ffi::OsString;
use std::io::IsTerminal as _;
use std::sync::mpsc;
use std::time::Duration;

use crate::app::text;

/// Maximum time for which the message blocks the program, in case it was started from a script.
const MESSAGE_TIMEOUT: Duration = Duration::from_mins(1);

/// Environment in which the program was started.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
struct LaunchEnvironment {
    /// True where messages need an X or Wayland server; other systems show errors without one.
    has_servers: bool,
    /// True if the environment names an X server.
    has_x: bool,
    /// True if the environment names a Wayland server.
    has_wayland: bool,
    /// True if standard error is a terminal.
    has_terminal: bool,
}

impl LaunchEnvironment {
    fn now() -> Self {
        let is_named = |value: Option<OsString>| value.is_some_and(|value| !value.is_empty());
        Self {
            has_servers: cfg!(all(unix, not(target_os = "macos"))),
            has_x: is_named(std::env::var_os("DISPLAY")),
            has_wayland: is_named(std::env::var_os("WAYLAND_DISPLAY")),
            has_terminal: std::io::stderr().is_terminal(),
        }
    }

    /// Returns true if there is a desktop for the message, and no terminal that shows the error.
    fn wants_message(self) -> bool {
        self.has_servers && (self.has_x || self.has_wayland) && !self.has_terminal
    }
}

/// Shows the reason on the desktop why no window opens, if there is no terminal, and waits until the message is
/// closed. Does nothing where the desktop cannot show messages.
pub fn show_on_desktop(why: &str) {
    if !LaunchEnvironment::now().wants_message() {
        return;
    }
    let message = rfd::MessageDialog::new()
        .set_level(rfd::MessageLevel::Error)
        .set_title(text::opening::PROGRAM)
        .set_description(text::opening::no_window(why));
    let (seen, until_seen) = mpsc::channel();
    let shown = std::thread::Builder::new().name("message".to_owned()).spawn(move || {
        message.show();
        // The receiver is gone if this has taken too long.
        seen.send(()).ok();
    });
    if shown.is_ok() {
        until_seen.recv_timeout(MESSAGE_TIMEOUT).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_desktop_without_a_terminal_is_told() {
        let menu =
            LaunchEnvironment { has_servers: true, has_x: true, has_wayland: true, has_terminal: false };
        assert!(menu.wants_message());
        assert!(LaunchEnvironment { has_x: false, ..menu }.wants_message());
        assert!(LaunchEnvironment { has_wayland: false, ..menu }.wants_message());
        for other in [
            LaunchEnvironment { has_x: false, has_wayland: false, ..menu },
            LaunchEnvironment { has_terminal: true, ..menu },
            LaunchEnvironment { has_servers: false, ..menu },
        ] {
            assert!(!other.wants_message(), "{other:?}");
        }
    }
}
