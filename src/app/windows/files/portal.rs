//! File dialog of the XDG desktop portal, on systems whose desktop may have none.

use std::ffi::OsStr;
use std::time::Duration;

use zbus::connection::Builder;

/// Longest wait for an answer, during which the bus may have to start the portal first; after more, users forget
/// their request.
const LONGEST_ANSWER: Duration = Duration::from_secs(4);

/// Bus method that reads a property.
const METHOD: &str = "Get";

/// Helper program that shows a dialog if there is no portal.
const SUBSTITUTE: &str = "zenity";

/// Returns true if the desktop has a file dialog. Blocks until the desktop answers, for seconds in the worst case.
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

/// Queries the portal on a bus for its file chooser, which only a portal that can show one has (XDG Desktop Portal,
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

/// Returns true if a program is in one of the folders of a search path.
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
