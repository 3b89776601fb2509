//! The picture, and two looks in it.

/// What screen readers call the picture.
pub(crate) const PICTURE: &str = "Picture";
/// What screen readers call the line between two looks.
pub(crate) const DIVIDER: &str = "Divider";

/// What is shown where two looks are subtracted.
pub(crate) fn difference(left: &str, right: &str) -> String {
    format!("{left} − {right}, eight times")
}

/// How far two looks are apart.
pub(crate) fn distance(rmse: f64, largest: f64) -> String {
    format!("RMSE {rmse:.2} of 255, largest {largest}")
}
