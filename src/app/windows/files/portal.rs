//! File dialog of the desktop portal, on systems where a desktop may have none.

use std::ffi::OsStr;
use std::time::Duration;

use zbus::connection::Builder;

/// The longest that is waited for an answer, in which the bus may have to start the portal first: later nobody knows
/// any more what was asked for.
const LONGEST_ANSWER: Duration = Duration::from_secs(4);

/// Method of the bus by which a property is read.
const METHOD: &str = "Get";

/// Program that shows a dialog where no portal does.
const SUBSTITUTE: &str = "zenity";

/// Whether there is such a dialog. Waits for an answer from the desktop, for seconds in the worst case.
pub(crate) fn has_file_dialog() -> bool {
    let asked = Builder::session().and_then(|bus| pollster::block_on(ask_portal(bus)));
    match asked {
        Ok(()) => true,
        Err(err) => {
            log::info!("no desktop portal for files: {err}");
            is_in(&std::env::var_os("PATH").unwrap_or_default(), SUBSTITUTE)
        }
    }
}

/// Asks the portal on a bus for its file chooser, which only a portal has that can show one (XDG Desktop Portal,
/// `org.freedesktop.portal.FileChooser`).
async fn ask_portal(bus: Builder<'_>) -> zbus::Result<()> {
    let bus = bus.method_timeout(LONGEST_ANSWER).build().await?;
    let asked = bus.call_method(
        Some("org.freedesktop.portal.Desktop"),
        "/org/freedesktop/portal/desktop",
        Some("org.freedesktop.DBus.Properties"),
        METHOD,
        &("org.freedesktop.portal.FileChooser", "version"),
    );
    asked.await.map(drop)
}

/// Whether a program is in one of the folders of a search path.
fn is_in(path: &OsStr, program: &str) -> bool {
    std::env::split_paths(path).any(|folder| folder.join(program).is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_bus_there_is_no_portal() {
        let folder = tempfile::tempdir().unwrap();
        let address = format!("unix:path={}", folder.path().join("none").display());
        let bus = Builder::address(address.as_str()).unwrap();
        pollster::block_on(ask_portal(bus)).unwrap_err();
    }

    #[test]
    fn programs_are_found_in_the_search_path() {
        let folder = tempfile::tempdir().unwrap();
        let other = tempfile::tempdir().unwrap();
        let path = std::env::join_paths([other.path(), folder.path()]).unwrap();
        assert!(!is_in(&path, SUBSTITUTE));
        std::fs::write(folder.path().join(SUBSTITUTE), "").unwrap();
        assert!(is_in(&path, SUBSTITUTE) && !is_in(OsStr::new(""), SUBSTITUTE));
    }
}
