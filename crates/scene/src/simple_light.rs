//! Simplified light: the first step of a picture on slow adapters, without soft shadows and bounced light.

use crate::{LightShape, Settings};

/// Parts of the light that are left out of a quick picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LightSimplification {
    /// Lights with a size become points, with a sixteenth of the light volumes or less.
    pub without_sizes: bool,
    /// Nothing hides the sky.
    pub with_open_sky: bool,
    /// No light bounces.
    pub without_bounces: bool,
}

impl LightSimplification {
    /// Leaves nothing out.
    pub const NONE: Self = Self { without_sizes: false, with_open_sky: false, without_bounces: false };

    /// Leaves out everything that takes longer than point lights.
    pub const ALL: Self = Self { without_sizes: true, with_open_sky: true, without_bounces: true };

    /// Returns the look with simplified light. On open surfaces it is as bright as the look itself; the sky then
    /// darkens hollows, and bounces brighten them.
    #[must_use]
    pub fn apply(self, look: &Settings) -> Settings {
        let mut simple = look.clone();
        if self.without_sizes {
            simple.lights.iter_mut().for_each(|light| light.shape = LightShape::Point);
        }
        if self.with_open_sky {
            simple.sky.density_scale = 0.0;
        }
        if self.without_bounces {
            simple.scattering.bounces = 0;
        }
        simple
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, LightSettings, SkyMode};

    #[test]
    fn each_part_is_left_out_alone() {
        let disc = LightSettings { shape: LightShape::Disc, ..LightSettings::default() };
        let mut soft = Settings { lights: vec![disc], ..Settings::default() };
        soft.sky.mode = SkyMode::White;
        soft.scattering.bounces = 3;
        let seen = |parts: LightSimplification| {
            let simple = parts.apply(&soft);
            assert!(simple.sky.is_on());
            let has_size = simple.lights[0].resolve(&Camera::default()).area.is_some();
            [has_size, simple.has_sky_volume(), simple.has_bounces()]
        };
        let none = LightSimplification::NONE;
        assert_eq!(none.apply(&soft), soft);
        assert_eq!(seen(none), [true; 3]);
        assert_eq!(seen(LightSimplification { without_sizes: true, ..none }), [false, true, true]);
        assert_eq!(seen(LightSimplification { with_open_sky: true, ..none }), [true, false, true]);
        assert_eq!(seen(LightSimplification { without_bounces: true, ..none }), [true, true, false]);
        assert_eq!(seen(LightSimplification::ALL), [false; 3]);
    }
}
