//! The strip of kept views and looks.

use super::shell::commands::{recall_view_keys, store_view_keys};
use super::{Named, named};

pub(crate) const NOTHING: &str = "Nothing is kept yet: a view is where you look from, a look is how it looks";
pub(crate) const KEEP_VIEW: Named = named("+ View", "Keep where you look from");
pub(crate) const KEEP_LOOK: Named =
    named("+ Look", "Keep how it looks: transfer function, lights, shadows, cuts and the rest");
pub(crate) const SHEET: Named = named("Contact sheet…", "Write all of them into one picture");
pub(crate) const CLOSE: Named = named("Close", "Hide the strip; what is kept stays");

pub(crate) const NAME: &str = "Name";
pub(crate) const REPLACE: Named =
    named("Replace with the present one", "Keep what is shown now in its place");
pub(crate) const WITH_VIEW: Named = named("Go to it with its view", "Also look from where it was kept");
pub(crate) const COMPARE: Named =
    named("Compare with the picture", "Left of a divider the picture, right of it this view or look");
pub(crate) const MARK: Named =
    named("Mark to compare", "Two that are marked are compared; Ctrl (⌘ on a Mac) and a click does the same");
pub(crate) const REMOVE: Named = named("Remove", "It is kept no longer");
pub(crate) const DIGIT: &str = "Key";
pub(crate) const NO_ROOM: &str = "There is no room for it: at most 32 views and looks are kept, and a table of a thousand labels is too much for one";

/// What a small picture is called.
pub(crate) fn go_to(name: &str) -> String {
    format!("Go to {name}")
}

/// What a click does.
pub(crate) fn tip(name: &str, is_look: bool, digit: Option<u8>) -> String {
    let what = if is_look { "Take this look; the view stays" } else { "Look from here" };
    let key = digit.map_or_else(String::new, |digit| format!(" ({})", recall_view_keys(digit)));
    format!("{name}\n{what}{key}\nDrag to another place; right click for more")
}

/// The digit of a view or look.
pub(crate) fn key(digit: u8) -> String {
    recall_view_keys(digit)
}

/// The name of a view that somebody keeps, by its number.
pub(crate) fn view_name(number: usize) -> String {
    format!("View {number}")
}

/// The name of a look that somebody keeps, by its number.
pub(crate) fn look_name(number: usize) -> String {
    format!("Look {number}")
}

/// A view or look is kept.
pub(crate) fn kept(name: &str) -> String {
    format!("{name} is kept in the strip below the picture")
}

/// A view is kept under a digit.
pub(crate) fn view_kept(digit: u8) -> String {
    format!("View {digit} is kept: {} looks that way again", recall_view_keys(digit))
}

/// Nothing is kept under a digit.
pub(crate) fn nothing_under(digit: u8) -> String {
    format!("Nothing is kept under {digit}: {} keeps a view there", store_view_keys(digit))
}

/// How many pictures are still made.
pub(crate) fn making(left: usize) -> String {
    format!("{left} to draw")
}
