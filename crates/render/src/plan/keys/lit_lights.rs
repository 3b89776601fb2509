//! Lights of a picture, resolved once, in the order that eye, floor and light passes share.

use chiaroscuro_scene::{MAX_LIGHTS, SceneLight, Settings, ShadowAlgorithm};

/// Method by which a light's attenuation is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttenuationMethod {
    /// No attenuation: the light casts no shadows.
    None,
    /// Lookup in the light's attenuation volume.
    Volume,
    /// Ray to the light from every sample.
    Rays,
}

/// Light that is switched on.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveLight {
    /// Index of the light in the settings.
    pub index: usize,
    /// Light resolved into scene space.
    pub light: SceneLight,
    /// Method of its attenuation.
    pub attenuation: AttenuationMethod,
}

impl ActiveLight {
    /// Returns true if material attenuates the light.
    pub fn is_shadowed(&self) -> bool {
        self.attenuation != AttenuationMethod::None
    }
}

/// Lights of a picture that are on: those that material attenuates first, each group in the order of the settings.
/// Shaders expect this order.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveLights(Vec<ActiveLight>);

impl ActiveLights {
    /// Resolves the lights of a look.
    pub fn from_settings(settings: &Settings) -> Self {
        let shadowed = match settings.shadows.algorithm {
            ShadowAlgorithm::Off => AttenuationMethod::None,
            ShadowAlgorithm::Splat | ShadowAlgorithm::Raycast => AttenuationMethod::Volume,
            ShadowAlgorithm::Direct => AttenuationMethod::Rays,
        };
        let on = settings.lights.iter().enumerate().filter(|(_, light)| light.on).take(MAX_LIGHTS);
        let mut lights: Vec<_> = on
            .map(|(index, light)| ActiveLight {
                index,
                light: light.resolve(&settings.camera),
                attenuation: if light.needs_volume() { shadowed } else { AttenuationMethod::None },
            })
            .collect();
        lights.sort_by_key(|lit| !lit.is_shadowed());
        Self(lights)
    }

    /// Returns all lights that are on.
    pub fn all(&self) -> &[ActiveLight] {
        &self.0
    }

    /// Returns the lights that material attenuates, which come first.
    pub fn shadowed(&self) -> &[ActiveLight] {
        let count = self.0.iter().take_while(|lit| lit.is_shadowed()).count();
        &self.0[..count]
    }

    /// Returns the lights without shadows, which come last.
    pub fn unshadowed(&self) -> &[ActiveLight] {
        &self.0[self.shadowed().len()..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{LightSettings, ShadowSettings};

    #[test]
    fn shadowed_lights_come_first_in_the_order_of_the_settings() {
        let light =
            |on: bool, casts_shadows: bool| LightSettings { on, casts_shadows, ..LightSettings::default() };
        let lights = vec![light(true, false), light(true, true), light(false, true), light(true, true)];
        let mut settings = Settings { lights, ..Settings::default() };
        let order = |settings: &Settings| {
            let lit = ActiveLights::from_settings(settings);
            let indices = |lights: &[ActiveLight]| lights.iter().map(|lit| lit.index).collect::<Vec<_>>();
            (indices(lit.shadowed()), indices(lit.unshadowed()))
        };
        assert_eq!(order(&settings), (vec![1, 3], vec![0]));
        settings.shadows = ShadowSettings { algorithm: ShadowAlgorithm::Off, ..ShadowSettings::default() };
        assert_eq!(order(&settings), (vec![], vec![0, 1, 3]));
    }
}
