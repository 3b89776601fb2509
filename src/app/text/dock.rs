//! Texts of tool windows that can be docked beside the picture.

pub(crate) const CLOSE: &str = "Close";

/// Accessible name of the button that docks a tool beside the picture.
pub(crate) fn dock_name(title: &str) -> String {
    format!("Dock {title} beside the picture")
}

/// Accessible name of the button that turns a docked tool into a window again.
pub(crate) fn undock_name(title: &str) -> String {
    format!("Make {title} a window")
}
