//! File dialog of the XDG desktop portal, on systems whose desktop may have none.

use std::ffi::OsStr;
use std::time::Duration;

use zbus::connection::Builder;

/// Longest wait for an answer, during which the bus may have to start the portal first; after more, users forget
/// their request.
const PORTAL_TIMEOUT: Duration = Duration::from_secs(4);

/// Bus method that reads a property.
const GET_PROPERTY: &str = "Get";

/// Helper program that shows a dialog if there is no portal.
const HELPER_PROGRAM: &str = "zenity";

/// Returns true if the desktop has a file dialog. Blocks until the desktop answers, for seconds in the worst case.
pub(crate) fn has_file_dialog() -> bool {
    let reply = Builder::session().and_then(|bus| pollster::block_on(query_portal(bus)));
    match reply {
        Ok(()) => true,
        Err(err) => {
            log::info!("no desktop portal for files: {err}");
            is_in_path(&std::env::var_os("PATH").unwrap_or_default(), HELPER_PROGRAM)
        }
    }
}

/// Queries the portal on a bus for its file chooser, which only a portal that can show one has (XDG Desktop Portal,
/// `org.freedesktop.portal.FileChooser`).
async fn query_portal(bus: Builder<'_>) -> zbus::Result<()> {
    let bus = bus.method_timeout(PORTAL_TIMEOUT).build().await?;
    let asked = bus.call_method(
        Some("org.freedesktop.portal.Desktop"),
        "/org/freedesktop/portal/desktop",
        Some("org.freedesktop.DBus.Properties"),
        GET_PROPERTY,
        &("org.freedesktop.portal.FileChooser", "version"),
    );
    asked.await.map(drop)
}

/// Returns true if a program is in one of the folders of a search path.
fn is_in_path(path: &OsStr, program: &str) -> bool {
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
        pollster::block_on(query_portal(bus)).unwrap_err();
    }

    #[test]
    fn programs_are_found_in_the_search_path() {
        let folder = tempfile::tempdir().unwrap();
        let other = tempfile::tempdir().unwrap();
        let path = std::env::join_paths([other.path(), folder.path()]).unwrap();
        assert!(!is_in_path(&path, HELPER_PROGRAM));
        std::fs::write(folder.path().join(HELPER_PROGRAM), "").unwrap();
        assert!(is_in_path(&path, HELPER_PROGRAM) && !is_in_path(OsStr::new(""), HELPER_PROGRAM));
    }
}
