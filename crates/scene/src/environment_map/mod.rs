//! Environment maps: light from all directions, from pictures in equirectangular projection. They are reduced to a
//! linear function of the direction, which lights as a sky, and the brightest light.

mod brightest_light;
mod panorama;

use glam::DVec3;

pub use panorama::Panorama;

use chiaroscuro_volume::math::luminance;

/// Environment light, in a space whose z axis points up and whose x axis points to the middle of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentMap {
    /// File name of the picture.
    pub name: String,
    /// Mean radiance without the brightest light, linear RGB, scaled so that its luminance is 1.
    pub mean: [f64; 3],
    /// Gradient of radiance for each colour channel, in the scale of `mean`: radiance is about `mean` + `slope` · ω.
    pub slope: [DVec3; 3],
    /// Luminance of the mean radiance, normalised so that a white surface which faces both the brightest part of the
    /// linear function and the light reflects a total luminance of 1.
    pub brightness: f64,
    /// Brightest light, if one stands out.
    pub light: Option<BrightLight>,
}

/// Light source extracted from an environment map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrightLight {
    /// Unit vector towards the light.
    pub direction: DVec3,
    /// Linear RGB colour, whose largest component is 1.
    pub color: [f64; 3],
    /// Radiance that a white surface facing the light reflects of it, in the same normalisation as
    /// [`EnvironmentMap::brightness`].
    pub intensity: f64,
    /// Angular diameter of a disc with the same solid angle, in degrees.
    pub angle_deg: f64,
}

impl EnvironmentMap {
    /// Reduces a panorama to environment light; `None` if it is black.
    pub fn from_panorama(name: String, mut panorama: Panorama) -> Option<Self> {
        let light = brightest_light::extract_brightest_light(&mut panorama);
        let LinearRadiance { mean, slope } = linear_part(&panorama);
        let light_luminance = light.map_or(0.0, |light| light.intensity * luminance(light.color));
        // Reflection of a surface that faces the maximum of the radiance a + b·ω: ∫ (a + b·ω) cos dω / π = a + ⅔ b.
        let slope_of = |axis: usize| luminance(slope.map(|slope| slope[axis]));
        let steepest = DVec3::new(slope_of(0), slope_of(1), slope_of(2)).length();
        let all = luminance(mean) + 2.0 / 3.0 * steepest + light_luminance;
        let of_mean = luminance(mean).max(1e-6 * all);
        (all > 0.0).then(|| Self {
            name,
            mean: mean.map(|c| c / of_mean),
            slope: slope.map(|slope| slope / of_mean),
            brightness: of_mean / all,
            light: light.map(|light| BrightLight { intensity: light.intensity / all, ..light }),
        })
    }
}

/// Radiance of each colour as a linear function of the direction.
struct LinearRadiance {
    mean: [f64; 3],
    slope: [DVec3; 3],
}

/// Returns the mean radiance and the slope of the linear function of the direction closest to it in the least-squares
/// sense, 3 ⟨L ω⟩, limited so that irradiance is nowhere negative (a + ⅔ b·n ≥ 0).
fn linear_part(panorama: &Panorama) -> LinearRadiance {
    let (mut mean, mut slope) = ([0.0; 3], [DVec3::ZERO; 3]);
    for cell in panorama.cells() {
        let share = cell.solid_angle / (4.0 * std::f64::consts::PI);
        for c in 0..3 {
            mean[c] += cell.radiance[c] * share;
            slope[c] += cell.towards * (3.0 * cell.radiance[c] * share);
        }
    }
    for c in 0..3 {
        slope[c] = slope[c].clamp_length_max(1.5 * mean[c]);
    }
    LinearRadiance { mean, slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map_of(radiance: impl Fn(DVec3) -> [f64; 3]) -> EnvironmentMap {
        EnvironmentMap::from_panorama("t".to_owned(), Panorama::from_fn([512, 256], radiance))
            .expect("not black")
    }

    #[test]
    fn linear_radiance_is_preserved() {
        let towards = DVec3::new(0.6, 0.0, 0.8);
        let found = map_of(|at| [2.0 + towards.dot(at), 2.0, 2.0 - 0.5 * at.y]);
        assert_eq!(found.light, None, "nothing stands out");
        let scale = found.mean[1] / 2.0;
        assert!((luminance(found.mean) - 1.0).abs() < 1e-9);
        assert!((found.mean[0] / scale - 2.0).abs() < 1e-3, "{found:?}");
        assert!((found.slope[0] / scale - towards).length() < 1e-3, "{found:?}");
        assert!(found.slope[1].length() < 1e-6 * scale.max(1.0));
        assert!((found.slope[2] / scale + DVec3::Y * 0.5).length() < 1e-3);
    }

    #[test]
    fn the_brightest_light_is_measured() {
        let towards = DVec3::new(-0.48, 0.6, 0.64);
        for angle_deg in [2.0f64, 12.0, 40.0] {
            let edge = (0.5 * angle_deg).to_radians().cos();
            // The light gives 1.5 times as much as the sky to a surface that faces it.
            let solid = 2.0 * std::f64::consts::PI * (1.0 - edge);
            let radiance = 1.5 * std::f64::consts::PI / solid;
            let found = map_of(|at| {
                let extra = if at.dot(towards) > edge { radiance } else { 0.0 };
                [1.0 + extra, 1.0 + 0.8 * extra, 1.0 + 0.5 * extra]
            });
            let light = found.light.expect("it stands out");
            assert!(light.direction.dot(towards) > 0.5f64.to_radians().cos(), "{angle_deg}: {light:?}");
            assert!((light.angle_deg / angle_deg - 1.0).abs() < 0.1, "{angle_deg}: {light:?}");
            let ratio = light.intensity / found.brightness;
            assert!((ratio / 1.5 - 1.0).abs() < 0.05, "{angle_deg}: {ratio}");
            for (found, expected) in light.color.iter().zip([1.0, 0.8, 0.5]) {
                assert!((found - expected).abs() < 0.02, "{angle_deg}: {light:?}");
            }
            // The remainder is the uniform sky.
            assert!(found.slope.iter().all(|slope| slope.length() < 0.03), "{angle_deg}: {found:?}");
            // Sum of both on a surface that faces the light.
            let all = found.brightness + light.intensity * luminance(light.color);
            assert!((all - 1.0).abs() < 0.03, "{angle_deg}: {all}");
        }
    }

    #[test]
    fn irradiance_is_never_negative() {
        let found = map_of(|at| if at.x > 0.7 { [1.0; 3] } else { [0.0; 3] });
        for c in 0..3 {
            assert!(2.0 / 3.0 * found.slope[c].length() <= found.mean[c] * (1.0 + 1e-9), "{found:?}");
        }
        assert!(
            EnvironmentMap::from_panorama(String::new(), Panorama::from_fn([64, 32], |_| [0.0; 3])).is_none()
        );
    }
}
