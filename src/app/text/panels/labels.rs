//! Texts of the table of labels, which replaces the transfer function editor for label maps.

use crate::app::text::{ControlText, control_text};

pub(crate) const FILTER: ControlText = control_text(
    "Filter labels",
    "Lists only labels whose number or name contains this text; Escape clears it",
);
pub(crate) const FILTER_HINT: &str = "number or name";
pub(crate) const SHOW_ALL: ControlText = control_text(
    "Show listed",
    "Shows every label of the list, except 0 and negative numbers, which are background",
);
pub(crate) const HIDE_ALL: ControlText =
    control_text("Hide listed", "Hides every label of the list, and its shadow");
pub(crate) const ONLY_TIP: &str = "Shows only this label";
pub(crate) const VISIBLE_TIP: &str = "Whether the label is visible and casts shadows";
pub(crate) const OPACITY_TIP: &str = "Per opacity unit";
pub(crate) const NAME_HINT: &str = "unnamed";

/// Section name of the table in the command palette.
pub(crate) const TITLE: &str = "Labels";

/// Headings of the columns, with their tooltips.
pub(crate) const SHOW_COLUMN: ControlText = control_text("Show", VISIBLE_TIP);
pub(crate) const COLOR_COLUMN: ControlText = control_text("Colour", "Colour of the label");
pub(crate) const NUMBER_COLUMN: ControlText =
    control_text("Label", "Number stored in the voxels; a click shows only this label");
pub(crate) const NAME_COLUMN: ControlText = control_text("Name", "Name in the file, until you change it");
pub(crate) const VOXELS_COLUMN: ControlText = control_text("Voxels", "Number of voxels with this label");
pub(crate) const OPACITY_COLUMN: ControlText = control_text("Opacity", OPACITY_TIP);

pub(crate) const AUTOMATIC: ControlText =
    control_text("Automatic", "Restores the label table with which the volume was opened");
pub(crate) const USE_CURVE: ControlText = control_text(
    "Use a curve",
    "Shows label numbers as values, with a transfer function; Automatic restores the table",
);

/// Accessible names of the controls in a row.
pub(crate) fn visible(number: i64) -> String {
    format!("Show label {number}")
}

pub(crate) fn color(number: i64) -> String {
    format!("Colour of label {number}")
}

pub(crate) fn only_name(number: i64) -> String {
    format!("Only label {number}")
}

pub(crate) fn name(number: i64) -> String {
    format!("Name of label {number}")
}

pub(crate) fn opacity(number: i64) -> String {
    format!("Opacity of label {number}")
}

/// Number of labels listed, out of all.
pub(crate) fn count(listed: usize, all: usize) -> String {
    if listed == all { format!("{all} labels") } else { format!("{listed} of {all} labels") }
}

/// Number of voxels with a label, in groups of three digits.
pub(crate) fn voxels(count: u64) -> String {
    let digits = count.to_string();
    let mut grouped = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            // Narrow no-break space.
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    grouped
}

/// Tooltip of a label's number: name, number of voxels, and the label whose look it shares where there are more
/// labels than classes.
pub(crate) fn tooltip(name: &str, voxels: u64, shares_with: Option<i64>) -> String {
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    let shares = shares_with.map_or_else(String::new, |other| format!(", shown like label {other}"));
    format!("{name}{voxels} voxels{shares}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voxels_are_grouped_by_thousands() {
        let plain = |count| voxels(count).replace('\u{202f}', " ");
        assert_eq!([0, 999, 1000, 1_234_567].map(plain), ["0", "999", "1 000", "1 234 567"]);
    }
}
