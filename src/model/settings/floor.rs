//! A floor under the volume that shows its shadows.

use serde::{Deserialize, Serialize};

/// The floor is never further below or above the middle of the volume than this, in scene units.
pub const MAX_FLOOR_HEIGHT: f64 = 4.0;

/// The largest floor, in scene units: far beyond every picture's border.
pub const MAX_FLOOR_RADIUS: f64 = 100.0;

/// A horizontal disc that takes the shadows of the volume. It is seen from above, behind the volume, and fades
/// out towards its border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Floor {
    /// Whether it is there.
    pub on: bool,
    /// Where it lies: from the middle of the scene upwards, which is along the camera's [`crate::model::Camera::up`].
    pub height: f64,
    /// Distance from the middle at which nothing is left of it, in scene units.
    pub radius: f64,
    /// Colour of the floor, sRGB, 0 … 1.
    pub color: [f32; 3],
    /// How much of the background it covers in its middle, 0 … 1.
    pub opacity: f64,
    /// It is seen only where it is in shadow, as a darkening: for any background, and for transparent pictures.
    pub shadow_only: bool,
}

impl Default for Floor {
    fn default() -> Self {
        // A mid grey is darker than what lies on it in light, and lighter than its shadows.
        Self { on: false, height: -1.0, radius: 4.0, color: [0.6; 3], opacity: 1.0, shadow_only: false }
    }
}

impl Floor {
    /// Share of the radius up to which it is whole.
    pub const WHOLE: f64 = 0.3;

    /// How much of it there is at a distance from its middle: all up to [`Self::WHOLE`] of the radius, nothing
    /// from the radius on, 3t² − 2t³ between.
    pub fn presence(&self, distance: f64) -> f64 {
        let t = ((self.radius - distance) / (self.radius * (1.0 - Self::WHOLE))).clamp(0.0, 1.0);
        self.opacity * t * t * (3.0 - 2.0 * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_fades_out() {
        let floor = Floor { radius: 2.0, opacity: 0.8, ..Floor::default() };
        assert_eq!([0.0, 0.6, 2.0, 9.0].map(|distance| floor.presence(distance)), [0.8, 0.8, 0.0, 0.0]);
        assert!((floor.presence(1.3) - 0.4).abs() < 1e-12);
    }
}
