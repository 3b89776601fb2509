//! Sky light: ambient light from all directions, attenuated by the material.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::{LightVolumeResolution, SceneAxis, linear_from_srgb};

/// Radiance model of the sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SkyMode {
    /// No sky: a flat ambient term replaces it.
    Off,
    /// White from all directions: known as ambient occlusion.
    White,
    /// Gradient of three colours: above, at the horizon and below.
    Gradient,
    /// Environment map, approximated linearly in the direction.
    Picture,
}

/// Numbers of directions that settings may ask for; [`sky_direction_set`](crate::sky_direction_set) returns the one that serves each.
pub const SKY_DIRECTIONS: std::ops::RangeInclusive<u32> = 6..=96;

/// Distance in front of a surface at which sky visibility is looked up, in blocks of its volume: nearer material is
/// the surface itself, which the blocks blur.
pub const SKY_LOOKUP_DISTANCE: f64 = 0.75;

/// Ambient light from all directions.
///
/// Only sky visibility is cached (`SkyKey` of the renderer), so that changing
/// colours, brightness and rotation of the sky costs one image and no more, unless its light bounces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SkySettings {
    /// Radiance model of the sky.
    pub mode: SkyMode,
    /// Intensity as the fraction of its colour that an unoccluded surface reflects: 1 is white paper under a white
    /// sky.
    pub intensity: f64,
    /// Colour above, sRGB, 0 … 1.
    pub zenith: [f32; 3],
    /// Colour at the horizon, sRGB, 0 … 1.
    pub horizon: [f32; 3],
    /// Colour from below, sRGB, 0 … 1.
    pub ground: [f32; 3],
    /// Linear approximation of an environment map.
    pub picture: EnvironmentLight,
    /// Tilt of the zenith from the vertical, in degrees: 90 is a wall of light, a large window.
    pub tilt_deg: f64,
    /// Direction of the tilt about the vertical, in degrees, counted as a camera's azimuth; environment maps turn
    /// with it.
    pub turn_deg: f64,
    /// Factor for the extinction of material for sky light.
    pub density_scale: f64,
    /// Number of directions for sky visibility; [`sky_direction_set`](crate::sky_direction_set) returns the number that serves it.
    pub directions: u32,
    /// Resolution of the sky visibility volume.
    pub resolution: LightVolumeResolution,
}

impl Default for SkySettings {
    fn default() -> Self {
        Self {
            mode: SkyMode::Off,
            intensity: 0.5,
            // A clear day with muted colours, because the object has colours of its own.
            zenith: [0.80, 0.89, 1.0],
            horizon: [0.95, 0.96, 1.0],
            ground: [0.52, 0.47, 0.42],
            picture: EnvironmentLight::default(),
            tilt_deg: 0.0,
            turn_deg: 0.0,
            density_scale: 1.0,
            directions: 96,
            resolution: LightVolumeResolution::Half,
        }
    }
}

/// Linear approximation of an environment map, which suffices to render again without the file. White until one has
/// been read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EnvironmentLight {
    /// Name of the environment map's file.
    pub name: String,
    /// Mean radiance, linear RGB.
    pub mean: [f64; 3],
    /// Gradients of red, green and blue radiance over directions, in a space whose z axis points up and whose x axis
    /// points to the middle of the map: radiance is `mean` + `slope` · ω.
    pub slope: [[f64; 3]; 3],
}

impl Default for EnvironmentLight {
    fn default() -> Self {
        Self { name: String::new(), mean: [1.0; 3], slope: [[0.0; 3]; 3] }
    }
}

/// Largest component of an environment map's radiance: with a mean luminance of 1, pure blue light has 14.
pub const MAX_ENVIRONMENT_RADIANCE: f64 = 100.0;

/// Radiance that is linear in the direction, for each colour: L(ω) = `mean` + `slope` · ω, in units in which an
/// unoccluded white surface under a sky of 1 is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyRadiance {
    /// Mean over all directions, linear RGB.
    pub mean: [f64; 3],
    /// Gradient of each colour over directions, in scene space.
    pub slope: [DVec3; 3],
}

impl SkySettings {
    /// Returns true if there is a sky.
    pub fn is_on(&self) -> bool {
        self.mode != SkyMode::Off
    }

    /// Returns the direction of the zenith in scene space, for a given up axis.
    pub fn zenith_direction(&self, up: SceneAxis) -> DVec3 {
        self.scene_from_sky(up) * DVec3::Z
    }

    /// Returns the rotation from sky space, whose z axis points to the zenith, to scene space, for a given up axis: a
    /// tilt towards the sky's x axis, then a turn about the vertical.
    pub fn scene_from_sky(&self, up: SceneAxis) -> DMat3 {
        let (tilt, turn) = (self.tilt_deg.to_radians(), self.turn_deg.to_radians());
        up.scene_from_upright() * DMat3::from_rotation_z(turn) * DMat3::from_rotation_y(tilt)
    }

    /// Returns the linear approximation of the sky's radiance; `None` without a sky.
    ///
    /// Colours that change evenly with the height z = −1 … 1 from ground to horizon and from there to the zenith have
    /// the mean (zenith + 2 horizon + ground) / 4, and of all functions linear in z the nearest has the slope
    /// 3 · ⟨L z⟩ = (zenith − ground) / 2.
    pub fn radiance(&self, up: SceneAxis) -> Option<SkyRadiance> {
        let linear = |color: [f32; 3]| color.map(|c| self.intensity * linear_from_srgb(f64::from(c)));
        let towards = self.zenith_direction(up);
        match self.mode {
            SkyMode::Off => None,
            SkyMode::White => Some(SkyRadiance { mean: [self.intensity; 3], slope: [DVec3::ZERO; 3] }),
            SkyMode::Gradient => {
                let [zenith, horizon, ground] = [self.zenith, self.horizon, self.ground].map(linear);
                Some(SkyRadiance {
                    mean: std::array::from_fn(|c| (zenith[c] + 2.0 * horizon[c] + ground[c]) / 4.0),
                    slope: std::array::from_fn(|c| towards * ((zenith[c] - ground[c]) / 2.0)),
                })
            }
            SkyMode::Picture => {
                let EnvironmentLight { name: _, mean, slope } = &self.picture;
                let scene_from_sky = self.scene_from_sky(up) * self.intensity;
                Some(SkyRadiance {
                    mean: mean.map(|c| c * self.intensity),
                    slope: slope.map(|slope| scene_from_sky * DVec3::from(slope)),
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_is_as_bright_as_its_colours_on_the_mean() {
        let sky = SkySettings {
            mode: SkyMode::Gradient,
            intensity: 2.0,
            zenith: [1.0; 3],
            horizon: [0.5; 3],
            ground: [0.0; 3],
            ..SkySettings::default()
        };
        let radiance = sky.radiance(SceneAxis::PlusY).expect("a sky");
        let horizon = 2.0 * linear_from_srgb(0.5);
        assert!((radiance.mean[1] - (2.0 + 2.0 * horizon) / 4.0).abs() < 1e-12, "{radiance:?}");
        assert!((radiance.slope[2] - DVec3::Y).length() < 1e-12, "{radiance:?}");
        // Numerical quadrature over heights.
        let at = |z: f64| if z > 0.0 { horizon + (2.0 - horizon) * z } else { horizon + horizon * z };
        let n = 10_000;
        let heights = (0..n).map(|i| (2.0 * (f64::from(i) + 0.5) / f64::from(n)) - 1.0);
        let (mean, moment) = heights.fold((0.0, 0.0), |(mean, moment), z| (mean + at(z), moment + at(z) * z));
        assert!((mean / f64::from(n) - radiance.mean[0]).abs() < 1e-6);
        assert!((3.0 * moment / f64::from(n) - radiance.slope[0].y).abs() < 1e-6);
    }

    #[test]
    fn the_zenith_leans_to_where_it_is_turned() {
        let sky = |tilt_deg, turn_deg| SkySettings { tilt_deg, turn_deg, ..SkySettings::default() };
        let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
        near(sky(0.0, 70.0).zenith_direction(SceneAxis::PlusZ), DVec3::Z);
        near(sky(90.0, 0.0).zenith_direction(SceneAxis::PlusZ), DVec3::X);
        near(sky(90.0, 90.0).zenith_direction(SceneAxis::PlusZ), DVec3::Y);
        near(sky(180.0, 0.0).zenith_direction(SceneAxis::MinusX), DVec3::X);
    }

    #[test]
    fn surroundings_turn_about_the_vertical() {
        let picture =
            EnvironmentLight { slope: [[1.0, 0.0, 0.5], [0.0; 3], [0.0; 3]], ..EnvironmentLight::default() };
        let sky = SkySettings {
            mode: SkyMode::Picture,
            intensity: 2.0,
            turn_deg: 90.0,
            picture,
            ..SkySettings::default()
        };
        let radiance = sky.radiance(SceneAxis::PlusZ).expect("a sky");
        assert_eq!(radiance.mean, [2.0; 3]);
        assert!((radiance.slope[0] - DVec3::new(0.0, 2.0, 1.0)).length() < 1e-12, "{radiance:?}");
        let leaning = SkySettings { tilt_deg: 90.0, turn_deg: 0.0, ..sky };
        let slope = leaning.radiance(SceneAxis::PlusZ).expect("a sky").slope[0];
        assert!((slope - DVec3::new(1.0, 0.0, -2.0)).length() < 1e-12, "{slope}");
    }
}
