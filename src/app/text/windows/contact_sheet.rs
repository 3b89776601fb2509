//! Texts of the contact sheet of looks, lights and presets.

use std::fmt::Display;

pub(crate) const LOOKS: &str = "Try looks";
pub(crate) const LIGHTS: &str = "Try lights";
pub(crate) const SUGGESTIONS: &str = "Suggested lights";
pub(crate) const PRESETS: &str = "Try presets";

/// Progress of the thumbnails, with their total number.
pub(crate) fn progress(done: usize, count: usize) -> String {
    if count == 0 {
        "Trying them on your volume".to_owned()
    } else {
        format!("Trying them on your volume, {done} of {count}")
    }
}
pub(crate) const AGAIN: &str = "Refresh";
/// Hint below the small, coarse pictures.
pub(crate) const CLICK_HINT: &str = "Click to apply";
pub(crate) const USE_TIP: &str = "Use it";

/// Reason why no light can be suggested.
pub(crate) const NO_LIGHT: &str = "There is no light to place: add or select one";

/// Name of the unchanged picture beside the suggestions.
pub(crate) const UNCHANGED: &str = "As it is";

/// Name of a suggested light position, numbered from 1 with the best first.
pub(crate) fn suggestion_name(light: &str, number: usize) -> String {
    format!("{light}, suggestion {number}")
}

/// Name of a suggested look, numbered from 1.
pub(crate) fn look_name(number: usize, name: &str) -> String {
    format!("{number} · {name}")
}

/// Accessible name of the thumbnail of a look.
pub(crate) fn use_look(name: &str) -> String {
    format!("Use {name}")
}

/// Name of a light position by the hour of a clock face.
pub(crate) fn clock_position(light: &str, hour: u32) -> String {
    format!("{light} at {hour} o'clock")
}

/// Error when the thumbnail thread cannot be spawned.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("could not start the preview thread: {err}")
}
