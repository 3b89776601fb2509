//! Texts of the window that shows slices of a light volume.

use crate::app::text::{ControlText, control_text};

pub(crate) const TITLE: &str = "Light volume";

/// Slice orientations, indexed by axis.
pub(crate) const SLICE_ORIENTATIONS: [&str; 3] = ["Across x", "Across y", "Across z"];
pub(crate) const SLICE: &str = "Slice";

/// Text in place of a light volume that is being filled, and over one that is out of date.
pub(crate) const FILLING: &str = "filling…";
pub(crate) const NO_LIGHT_VOLUME: &str =
    "No light volume: it needs shadows by splatting or per voxel, and a light that casts them";

/// Labels of the ends of the colour scale.
pub(crate) const DARK: &str = "dark";
pub(crate) const FULLY_LIT: &str = "fully lit";

pub(crate) const EXPORT: ControlText =
    control_text("Export…", "The whole volume as .nrrd, or this slice as .png");

/// Errors of an export with nothing to write.
pub(crate) const NOTHING_TO_EXPORT: &str = "there is no light volume";
pub(crate) const NO_SUCH_SLICE: &str = "there is no such slice";
