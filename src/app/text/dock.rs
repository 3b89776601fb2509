//! Tools that are docked beside the picture.

pub(crate) const CLOSE: &str = "Close";

/// Puts a tool beside the picture.
pub(crate) fn dock(title: &str) -> String {
    format!("Dock {title} beside the picture")
}

/// Makes a window of a tool again.
pub(crate) fn float(title: &str) -> String {
    format!("Make {title} a window")
}
