//! The picture, and two looks in it.

use crate::app::text::{Named, named};

/// What screen readers call the picture.
pub(crate) const PICTURE: &str = "Picture";
/// What screen readers call the line between two looks.
pub(crate) const DIVIDER: &str = "Divider";

/// Over a picture in which nothing is seen.
pub(crate) const NOTHING_SEEN: &str =
    "Nothing of the volume is visible: it is transparent, too small, or outside of the picture";
pub(crate) const SHOW_SOMETHING: Named = named(
    "Show something",
    "Takes a transfer function that shows the twentieth of the voxels with the highest values, the robust range, and \
     light that follows the eye's curve",
);
pub(crate) const RESET_TRANSFER: Named =
    named("Reset transfer function", "Takes back the transfer function with which the volume was opened");

/// Before what is mostly looked for in a CT.
pub(crate) const CT_LOOKS: &str = "CT:";
pub(crate) const CLOSE_CT_LOOKS: &str = "Close this row; presets stay in the editor";
pub(crate) const CLOSE_CT_LOOKS_SIGN: &str = "×";

/// What is shown where two looks are subtracted.
pub(crate) fn difference(left: &str, right: &str) -> String {
    format!("{left} − {right}, eight times")
}

/// How far two looks are apart.
pub(crate) fn distance(rmse: f64, largest: f64) -> String {
    format!("RMSE {rmse:.2} of 255, largest {largest}")
}
