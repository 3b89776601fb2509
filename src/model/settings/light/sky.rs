//! Light that comes from all around: a sky, attenuated by the material on its way.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::model::{Resolution, SceneAxis, linear_from_srgb};

/// What the sky looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SkyMode {
    /// There is none: a flat ambient term stands for it.
    Off,
    /// White from everywhere: what is known as ambient occlusion.
    White,
    /// Three colours: above, at the horizon and below.
    Gradient,
    /// What a picture of surroundings has, as far as it is linear in the direction.
    Picture,
}

/// Directions that the sky's light is taken from: fewer are patchy, more look no better.
pub const SKY_DIRECTIONS: std::ops::RangeInclusive<u32> = 6..=64;

/// How far in front of a surface openness to the sky is looked up, in blocks of its volume: what lies nearer is the
/// surface itself, which the blocks blur.
pub const SKY_AHEAD: f64 = 0.75;

/// Light from all around. What is stored of it is how open each place is ([`crate::plan::SkyKey`]), so that colours,
/// brightness and turn of the sky cost a picture and no more, unless its light bounces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Sky {
    /// What it looks like.
    pub mode: SkyMode,
    /// What of it an open surface gives back of its colour: 1 is white paper under a white sky.
    pub intensity: f64,
    /// Colour above, sRGB, 0 … 1.
    pub zenith: [f32; 3],
    /// Colour at the horizon, sRGB, 0 … 1.
    pub horizon: [f32; 3],
    /// Colour from below, sRGB, 0 … 1.
    pub ground: [f32; 3],
    /// What is kept of a picture of surroundings.
    pub picture: SkyPicture,
    /// How far the zenith leans from the vertical, in degrees: 90 is a wall of light, a large window.
    pub tilt_deg: f64,
    /// To which side it leans, about the vertical, counted as a camera's azimuth; surroundings turn with it.
    pub turn_deg: f64,
    /// Multiplies the extinction that its light meets.
    pub density_scale: f64,
    /// From how many directions light is followed.
    pub directions: u32,
    /// How finely.
    pub resolution: Resolution,
}

impl Default for Sky {
    fn default() -> Self {
        Self {
            mode: SkyMode::Off,
            intensity: 0.5,
            // A clear day, held back: the object has colours of its own.
            zenith: [0.80, 0.89, 1.0],
            horizon: [0.95, 0.96, 1.0],
            ground: [0.52, 0.47, 0.42],
            picture: SkyPicture::default(),
            tilt_deg: 0.0,
            turn_deg: 0.0,
            density_scale: 1.0,
            directions: 64,
            resolution: Resolution::Half,
        }
    }
}

/// What is kept of a picture of surroundings, so that no file is needed to draw it again. White until one has been read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SkyPicture {
    /// The name of the file.
    pub name: String,
    /// Mean radiance, linear RGB.
    pub mean: [f64; 3],
    /// Of red, green and blue light towards where it is brighter, in a space whose z axis points up and whose x axis to the
    /// middle of the picture: radiance is `mean` + `slope` · ω.
    pub slope: [[f64; 3]; 3],
}

impl Default for SkyPicture {
    fn default() -> Self {
        Self { name: String::new(), mean: [1.0; 3], slope: [[0.0; 3]; 3] }
    }
}

/// Most that a component of surroundings may be: of a mean luminance of 1 blue light alone has 14.
pub const MAX_PICTURE_RADIANCE: f64 = 100.0;

/// Radiance that is linear in the direction, for each colour: L(ω) = `mean` + `slope` · ω, in units in which an open
/// white surface under a sky of 1 is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyRadiance {
    /// Of all directions, linear RGB.
    pub mean: [f64; 3],
    /// For each colour, towards where it is brighter, in scene space.
    pub slope: [DVec3; 3],
}

impl Sky {
    /// Whether there is one.
    pub fn is_on(&self) -> bool {
        self.mode != SkyMode::Off
    }

    /// Towards the zenith, in a scene of which an axis points up.
    pub fn zenith_direction(&self, up: SceneAxis) -> DVec3 {
        self.scene_from_sky(up) * DVec3::Z
    }

    /// The sky, whose z axis points to its zenith, in a scene of which an axis points up: it leans towards its x axis, and
    /// then turns about the vertical.
    pub fn scene_from_sky(&self, up: SceneAxis) -> DMat3 {
        let (tilt, turn) = (self.tilt_deg.to_radians(), self.turn_deg.to_radians());
        up.scene_from_upright() * DMat3::from_rotation_z(turn) * DMat3::from_rotation_y(tilt)
    }

    /// The sky as far as it is linear in the direction; `None` where there is none.
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
                let SkyPicture { name: _, mean, slope } = &self.picture;
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
        let sky = Sky {
            mode: SkyMode::Gradient,
            intensity: 2.0,
            zenith: [1.0; 3],
            horizon: [0.5; 3],
            ground: [0.0; 3],
            ..Sky::default()
        };
        let radiance = sky.radiance(SceneAxis::PlusY).expect("a sky");
        let horizon = 2.0 * linear_from_srgb(0.5);
        assert!((radiance.mean[1] - (2.0 + 2.0 * horizon) / 4.0).abs() < 1e-12, "{radiance:?}");
        assert!((radiance.slope[2] - DVec3::Y).length() < 1e-12, "{radiance:?}");
        // By quadrature over heights.
        let at = |z: f64| if z > 0.0 { horizon + (2.0 - horizon) * z } else { horizon + horizon * z };
        let n = 10_000;
        let heights = (0..n).map(|i| (2.0 * (f64::from(i) + 0.5) / f64::from(n)) - 1.0);
        let (mean, moment) = heights.fold((0.0, 0.0), |(mean, moment), z| (mean + at(z), moment + at(z) * z));
        assert!((mean / f64::from(n) - radiance.mean[0]).abs() < 1e-6);
        assert!((3.0 * moment / f64::from(n) - radiance.slope[0].y).abs() < 1e-6);
    }

    #[test]
    fn the_zenith_leans_to_where_it_is_turned() {
        let sky = |tilt_deg, turn_deg| Sky { tilt_deg, turn_deg, ..Sky::default() };
        let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
        near(sky(0.0, 70.0).zenith_direction(SceneAxis::PlusZ), DVec3::Z);
        near(sky(90.0, 0.0).zenith_direction(SceneAxis::PlusZ), DVec3::X);
        near(sky(90.0, 90.0).zenith_direction(SceneAxis::PlusZ), DVec3::Y);
        near(sky(180.0, 0.0).zenith_direction(SceneAxis::MinusX), DVec3::X);
    }

    #[test]
    fn surroundings_turn_about_the_vertical() {
        let picture = SkyPicture { slope: [[1.0, 0.0, 0.5], [0.0; 3], [0.0; 3]], ..SkyPicture::default() };
        let sky = Sky { mode: SkyMode::Picture, intensity: 2.0, turn_deg: 90.0, picture, ..Sky::default() };
        let radiance = sky.radiance(SceneAxis::PlusZ).expect("a sky");
        assert_eq!(radiance.mean, [2.0; 3]);
        assert!((radiance.slope[0] - DVec3::new(0.0, 2.0, 1.0)).length() < 1e-12, "{radiance:?}");
        let leaning = Sky { tilt_deg: 90.0, turn_deg: 0.0, ..sky };
        let slope = leaning.radiance(SceneAxis::PlusZ).expect("a sky").slope[0];
        assert!((slope - DVec3::new(1.0, 0.0, -2.0)).length() < 1e-12, "{slope}");
    }
}
