//! What went wrong, or went well, in the status bar.

use std::path::Path;

use super::commands::{recall_view_keys, store_view_keys};

pub(crate) const DETAILS: &str = "Details";
pub(crate) const DISMISS: &str = "Dismiss";
/// The window of details.
pub(crate) const WHAT_HAPPENED: &str = "What happened";

pub(crate) const NOTHING_TO_GO_ON_WITH: &str = "There is nothing to go on with";
pub(crate) const OPENING_CANCELLED: &str = "Opening was cancelled";
pub(crate) const PRESET_NOT_APPLIED: &str = "the preset was not applied";
pub(crate) const TRANSFER_NOT_IMPORTED: &str = "the transfer function was not imported";
pub(crate) const TRANSFER_NOT_WRITTEN: &str = "the transfer function was not written";

pub(crate) const NO_PICTURE: &str = "There is no picture to export yet";
pub(crate) const EXPORT_RUNS: &str = "A picture is being exported";
pub(crate) const EXPORT_CANCELLED: &str = "Exporting was cancelled";
pub(crate) const PICTURE_NOT_EXPORTED: &str = "the picture was not exported";
pub(crate) const PICTURE_COPIED: &str = "The picture is on the clipboard";
pub(crate) const PICTURE_NOT_COPIED: &str = "the picture was not copied";

pub(crate) const BALANCE_NOT_MEASURED: &str = "the balance could not be measured";
pub(crate) const LOOK_NOT_MADE: &str = "the look could not be made";
pub(crate) const NOT_TURNED: &str = "the object could not be turned";
pub(crate) const LOOKS_NOT_TRIED: &str = "looks could not be tried";
pub(crate) const LIGHT_VOLUME_NOT_SHOWN: &str = "the light volume could not be shown";
pub(crate) const LIGHT_VOLUME_NOT_EXPORTED: &str = "the light volume was not exported";

pub(crate) const NOT_RENDERED: &str = "the picture could not be rendered";
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
pub(crate) const NO_DEVICE: &str = "the window has no wgpu device";

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
    let verb = if is_back { "Undone" } else { "Done again" };
    format!("{verb}: {what}")
}

pub(crate) const SURROUNDINGS_NOT_READ: &str = "the surroundings were not read";

/// A picture of surroundings lights the scene.
pub(crate) fn surrounded(name: &str, has_light: bool) -> String {
    if has_light {
        format!("Lit by {name}: its gradient, and its brightest light as the light “Surroundings”")
    } else {
        format!("Lit by {name}: its gradient; no light stands out in it")
    }
}

/// A view is kept under a digit.
pub(crate) fn view_kept(slot: u8) -> String {
    format!("View {slot} is kept: {} looks that way again", recall_view_keys(slot))
}

/// There is no view under a digit.
pub(crate) fn no_view_kept(slot: u8) -> String {
    format!("No view is kept as {slot}: {} keeps one", store_view_keys(slot))
}
