//! Texts of crash recovery, autosaved looks and protected session files.

use std::fmt::Display;
use std::path::Path;
use std::time::Duration;

/// Window that offers the looks of crashed runs.
pub(crate) const RECOVERY_TITLE: &str = "Reopen the last session?";
pub(crate) const RECOVERY_WHY: &str = "Chiaroscuro did not close properly. This is how it looked:";
pub(crate) const REOPEN: &str = "Reopen";
pub(crate) const NOT_NOW: &str = "Not now";
pub(crate) const NOT_NOW_TIP: &str = "The look stays available under File › Earlier looks";

/// Message of a safe start, after three starts failed.
pub(crate) const SAFE_START: &str = "The program failed three times to show a picture. It has started without the \
     requested file and session, and with the quality Fast: File › Open… opens the file, and Shadows › \
     Quality improves the light";

/// Headline of a message whose details list start-up notices.
pub(crate) const STARTUP_NOTICES: &str = "Not everything works as usual";

/// Window that asks for confirmation before a running export is discarded.
pub(crate) const EXPORTING: &str = "Quit while a picture is being exported?";
pub(crate) const EXPORTING_WHY: &str = "What has been exported so far would be discarded.";
pub(crate) const QUIT_AFTER: &str = "Quit when it is done";
pub(crate) const QUIT_NOW: &str = "Discard and quit";
pub(crate) const STAY: &str = "Stay";

/// Reasons why Ctrl+S asks for another file instead of overwriting the session.
pub(crate) const NOT_A_SESSION: &str = "it is not a session of this program";
pub(crate) const NEWER_SESSION: &str = "it was written by a newer version";
pub(crate) const UNKNOWN_CONTENT: &str = "some of its content could not be read";
pub(crate) const NOT_READ_YET: &str = "it has not been read yet";

/// Message for a session file that Ctrl+S does not overwrite.
pub(crate) fn session_protected(file: &Path, why: &str) -> String {
    format!("{} was not overwritten: {why}. Choose another file", file.display())
}

/// Menu entry of an autosaved look: name of its volume, and its age.
pub(crate) fn earlier_look(source: &str, ago: Duration) -> String {
    let name = Path::new(source).file_name().map_or_else(|| source.into(), |name| name.to_string_lossy());
    format!("{} · {}", name.trim_start_matches("builtin:"), age(ago))
}

/// Age in words, such as `2 h ago`.
pub(crate) fn age(ago: Duration) -> String {
    let minutes = ago.as_secs() / 60;
    match minutes {
        0 => "just now".to_owned(),
        1..60 => format!("{minutes} min ago"),
        60..2880 => format!("{} h ago", minutes / 60),
        _ => format!("{} days ago", minutes / 1440),
    }
}

/// Notice that a corrupt state file was quarantined under another name.
pub(crate) fn quarantined(file: &Path, aside: &Path) -> String {
    let name = aside.file_name().unwrap_or_default().to_string_lossy();
    format!("{} could not be read, and was renamed to {name}", file.display())
}

/// Notice that a corrupt state file could not even be renamed.
pub(crate) fn quarantine_failed(file: &Path, why: impl Display) -> String {
    format!("{} could not be read or renamed: {why}", file.display())
}

/// Notice that the storage folder is unusable, so nothing will be autosaved.
pub(crate) fn storage_failed(folder: &Path, why: impl Display) -> String {
    format!("looks cannot be autosaved in {}: {why}", folder.display())
}

/// Notice that the autosave of the look failed.
pub(crate) fn autosave_failed(why: &str) -> String {
    format!("the look cannot be autosaved: {why}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_as_people_say_them() {
        let after = |seconds| earlier_look("/data/tooth.nrrd", Duration::from_secs(seconds));
        assert_eq!(after(59), "tooth.nrrd · just now");
        assert_eq!(after(60), "tooth.nrrd · 1 min ago");
        assert_eq!(after(7200), "tooth.nrrd · 2 h ago");
        assert_eq!(after(3 * 86_400), "tooth.nrrd · 3 days ago");
        assert_eq!(earlier_look("builtin:chair:32", Duration::ZERO), "chair:32 · just now");
    }
}
