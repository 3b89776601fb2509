//! Texts of notifications and errors over the picture.

use std::path::Path;

use chiaroscuro_files::sanitised;

/// Texts of the window that lists all messages.
pub(crate) const LIST: &str = "Messages";
pub(crate) const LIST_TIP: &str = "All messages since the start";
pub(crate) const NO_MESSAGES: &str = "No messages yet";
pub(crate) const DETAILS: &str = "Details";
pub(crate) const DISMISS: &str = "Dismiss";
/// Title of the window of error details.
pub(crate) const DETAILS_TITLE: &str = "Error details";

pub(crate) const NO_SESSION_TO_REOPEN: &str = "There is no session to reopen";
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
pub(crate) const TURN_FAILED: &str = "The object could not be turned";
pub(crate) const LOOKS_NOT_TRIED: &str = "Looks could not be tried";
pub(crate) const LIGHT_VOLUME_NOT_SHOWN: &str = "The light volume could not be shown";
pub(crate) const LIGHT_VOLUME_NOT_EXPORTED: &str = "The light volume was not exported";

pub(crate) const NOT_RENDERED: &str = "The picture could not be rendered";
pub(crate) const DEVICE_LOST: &str = "the graphics device was lost";
pub(crate) const DEVICE_REPLACED: &str = "The graphics device was lost and has been restored";
/// Question after the graphics device was lost twice within a minute.
pub(crate) const DEVICE_LOST_AGAIN: &str = "The graphics device was lost again";
pub(crate) const LOST_AGAIN_WHY: &str =
    "It was lost twice within a minute. The look is kept. How do you want to continue?";
pub(crate) const TRY_AGAIN: &str = "Try again";
pub(crate) const LOWER_QUALITY: &str = "Lower quality";
pub(crate) const USE_CPU: &str = "Use the processor instead";
/// Reason why rendering cannot fall back to a software rasteriser.
pub(crate) const NO_CPU_ADAPTER: &str = "no software graphics driver was found";
/// Error of a start without a graphics device.
pub(crate) const NO_DEVICE: &str = "the window has no graphics device";

/// Number of messages in the list.
pub(crate) fn count(count: usize) -> String {
    if count == 1 { "1 message".to_owned() } else { format!("{count} messages") }
}

/// Message after a picture, turntable or light volume was exported.
pub(crate) fn exported(path: &Path) -> String {
    format!("Exported {}", path.display())
}

/// Message after a transfer function was written.
pub(crate) fn written(path: &Path) -> String {
    format!("Wrote {}", path.display())
}

/// Message after an undo or redo.
pub(crate) fn undone(is_back: bool, what: &str) -> String {
    let verb = if is_back { "Undone" } else { "Redone" };
    format!("{verb}: {what}")
}

pub(crate) const ENVIRONMENT_MAP_NOT_READ: &str = "The environment map was not read";

/// Message after an environment map was applied.
pub(crate) fn environment_map_applied(name: &str, has_light: bool) -> String {
    if has_light {
        format!(
            "Lit by {name}: its colour gradient as the sky, and its brightest light as the light \
             “Surroundings”"
        )
    } else {
        format!("Lit by {name}: its colour gradient as the sky; it has no distinct bright light")
    }
}

/// Messages about volumes that are shown as layers.
pub(crate) const LAYER_NOT_ADDED: &str = "The volume is not shown as a layer";
pub(crate) const NO_VOLUME_FOR_LAYER: &str = "Open a volume first; a layer is shown with it";
/// Reason why a volume is not shown as a layer, with its file.
pub(crate) fn layer_refused(path: &Path, why: impl std::fmt::Display) -> String {
    format!("{}: {why}", path.display())
}

/// Message about a further volume of a look that is in a folder from which the look may open nothing.
pub(crate) fn layer_not_opened(path: &str) -> String {
    format!(
        "The look also shows {}, which is in another folder: add it with File › Add volume as layer…",
        sanitised(path, 200)
    )
}

pub(crate) const LAYER_OF_OTHER_VOLUME: &str =
    "Another volume was opened, so the layer is not shown; add it again";
