//! Detection of scenes in which all light has a single colour.

use glam::DVec3;

use super::lit_lights::ActiveLights;
use chiaroscuro_scene::{Settings, VolumeLayer, linear_from_srgb};

/// Colour of all light of a scene, if it is the same everywhere and the material is grey: bounces are then simulated
/// with one number each, and multiplied by the colour at the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformLightColor {
    /// Linear RGB colour; its largest component is 1.
    pub color: DVec3,
    /// Index of the largest component.
    pub channel: usize,
}

/// Tolerance for equal colours, as a share of the largest component: rounding of `f32`.
const COLOR_TOLERANCE: f64 = 1e-6;

impl UniformLightColor {
    /// Finds the single colour of all light in a look; `None` if there are several, or the material has colours.
    pub fn detect(settings: &Settings) -> Option<Self> {
        let is_grey = |color: [f32; 3]| color[0] == color[1] && color[1] == color[2];
        let layer_is_grey = |layer: &VolumeLayer| {
            if layer.blend.channel().is_some() {
                return false;
            }
            if layer.labels.is_empty() {
                layer.transfer.points.iter().all(|point| is_grey(point.color))
            } else {
                layer.labels.materials().iter().all(|material| is_grey(material.color))
            }
        };
        if !settings.layers.iter().all(layer_is_grey) {
            return None;
        }
        let lights = ActiveLights::from_settings(settings);
        let linear = |color: [f32; 3]| DVec3::from(color.map(|c| linear_from_srgb(f64::from(c))));
        let mut found: Vec<DVec3> = lights.all().iter().map(|lit| linear(lit.light.color)).collect();
        if let Some(sky) = settings.sky.radiance(settings.camera.up) {
            // The slopes of a gradient count as well; only their colour matters, not the sign.
            let along = |axis: usize| DVec3::from(sky.slope.map(|slope| slope[axis]));
            found.push(sky.mean.into());
            found.extend([0, 1, 2].map(along));
        }
        if settings.shading.emission > 0.0 {
            found.push(DVec3::ONE);
        }
        let brightest = found.iter().copied().max_by(|a, b| largest(*a).total_cmp(&largest(*b)));
        let brightest = brightest.filter(|color| largest(*color) > 0.0).unwrap_or(DVec3::ONE);
        let channel = (0..3).max_by(|a, b| brightest[*a].abs().total_cmp(&brightest[*b].abs()))?;
        let color = brightest / brightest[channel];
        let is_of_it =
            |light: &DVec3| largest(*light - color * light[channel]) <= COLOR_TOLERANCE * largest(*light);
        found.iter().all(is_of_it).then_some(Self { color, channel })
    }

    /// Returns the amount of this colour in a light.
    pub fn amount(self, light: DVec3) -> f64 {
        light[self.channel]
    }
}

fn largest(color: DVec3) -> f64 {
    color.abs().max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{ControlPoint, LightSettings, SkyMode};

    fn grey() -> Settings {
        let mut settings = Settings::default();
        settings.layer_mut().transfer.points =
            [0.0, 1.0].map(|value| ControlPoint::new(value, [0.7; 3], value)).to_vec();
        settings.lights = vec![LightSettings { color: [1.0, 0.5, 0.25], ..LightSettings::default() }; 2];
        settings.lights[1].intensity = 0.3;
        settings
    }

    #[test]
    fn lights_of_one_color_are_one_and_their_amounts_add_up_to_them() {
        let one = UniformLightColor::detect(&grey()).expect("everything is of one colour");
        let linear = DVec3::from([1.0, 0.5, 0.25].map(linear_from_srgb));
        assert!((one.color - linear).length() < 1e-9, "{one:?}");
        assert_eq!(one.channel, 0);
        assert!((one.amount(linear * 0.3) - 0.3).abs() < 1e-9);
    }

    #[test]
    fn one_thing_of_another_color_makes_them_several() {
        let with = |change: &dyn Fn(&mut Settings)| {
            let mut settings = grey();
            change(&mut settings);
            UniformLightColor::detect(&settings)
        };
        assert!(with(&|_| ()).is_some());
        assert!(with(&|settings| settings.layer_mut().transfer.points[0].color[1] += 0.01).is_none());
        assert!(with(&|settings| settings.lights[1].color[2] += 0.01).is_none());
        assert!(with(&|settings| settings.sky.mode = SkyMode::White).is_none());
        assert!(with(&|settings| settings.shading.emission = 0.5).is_none());
        // A light that is off has no effect.
        let off = with(&|settings| {
            settings.lights[1].color = [0.0, 1.0, 0.0];
            settings.lights[1].on = false;
        });
        assert!(off.is_some());
        let white = |settings: &mut Settings| {
            for light in &mut settings.lights {
                light.color = [0.9; 3];
            }
            settings.sky.mode = SkyMode::White;
            settings.shading.emission = 0.5;
        };
        assert!(with(&white).is_some_and(|one| (one.color - DVec3::ONE).length() < 1e-6));
        // A gradient from white to black has a slope of the same colour, with the opposite sign.
        let gradient = |settings: &mut Settings| {
            white(settings);
            settings.sky.mode = SkyMode::Gradient;
            (settings.sky.zenith, settings.sky.horizon, settings.sky.ground) = ([0.0; 3], [0.5; 3], [1.0; 3]);
        };
        assert!(with(&gradient).is_some());
        assert!(
            with(&|settings| {
                gradient(settings);
                settings.sky.ground = [1.0, 0.9, 1.0];
            })
            .is_none()
        );
    }
}
