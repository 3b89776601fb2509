//! Texts of the strip of saved views and looks.

use super::shell::commands::{recall_view_keys, store_view_keys};
use super::{ControlText, control_text};

pub(crate) const NOTHING: &str =
    "No saved views or looks yet. A view is a camera position, a look is everything else";
pub(crate) const SAVE_VIEW: ControlText = control_text("+ View", "Save the camera position");
pub(crate) const SAVE_LOOK: ControlText =
    control_text("+ Look", "Save transfer function, lights, shadows, cuts and the rest");
pub(crate) const SHEET: ControlText =
    control_text("Contact sheet…", "Write all saved views and looks into one picture");
pub(crate) const CLOSE: ControlText = control_text("Close", "Hide the strip; saved views and looks stay");

pub(crate) const NAME: &str = "Name";
pub(crate) const REPLACE: ControlText =
    control_text("Replace with current", "Overwrite it with the current view or look");
pub(crate) const WITH_VIEW: ControlText =
    control_text("Apply with its view", "Also restore the camera position saved with the look");
pub(crate) const COMPARE: ControlText = control_text(
    "Compare with the picture",
    "Shows the current picture left of a divider, and this view or look right of it",
);
pub(crate) const MARK: ControlText = control_text(
    "Mark to compare",
    "Marks it for a comparison with another marked one; Ctrl-click (⌘-click on a Mac) does the same",
);
pub(crate) const REMOVE: ControlText = control_text("Remove", "Delete it from the list");
pub(crate) const DIGIT: &str = "Key";
pub(crate) const TOO_MANY: &str = "Not saved: there is room for 32 views and looks, 256 KiB in all; a look with a \
     table of a thousand labels is too large";

/// Accessible name of a thumbnail in the strip.
pub(crate) fn thumbnail_name(name: &str) -> String {
    format!("Go to {name}")
}

/// Tooltip of a thumbnail: name, effect of a click and its key.
pub(crate) fn tooltip(name: &str, is_look: bool, digit: Option<u8>) -> String {
    let what = if is_look { "Apply this look; the view stays" } else { "Go to this view" };
    let key = digit.map_or_else(String::new, |digit| format!(" ({})", recall_view_keys(digit)));
    format!("{name}\n{what}{key}\nDrag to reorder; right-click for more")
}

/// Keyboard shortcut of a view or look with a digit.
pub(crate) fn shortcut(digit: u8) -> String {
    recall_view_keys(digit)
}

/// Default name of the saved view with this number.
pub(crate) fn view_name(number: usize) -> String {
    format!("View {number}")
}

/// Default name of the saved look with this number.
pub(crate) fn look_name(number: usize) -> String {
    format!("Look {number}")
}

/// Message after a view or look was saved.
pub(crate) fn saved(name: &str) -> String {
    format!("Saved {name} in the strip below the picture")
}

/// Message after a view was saved under a digit.
pub(crate) fn view_saved(digit: u8) -> String {
    format!("Saved view {digit}: {} goes back to it", recall_view_keys(digit))
}

/// Message when a digit has no saved view.
pub(crate) fn digit_is_empty(digit: u8) -> String {
    format!("No view is saved under {digit}: {} saves one", store_view_keys(digit))
}

/// Number of thumbnails that remain to be drawn.
pub(crate) fn thumbnails_left(left: usize) -> String {
    format!("{left} to draw")
}
