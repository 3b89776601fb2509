//! Texts of the strip of saved views and looks.

use super::shell::commands::{recall_view_keys, store_view_keys};
use super::{ControlText, control_text};

pub(crate) const NOTHING: &str =
    "No saved views or looks yet. A view is a camera position, a look is everything else";
pub(crate) const SAVE_VIEW: ControlText = control_text("+ View", "Save the camera position");
pub(crate) const SAVE_LOOK: ControlText =
    control_text("+ Look", "Save transfer function, lights, shadows, cuts and the rest");
pub(crate) const SHEET: ControlText = control_text("Contact sheet…", "Write all of them into one picture");
pub(crate) const CLOSE: ControlText = control_text("Close", "Hide the strip; saved views and looks stay");

pub(crate) const NAME: &str = "Name";
pub(crate) const REPLACE: ControlText =
    control_text("Replace with current", "Save what is shown now in its place");
pub(crate) const WITH_VIEW: ControlText =
    control_text("Go to it with its view", "Also take the camera position of that time");
pub(crate) const COMPARE: ControlText =
    control_text("Compare with the picture", "Left of a divider the picture, right of it this view or look");
pub(crate) const MARK: ControlText = control_text(
    "Mark to compare",
    "Two that are marked are compared; Ctrl (⌘ on a Mac) and a click does the same",
);
pub(crate) const REMOVE: ControlText = control_text("Remove", "Delete it from the list");
pub(crate) const DIGIT: &str = "Key";
pub(crate) const TOO_MANY: &str = "There is no room for it: at most 32 views and looks are saved, and a table of a thousand labels is too much for one";

/// Accessible name of a thumbnail in the strip.
pub(crate) fn thumbnail_name(name: &str) -> String {
    format!("Go to {name}")
}

/// Tooltip of a thumbnail: name, effect of a click and its key.
pub(crate) fn tooltip(name: &str, is_look: bool, digit: Option<u8>) -> String {
    let what = if is_look { "Take this look; the view stays" } else { "Look from here" };
    let key = digit.map_or_else(String::new, |digit| format!(" ({})", recall_view_keys(digit)));
    format!("{name}\n{what}{key}\nDrag to another place; right click for more")
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
    format!("Saved view {digit}: {} looks that way again", recall_view_keys(digit))
}

/// Message when a digit has no saved view.
pub(crate) fn digit_is_empty(digit: u8) -> String {
    format!("Nothing is saved under {digit}: {} saves a view there", store_view_keys(digit))
}

/// Number of thumbnails that remain to be drawn.
pub(crate) fn thumbnails_left(left: usize) -> String {
    format!("{left} to draw")
}
