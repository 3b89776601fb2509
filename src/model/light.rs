//! Lights, in scene space.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// As many lights as a picture can have; each has its own attenuation volume.
pub const MAX_LIGHTS: usize = 8;

/// How a light's rays run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LightKind {
    /// From infinitely far away, along the line from `position` to the middle of the volume.
    Parallel,
    /// From the point `position`, in all directions.
    Perspective,
}

/// One light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Light {
    /// What the user calls it.
    pub name: String,
    /// Parallel or perspective.
    pub kind: LightKind,
    /// In scene units. A parallel light uses only its direction as seen from the origin, so that
    /// switching the kind back and forth loses nothing.
    pub position: [f64; 3],
    /// sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Multiplies the colour in linear light.
    pub intensity: f64,
    /// Whether it shines.
    pub on: bool,
    /// Whether what it meets attenuates it; a fill light does without.
    pub casts_shadows: bool,
}

impl Default for Light {
    fn default() -> Self {
        Self {
            name: "Light".to_owned(),
            kind: LightKind::Parallel,
            position: [2.0, -2.0, 2.5],
            color: [1.0; 3],
            intensity: 1.0,
            on: true,
            casts_shadows: true,
        }
    }
}

impl Light {
    /// Unit vector from the origin towards a parallel light.
    pub fn direction(&self) -> DVec3 {
        DVec3::from(self.position).normalize_or(DVec3::Z)
    }

    /// Whether this light needs an attenuation volume now.
    pub fn needs_volume(&self) -> bool {
        self.on && self.casts_shadows && self.intensity > 0.0
    }
}
