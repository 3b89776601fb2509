//! The titles of the side panel's sections.

pub(crate) const LABELS: &str = "Labels";
pub(crate) const LIGHTS: &str = "Lights";
pub(crate) const SHADOWS: &str = "Shadows";
pub(crate) const SOFT_LIGHT: &str = "Sky and scattering";
pub(crate) const SHADING: &str = "Shading";
pub(crate) const CUTS: &str = "Cut";
pub(crate) const FLOOR: &str = "Floor";
pub(crate) const CAMERA: &str = "Camera";
pub(crate) const COMPARE: &str = "Compare";
pub(crate) const DATA: &str = "Data";
