//! The lights of a picture, resolved once: eye, floor and light passes share their order.

use crate::model::{MAX_LIGHTS, SceneLight, Settings, ShadowAlgorithm};

/// How material attenuates a light on its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attenuation {
    /// Not at all.
    None,
    /// As its light volume says.
    Volume,
    /// By a ray from every sample.
    Rays,
}

/// A light that is on.
#[derive(Debug, Clone, PartialEq)]
pub struct LitLight {
    /// Place of the light in the settings.
    pub index: usize,
    /// Where and what it is.
    pub light: SceneLight,
    /// What attenuates it.
    pub attenuation: Attenuation,
}

impl LitLight {
    /// Whether material attenuates it.
    pub fn is_shadowed(&self) -> bool {
        self.attenuation != Attenuation::None
    }
}

/// The lights of a picture that are on, those that material attenuates first, each kind in the order of the
/// settings: the order in which shaders expect them.
#[derive(Debug, Clone, PartialEq)]
pub struct LitLights(Vec<LitLight>);

impl LitLights {
    /// Resolves the lights of a look.
    pub fn of(settings: &Settings) -> Self {
        let shadowed = match settings.shadows.algorithm {
            ShadowAlgorithm::Off => Attenuation::None,
            ShadowAlgorithm::Splat | ShadowAlgorithm::Raycast => Attenuation::Volume,
            ShadowAlgorithm::Direct => Attenuation::Rays,
        };
        let on = settings.lights.iter().enumerate().filter(|(_, light)| light.on).take(MAX_LIGHTS);
        let mut lights: Vec<_> = on
            .map(|(index, light)| LitLight {
                index,
                light: light.in_scene(&settings.camera),
                attenuation: if light.needs_volume() { shadowed } else { Attenuation::None },
            })
            .collect();
        lights.sort_by_key(|lit| !lit.is_shadowed());
        Self(lights)
    }

    /// All of them.
    pub fn all(&self) -> &[LitLight] {
        &self.0
    }

    /// Those that material attenuates, which come first.
    pub fn shadowed(&self) -> &[LitLight] {
        let count = self.0.iter().take_while(|lit| lit.is_shadowed()).count();
        &self.0[..count]
    }

    /// Those that nothing attenuates, which come last.
    pub fn unshadowed(&self) -> &[LitLight] {
        &self.0[self.shadowed().len()..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Light, Shadows};

    #[test]
    fn shadowed_lights_come_first_in_the_order_of_the_settings() {
        let light = |on: bool, casts_shadows: bool| Light { on, casts_shadows, ..Light::default() };
        let lights = vec![light(true, false), light(true, true), light(false, true), light(true, true)];
        let mut settings = Settings { lights, ..Settings::default() };
        let order = |settings: &Settings| {
            let lit = LitLights::of(settings);
            let indices = |lights: &[LitLight]| lights.iter().map(|lit| lit.index).collect::<Vec<_>>();
            (indices(lit.shadowed()), indices(lit.unshadowed()))
        };
        assert_eq!(order(&settings), (vec![1, 3], vec![0]));
        settings.shadows = Shadows { algorithm: ShadowAlgorithm::Off, ..Shadows::default() };
        assert_eq!(order(&settings), (vec![], vec![0, 1, 3]));
    }
}
