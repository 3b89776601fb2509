//! Texts of the start screen, which is shown while no volume is open.

pub(crate) const RECENT: &str = "Recent files";
pub(crate) const NO_RECENT: &str = "Files that you open are listed here";
pub(crate) const DROP_HINT: &str = "Drop a file here";
pub(crate) const OPEN_FILE: &str = "Open file…";

/// Describes a built-in scene in one line, by the name of its volume.
pub(crate) fn scene_line(volume: &str) -> &'static str {
    match volume {
        "bone" => "Soft shadows in deep openings",
        "cloud" => "Sunlight scattered many times",
        "wax" => "Light that glows through thin parts",
        "stained_glass" => "Coloured shadows on the floor",
        "cells" => "Nuclei in clear membranes",
        _ => "",
    }
}

/// Name of a scene's card for screen readers.
pub(crate) fn card(title: &str, line: &str) -> String {
    format!("{title}: {line}")
}
