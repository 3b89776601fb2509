//! Texts of the picture and of the comparison in it.

use crate::app::text::{ControlText, control_text};

/// Accessible name of the picture.
pub(crate) const PICTURE: &str = "Picture";
/// Accessible name of the divider between two looks.
pub(crate) const DIVIDER: &str = "Divider";

/// Message over a picture in which nothing is visible.
pub(crate) const NOTHING_VISIBLE: &str =
    "No part of the volume is visible: it is transparent, cut away, too small, or outside the picture";
pub(crate) const SHOW_SOMETHING: ControlText = control_text(
    "Show something",
    "Sets the robust range, and a transfer function for eye and light that shows the twentieth of the voxels with the \
     highest values",
);
pub(crate) const RESET_TRANSFER: ControlText = control_text(
    "Reset transfer function",
    "Restores the transfer function with which the volume was opened",
);

/// Caption of the row of common CT presets.
pub(crate) const CT_LOOKS: &str = "CT:";
pub(crate) const CLOSE_CT_LOOKS: &str = "Close this row; presets stay in the editor";
pub(crate) const CLOSE_CT_LOOKS_SIGN: &str = "×";

/// Button of the row that hides the table under the body.
pub(crate) const HIDE_TABLE: ControlText = control_text(
    "Without table",
    "Hides the table under the body, with its shadow; a second click shows it again",
);

/// Caption of the difference image of two looks.
pub(crate) fn difference(left: &str, right: &str) -> String {
    format!("{left} − {right}, × 8")
}

/// Error metrics between two looks, on a scale of 255.
pub(crate) fn error_metrics(rmse: f64, largest: f64) -> String {
    format!("RMSE {rmse:.2} of 255, largest {largest}")
}
