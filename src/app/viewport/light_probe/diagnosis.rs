//! Explanation in one sentence of the brightness of a probed point, and remedies for it.

use crate::app::text;
use crate::app::text::common::LengthUnit;
use chiaroscuro_render::plan::{LightArrival, Probe};
use chiaroscuro_scene::{LightSettings, LitSides, Settings};

/// Share of the possible light from which a point counts as lit.
const LIT_SHARE: f64 = 0.5;

/// Main reason for the brightness of a probed point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BrightnessCause {
    /// Most of the light arrives: index of the strongest light, and its transmittance.
    Lit { light: usize, share: f64 },
    /// No light is switched on.
    AllOff,
    /// Only the sky is on, of which the fraction `open` is visible from the point.
    Sky { open: f64 },
    /// A light is on the other side of the surface.
    FacesAway { light: usize },
    /// The point lies outside a light's cone.
    OutsideCone { light: usize },
    /// Material absorbs the light on its way to the point; `distance` is that of the occluder, in scene units.
    Absorbed { light: usize, share: f64, distance: Option<f64> },
    /// A light arrives at a grazing angle to the surface.
    Grazing { light: usize, angle_deg: f64 },
}

/// Returns the intensity of a light that arrives, and the one that would without occlusion.
fn arriving_and_possible(light: &LightSettings, arrival: &LightArrival) -> [f64; 2] {
    let facing = arrival.facing.map_or(1.0, |facing| facing.max(0.0));
    let could = if light.on { light.intensity } else { 0.0 };
    [could * arrival.transmittance * arrival.hood * facing, could]
}

impl BrightnessCause {
    /// Finds the main reason for the brightness of a probed point.
    pub(super) fn diagnose(settings: &Settings, found: &Probe) -> Self {
        let all: Vec<_> = settings.lights.iter().zip(&found.lights).collect();
        let parts: Vec<[f64; 2]> =
            all.iter().map(|(light, arrival)| arriving_and_possible(light, arrival)).collect();
        let sum = |which: usize| parts.iter().map(|part| part[which]).sum::<f64>();
        let (arrives, could) = (sum(0), sum(1));
        if could <= 0.0 {
            return found.sky.map_or(Self::AllOff, |open| Self::Sky { open });
        }
        let most = |of: &dyn Fn(&[f64; 2]) -> f64| {
            (0..parts.len()).max_by(|&a, &b| of(&parts[a]).total_cmp(&of(&parts[b]))).unwrap_or_default()
        };
        if arrives >= LIT_SHARE * could {
            let light = most(&|part| part[0]);
            let LightArrival { transmittance, hood, .. } = *all[light].1;
            return Self::Lit { light, share: transmittance * hood };
        }
        // The light with the largest loss.
        let light = most(&|[arrives, could]| could - arrives);
        let LightArrival { transmittance, hood, facing, blocked } = *all[light].1;
        match facing {
            _ if hood < 0.5 => Self::OutsideCone { light },
            Some(facing) if facing <= 0.0 => Self::FacesAway { light },
            Some(facing) if facing < transmittance => {
                Self::Grazing { light, angle_deg: facing.clamp(0.0, 1.0).asin().to_degrees() }
            }
            _ => {
                Self::Absorbed { light, share: 1.0 - transmittance, distance: blocked.map(|[near, _]| near) }
            }
        }
    }

    /// Describes the cause in one sentence. `mm_per_unit`: millimetres per scene unit.
    pub(super) fn description(self, settings: &Settings, mm_per_unit: f64, unit: LengthUnit) -> String {
        let name = |light: usize| {
            let name = settings.lights.get(light).map_or("", |light| light.name.as_str());
            if name.is_empty() { text::lights::UNNAMED } else { name }
        };
        match self {
            Self::Lit { light, share } => text::probe::verdict_lit(name(light), share),
            Self::AllOff => text::probe::ALL_OFF.to_owned(),
            Self::Sky { open } => text::probe::verdict_sky_only(open),
            Self::FacesAway { light } => text::probe::verdict_faces_away(name(light)),
            Self::OutsideCone { light } => text::probe::verdict_outside_cone(name(light)),
            Self::Grazing { light, angle_deg } => text::probe::verdict_grazing(name(light), angle_deg),
            Self::Absorbed { light, share, distance } => {
                let distance = distance.map(|distance| text::probe::length(distance * mm_per_unit, unit));
                text::probe::verdict_absorbed(name(light), share, distance.as_deref())
            }
        }
    }

    /// Returns the applicable remedies, the mildest first; remedies that would change nothing are left out.
    pub(super) fn remedies(self, settings: &Settings) -> Vec<BrightnessRemedy> {
        let cures = match self {
            Self::Lit { .. } => Vec::new(),
            Self::Sky { .. } => vec![BrightnessRemedy::SwitchOn(0), BrightnessRemedy::Headlight],
            Self::AllOff => vec![
                BrightnessRemedy::SwitchOn(0),
                BrightnessRemedy::Headlight,
                BrightnessRemedy::MoreAmbient,
            ],
            Self::FacesAway { light } => vec![
                BrightnessRemedy::Headlight,
                BrightnessRemedy::BothSides,
                BrightnessRemedy::TurnHere(light),
            ],
            Self::OutsideCone { light } => {
                vec![BrightnessRemedy::WidenCone(light), BrightnessRemedy::NoCone(light)]
            }
            Self::Grazing { light, .. } => vec![
                BrightnessRemedy::Headlight,
                BrightnessRemedy::TurnHere(light),
                BrightnessRemedy::MoreAmbient,
            ],
            Self::Absorbed { light, .. } => {
                vec![
                    BrightnessRemedy::LetThrough,
                    BrightnessRemedy::LiftShadows,
                    BrightnessRemedy::NoShadowOf(light),
                ]
            }
        };
        let helps = |cure: &BrightnessRemedy| {
            // A sky replaces the ambient light.
            let is_idle = *cure == BrightnessRemedy::MoreAmbient && settings.sky.is_on();
            let mut after = settings.clone();
            cure.apply(&mut after);
            !is_idle && after != *settings
        };
        cures.into_iter().filter(helps).collect()
    }
}

/// Remedy that makes a probed point brighter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum BrightnessRemedy {
    /// Halves the extinction for light.
    LetThrough,
    /// Adds an ambient offset to shadows (P §4).
    LiftShadows,
    /// Adds ambient light, which has no direction.
    MoreAmbient,
    /// Switches off the shadows of a light.
    NoShadowOf(usize),
    /// Adds a weak light at the eye.
    Headlight,
    /// Lights both sides of surfaces.
    BothSides,
    /// Turns a light halfway towards the eye.
    TurnHere(usize),
    /// Widens the cone of a spotlight.
    WidenCone(usize),
    /// Removes the cone of a spotlight.
    NoCone(usize),
    /// Switches a light on.
    SwitchOn(usize),
}

impl BrightnessRemedy {
    /// Name of the remedy's button, and its tooltip.
    pub(super) fn label(self) -> text::ControlText {
        match self {
            Self::LetThrough => text::probe::LET_THROUGH,
            Self::LiftShadows => text::probe::LIFT_SHADOWS,
            Self::MoreAmbient => text::probe::MORE_AMBIENT,
            Self::NoShadowOf(_) => text::probe::CAST_NO_SHADOWS,
            Self::Headlight => text::probe::HEADLIGHT,
            Self::BothSides => text::probe::BOTH_SIDES,
            Self::TurnHere(_) => text::probe::TURN_TO_EYE,
            Self::WidenCone(_) => text::probe::WIDEN_CONE,
            Self::NoCone(_) => text::probe::NO_CONE,
            Self::SwitchOn(_) => text::probe::SWITCH_ON,
        }
    }

    /// Applies the remedy to the settings.
    pub(super) fn apply(self, settings: &mut Settings) {
        let Settings { lights, shadows, shading, layers, camera, .. } = settings;
        match self {
            Self::LetThrough => layers.first_mut().lighting.scale *= 0.5,
            Self::LiftShadows => shadows.ambient_offset += 0.15,
            Self::MoreAmbient => shading.ambient += 0.1,
            Self::BothSides => shading.sides = LitSides::Two,
            Self::Headlight => {
                if lights.len() < chiaroscuro_scene::MAX_LIGHTS {
                    lights.push(LightSettings {
                        name: text::probe::HEADLIGHT_NAME.to_owned(),
                        intensity: 0.4,
                        casts_shadows: false,
                        position: [0.0, 0.0, 3.0],
                        lock: chiaroscuro_scene::LightLock::Camera,
                        ..LightSettings::default()
                    });
                }
            }
            Self::NoShadowOf(at)
            | Self::TurnHere(at)
            | Self::WidenCone(at)
            | Self::NoCone(at)
            | Self::SwitchOn(at) => {
                let Some(light) = lights.get_mut(at) else { return };
                match self {
                    Self::NoShadowOf(_) => light.casts_shadows = false,
                    Self::WidenCone(_) => light.hood.half_angle_deg += 15.0,
                    Self::NoCone(_) => light.hood.on = false,
                    Self::SwitchOn(_) => light.on = true,
                    _ => {
                        let world = light.resolve(camera);
                        let from = glam::DVec3::from(world.position);
                        let eye = camera.scene_from_view().z_axis;
                        let towards = (from.normalize_or(eye) + eye).normalize_or(eye);
                        light.set_scene_position(towards * from.length(), camera);
                    }
                }
            }
        }
        settings.sanitise();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn found(lights: Vec<LightArrival>) -> Probe {
        let origin = DVec3::ZERO;
        Probe {
            layer: 0,
            point: origin,
            normal: DVec3::ZERO,
            index: origin,
            world_mm: origin,
            value: 1.0,
            opacity: 1.0,
            lights,
            sky: None,
        }
    }

    const LIT: LightArrival =
        LightArrival { transmittance: 0.9, hood: 1.0, facing: Some(0.9), blocked: None };

    fn words(settings: &Settings, lights: Vec<LightArrival>) -> String {
        BrightnessCause::diagnose(settings, &found(lights)).description(
            settings,
            50.0,
            LengthUnit::for_length(1.0, false),
        )
    }

    #[test]
    fn the_cause_is_named_in_one_sentence() {
        let mut settings = Settings::default();
        settings.lights[0].name = "Key".to_owned();
        assert_eq!(words(&settings, vec![LIT]), "Lit: 90 % of Key arrives");
        let dark = LightArrival { transmittance: 0.3, blocked: Some([0.24, 0.5]), ..LIT };
        assert_eq!(words(&settings, vec![dark]), "Dark: 70 % of Key is absorbed 12.0 mm before it arrives");
        let away = LightArrival { facing: Some(-0.5), ..LIT };
        assert_eq!(words(&settings, vec![away]), "Dark: the surface faces away from Key");
        let outside = LightArrival { hood: 0.0, ..LIT };
        assert_eq!(words(&settings, vec![outside]), "Dark: outside the spotlight cone of Key");
        let low = LightArrival { facing: Some(0.2), ..LIT };
        assert_eq!(words(&settings, vec![low]), "Dim: Key meets the surface at only 12°");
        settings.lights[0].on = false;
        assert_eq!(words(&settings, vec![LIT]), "Dark: no light is on");
        let under_sky = Probe { sky: Some(0.8), ..found(vec![LIT]) };
        let cause = BrightnessCause::diagnose(&settings, &under_sky);
        assert_eq!(cause, BrightnessCause::Sky { open: 0.8 });
        // Remedies that would change nothing are not offered.
        assert_eq!(cause.remedies(&settings), [BrightnessRemedy::SwitchOn(0), BrightnessRemedy::Headlight]);
        settings.lights.clear();
        assert_eq!(cause.remedies(&settings), [BrightnessRemedy::Headlight]);
    }

    #[test]
    fn the_light_that_is_missed_most_is_blamed() {
        let mut settings = Settings::default();
        settings.lights[0].name = "Fill".to_owned();
        settings.lights[0].intensity = 0.3;
        settings.lights.push(LightSettings {
            name: "Key".to_owned(),
            intensity: 1.0,
            ..LightSettings::default()
        });
        let dark = LightArrival { transmittance: 0.05, ..LIT };
        assert!(words(&settings, vec![dark, dark]).contains("Key"));
        assert!(words(&settings, vec![LIT, dark]).contains("Key"));
    }

    #[test]
    fn every_cure_changes_the_look_and_helps() {
        let settings = Settings::default();
        let cures = [
            BrightnessRemedy::LetThrough,
            BrightnessRemedy::LiftShadows,
            BrightnessRemedy::MoreAmbient,
            BrightnessRemedy::NoShadowOf(0),
            BrightnessRemedy::Headlight,
            BrightnessRemedy::BothSides,
            BrightnessRemedy::TurnHere(0),
        ];
        for cure in cures {
            let mut after = settings.clone();
            cure.apply(&mut after);
            assert_ne!(after, settings, "{cure:?}");
            assert!(!cure.label().name.is_empty());
        }
        let eye = settings.camera.scene_from_view().z_axis;
        let angle = |settings: &Settings| {
            let world = settings.lights[0].resolve(&settings.camera);
            DVec3::from(world.position).angle_between(eye)
        };
        let mut nearer = settings.clone();
        BrightnessRemedy::TurnHere(0).apply(&mut nearer);
        assert!((angle(&nearer) - angle(&settings) / 2.0).abs() < 1e-6);
    }
}
