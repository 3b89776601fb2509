//! What went wrong, or went well, over the picture.

use std::path::Path;

/// All that was said.
pub(crate) const LIST: &str = "Messages";
pub(crate) const LIST_TIP: &str = "All messages since the start";
pub(crate) const NOTHING_SAID: &str = "Nothing has been said yet";
pub(crate) const DETAILS: &str = "Details";
pub(crate) const DISMISS: &str = "Dismiss";
/// The window of details.
pub(crate) const WHAT_HAPPENED: &str = "What happened";

pub(crate) const NOTHING_TO_GO_ON_WITH: &str = "There is no session to reopen";
pub(crate) const PICTURE_ONLY: &str = "Picture only: Escape brings the panels back";
pub(crate) const OPENING_CANCELLED: &str = "Opening was cancelled";
pub(crate) const PRESET_NOT_APPLIED: &str = "The preset was not applied";
pub(crate) const TRANSFER_NOT_IMPORTED: &str = "The transfer function was not imported";
pub(crate) const TRANSFER_NOT_WRITTEN: &str = "The transfer function was not written";

pub(crate) const NO_PICTURE: &str = "There is no picture to export yet";
pub(crate) const EXPORT_RUNS: &str = "A picture is being exported";
pub(crate) const EXPORT_CANCELLED: &str = "Exporting was cancelled";
pub(crate) const PICTURE_NOT_EXPORTED: &str = "The picture was not exported";
pub(crate) const PICTURE_COPIED: &str = "The picture is on the clipboard";
pub(crate) const PICTURE_NOT_COPIED: &str = "The picture was not copied";

pub(crate) const BALANCE_NOT_MEASURED: &str = "The balance could not be measured";
pub(crate) const LOOK_NOT_MADE: &str = "The look could not be made";
pub(crate) const NOT_TURNED: &str = "The object could not be turned";
pub(crate) const LOOKS_NOT_TRIED: &str = "Looks could not be tried";
pub(crate) const LIGHT_VOLUME_NOT_SHOWN: &str = "The light volume could not be shown";
pub(crate) const LIGHT_VOLUME_NOT_EXPORTED: &str = "The light volume was not exported";

pub(crate) const NOT_RENDERED: &str = "The picture could not be rendered";
pub(crate) const DEVICE_LOST: &str = "the graphics device was lost";
pub(crate) const DEVICE_IS_BACK: &str = "The graphics device was lost; everything is here again";
/// The window that asks when that happens again and again.
pub(crate) const LOST_AGAIN: &str = "The graphics device was lost again";
pub(crate) const LOST_AGAIN_WHY: &str = "Twice within a minute. The look is kept; how shall it go on?";
pub(crate) const TRY_AGAIN: &str = "Try again";
pub(crate) const LOWER_QUALITY: &str = "Lower quality";
pub(crate) const USE_CPU: &str = "Use the processor instead";
/// Why the processor cannot draw instead.
pub(crate) const NO_CPU_ADAPTER: &str = "no driver draws with the processor";
/// Why the window cannot start.
pub(crate) const NO_DEVICE: &str = "the window has no graphics device";

/// How much has been said.
pub(crate) fn count(count: usize) -> String {
    if count == 1 { "1 message".to_owned() } else { format!("{count} messages") }
}

/// A picture, a light volume or a turntable is in its file.
pub(crate) fn exported(path: &Path) -> String {
    format!("Exported {}", path.display())
}

/// A transfer function is in its file.
pub(crate) fn wrote(path: &Path) -> String {
    format!("Wrote {}", path.display())
}

/// A step back or forward was taken.
pub(crate) fn went(is_back: bool, what: &str) -> String {
    let verb = if is_back { "Undone" } else { "Redone" };
    format!("{verb}: {what}")
}

pub(crate) const SURROUNDINGS_NOT_READ: &str = "The surroundings were not read";

/// A picture of surroundings lights the scene.
pub(crate) fn surrounded(name: &str, has_light: bool) -> String {
    if has_light {
        format!("Lit by {name}: its gradient, and its brightest light as the light “Surroundings”")
    } else {
        format!("Lit by {name}: its gradient; no light stands out in it")
    }
}
