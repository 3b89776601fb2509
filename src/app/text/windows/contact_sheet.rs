//! The contact sheet.

use std::fmt::Display;

pub(crate) const LOOKS: &str = "Try looks";
pub(crate) const LIGHTS: &str = "Try lights";
pub(crate) const SUGGESTIONS: &str = "Suggested lights";
pub(crate) const PRESETS: &str = "Try presets";

/// How many of them have been tried.
pub(crate) fn trying(done: usize, count: usize) -> String {
    if count == 0 {
        "Trying them on your volume".to_owned()
    } else {
        format!("Trying them on your volume, {done} of {count}")
    }
}
pub(crate) const AGAIN: &str = "Refresh";
/// Why the pictures are small and coarse.
pub(crate) const QUALITY: &str = "Click to apply";
pub(crate) const USE_TIP: &str = "Use it";

/// Why no light is suggested.
pub(crate) const NO_LIGHT: &str = "There is no light to be placed: add one, or select one";

/// What suggestions are compared with.
pub(crate) const AS_IT_IS: &str = "As it is";

/// A place for a light, from 1: the best first.
pub(crate) fn suggestion(light: &str, number: usize) -> String {
    format!("{light}, suggestion {number}")
}

/// A whole look, from 1.
pub(crate) fn look(number: usize, name: &str) -> String {
    format!("{number} · {name}")
}

/// What screen readers call a picture of a look.
pub(crate) fn use_look(name: &str) -> String {
    format!("Use {name}")
}

/// A light at an hour of a clock face.
pub(crate) fn at_hour(light: &str, hour: u32) -> String {
    format!("{light} at {hour} o'clock")
}

/// The system is out of threads.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("no thread for the pictures: {err}")
}
