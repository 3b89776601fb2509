//! Floor plane under the volume that receives its shadows.

use serde::{Deserialize, Serialize};

/// Largest distance of the floor below or above the centre of the volume, in scene units.
pub const MAX_FLOOR_HEIGHT: f64 = 4.0;

/// Largest radius of the floor, in scene units: far beyond the border of every image.
pub const MAX_FLOOR_RADIUS: f64 = 100.0;

/// Horizontal disc that receives the shadows of the volume. It is visible from above, behind the volume, and fades
/// out towards its border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FloorSettings {
    /// Enables the floor.
    pub on: bool,
    /// Height above the centre of the scene, in scene units, along the camera's [`crate::Camera::up`].
    pub height: f64,
    /// Distance from the centre at which the floor has faded out, in scene units.
    pub radius: f64,
    /// Colour of the floor, sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Opacity in the centre of the floor, 0 … 1.
    pub opacity: f64,
    /// Shows only shadows, as a darkening: for any background, and for transparent images.
    pub shadow_only: bool,
}

impl Default for FloorSettings {
    fn default() -> Self {
        // A mid grey is darker than the object in light, and lighter than its shadows.
        Self { on: false, height: -1.0, radius: 4.0, color: [0.6; 3], opacity: 1.0, shadow_only: false }
    }
}

impl FloorSettings {
    /// Fraction of the radius up to which the floor has its full opacity.
    pub const OPAQUE_SHARE: f64 = 0.3;

    /// Returns the floor's opacity at a distance from its centre: full up to [`Self::OPAQUE_SHARE`] of the radius, 0
    /// from the radius on, 3t² − 2t³ between.
    pub fn opacity_at(&self, distance: f64) -> f64 {
        let t = ((self.radius - distance) / (self.radius * (1.0 - Self::OPAQUE_SHARE))).clamp(0.0, 1.0);
        self.opacity * t * t * (3.0 - 2.0 * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_fades_out() {
        let floor = FloorSettings { radius: 2.0, opacity: 0.8, ..FloorSettings::default() };
        assert_eq!([0.0, 0.6, 2.0, 9.0].map(|distance| floor.opacity_at(distance)), [0.8, 0.8, 0.0, 0.0]);
        assert!((floor.opacity_at(1.3) - 0.4).abs() < 1e-12);
    }
}
