//! What somebody sees who has started the window from a menu, where no window can be opened: standard error goes
//! nowhere there.

use std::ffi::OsString;
use std::io::IsTerminal as _;
use std::sync::mpsc;
use std::time::Duration;

use crate::app::text;

/// How long the message holds the program: whoever has started it from a script after all is not held for ever.
const LONGEST: Duration = Duration::from_mins(1);

/// Where a program was started.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
struct Start {
    /// The system shows messages through an X or a Wayland server, and elsewhere by itself.
    has_servers: bool,
    /// An X server is named.
    has_x: bool,
    /// A Wayland server is named.
    has_wayland: bool,
    /// Standard error is read by somebody.
    says_on_terminal: bool,
}

impl Start {
    fn now() -> Self {
        let is_named = |value: Option<OsString>| value.is_some_and(|value| !value.is_empty());
        Self {
            has_servers: cfg!(all(unix, not(target_os = "macos"))),
            has_x: is_named(std::env::var_os("DISPLAY")),
            has_wayland: is_named(std::env::var_os("WAYLAND_DISPLAY")),
            says_on_terminal: std::io::stderr().is_terminal(),
        }
    }

    /// Whether there is a desktop to show a message on, and nobody would see it otherwise.
    fn wants_message(self) -> bool {
        self.has_servers && (self.has_x || self.has_wayland) && !self.says_on_terminal
    }
}

/// Shows on the desktop why no window opens, if nobody would read it elsewhere, and waits until it has been seen.
/// Where the desktop has nothing that shows messages, nothing happens.
pub fn show_on_desktop(why: &str) {
    if !Start::now().wants_message() {
        return;
    }
    let message = rfd::MessageDialog::new()
        .set_level(rfd::MessageLevel::Error)
        .set_title(text::opening::PROGRAM)
        .set_description(text::opening::no_window(why));
    let (seen, until_seen) = mpsc::channel();
    let shown = std::thread::Builder::new().name("message".to_owned()).spawn(move || {
        message.show();
        // Nobody waits any more when it has taken too long.
        seen.send(()).ok();
    });
    if shown.is_ok() {
        until_seen.recv_timeout(LONGEST).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_desktop_without_a_terminal_is_told() {
        let menu = Start { has_servers: true, has_x: true, has_wayland: true, says_on_terminal: false };
        assert!(menu.wants_message());
        assert!(Start { has_x: false, ..menu }.wants_message());
        assert!(Start { has_wayland: false, ..menu }.wants_message());
        for other in [
            Start { has_x: false, has_wayland: false, ..menu },
            Start { says_on_terminal: true, ..menu },
            Start { has_servers: false, ..menu },
        ] {
            assert!(!other.wants_message(), "{other:?}");
        }
    }
}
