//! Titles of the sections of the side panel.

pub(crate) const LIGHTS: &str = "Lights";
pub(crate) const SHADOWS: &str = "Shadows";
pub(crate) const SOFT_LIGHT: &str = "Sky and scattering";
pub(crate) const SHADING: &str = "Shading";
pub(crate) const CUTS: &str = "Clipping";
pub(crate) const FLOOR: &str = "Floor";
pub(crate) const CAMERA: &str = "Camera";
pub(crate) const COMPARE: &str = "Compare";
pub(crate) const DATA: &str = "Data";

/// Titles of all sections, in the order shown.
pub(crate) const ALL: [&str; 9] = [LIGHTS, SHADOWS, SOFT_LIGHT, SHADING, CUTS, FLOOR, CAMERA, COMPARE, DATA];

/// Accessible name of the button that jumps to a section.
pub(crate) fn tab_name(title: &str) -> String {
    format!("Go to {title}")
}

/// Accessible name of the dot beside a title, shown while the section has an effect.
pub(crate) fn active_name(title: &str) -> String {
    format!("{title}: active")
}
