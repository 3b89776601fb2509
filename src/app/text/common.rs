//! What many parts of the window say.

/// What is rarely needed, folded away.
pub(crate) const ADVANCED: &str = "Advanced";

/// Behind a factor.
pub(crate) const TIMES: &str = " ×";

/// Leaves what is being done or asked.
pub(crate) const CANCEL: &str = "Cancel";

/// Behind a length in millimetres.
pub(crate) const MM: &str = " mm";
/// Behind a length in voxels.
pub(crate) const VOX: &str = " vox";

/// Behind an angle.
pub(crate) const DEGREES: &str = "°";

/// What the button that puts a value back is called.
pub(crate) fn reset(label: &str) -> String {
    format!("Reset {label}")
}

/// The tip of a button that puts a value back.
pub(crate) fn reset_tip(label: &str) -> String {
    reset(&label.to_lowercase())
}
