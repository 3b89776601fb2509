//! The titles of the side panel's sections.

pub(crate) const LIGHTS: &str = "Lights";
pub(crate) const SHADOWS: &str = "Shadows";
pub(crate) const SOFT_LIGHT: &str = "Sky and scattering";
pub(crate) const SHADING: &str = "Shading";
pub(crate) const CUTS: &str = "Clipping";
pub(crate) const FLOOR: &str = "Floor";
pub(crate) const CAMERA: &str = "Camera";
pub(crate) const COMPARE: &str = "Compare";
pub(crate) const DATA: &str = "Data";

/// All of them, in the order in which they are shown.
pub(crate) const ALL: [&str; 9] = [LIGHTS, SHADOWS, SOFT_LIGHT, SHADING, CUTS, FLOOR, CAMERA, COMPARE, DATA];

/// What leads to a section.
pub(crate) fn go_to(title: &str) -> String {
    format!("Go to {title}")
}

/// What the dot beside a title says.
pub(crate) fn active(title: &str) -> String {
    format!("{title}: something is on")
}
