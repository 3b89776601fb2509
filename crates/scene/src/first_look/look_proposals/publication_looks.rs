//! Looks for publication: lights with a size, a sky, bounced light, and a ground, for a cover, a journal, an atlas, or
//! as if made of glass. View and transfer function are those of the first look.

use super::super::transfer;
use super::LookProposal;
use crate::{Background, LightSettings, LightShape, LightingRig, Settings, SkyMode, SkySettings};

/// Angular width in degrees of the key light of a cover: a softbox of a metre from three, twice as wide as in a first
/// look.
const COVER_KEY_DEG: f64 = 20.0;

/// Sky intensity of a cover: hollows get colour and keep their depth.
const COVER_SKY: f64 = 0.2;

/// Bounces of light in a cover: after three, what is missing is spread evenly.
const COVER_BOUNCES: u32 = 3;

/// Sky intensity for print, whose blacks are dull: shadows must not be darker than a third of the light.
const JOURNAL_SKY: f64 = 0.35;

/// Sky intensity of an atlas: as much as its light, so that form comes from hollows rather than from shadows.
const ATLAS_SKY: f64 = 0.6;

/// Angular width in degrees and intensity of the light of an atlas: a bright window on an overcast day.
const ATLAS_KEY_DEG: f64 = 25.0;
const ATLAS_KEY: f64 = 0.6;

/// Opacity factor of glass: two walls of it let half of the light through where opaque material lets none.
const GLASS_OPACITY: f64 = 0.12;

/// Highlights of glass: strong and small.
const GLASS_SPECULAR: f64 = 0.9;
const GLASS_SHININESS: f64 = 90.0;

/// Dark studio, light studio, page of an atlas, and black, as colours of sRGB.
const STUDIO: Background = Background { top: [0.035, 0.04, 0.055], bottom: [0.13, 0.14, 0.165] };
const LIGHT_STUDIO: Background = Background { top: [0.96, 0.965, 0.97], bottom: [0.84, 0.85, 0.865] };
const PAGE: Background = Background { top: [0.985, 0.97, 0.935], bottom: [0.985, 0.97, 0.935] };
const BLACK: Background = Background { top: [0.0; 3], bottom: [0.03, 0.035, 0.045] };

/// Returns the looks for publication of a first look.
pub(super) fn publication_looks(first: &Settings) -> [LookProposal; 4] {
    let proposal = |name, description, settings| LookProposal { name, description, settings };
    [
        proposal("Cover", "a larger light and bounced light in a dark studio", cover_look(first)),
        proposal("Journal", "soft light in a light studio, for print", journal_look(first)),
        proposal("Atlas", "even light on a page, form by its hollows", atlas_look(first)),
        proposal("Glass", "translucent, with bright outlines on black", glass_look(first)),
    ]
}

fn sky(mode: SkyMode, intensity: f64) -> SkySettings {
    SkySettings { mode, intensity, ..SkySettings::default() }
}

/// Returns the first light that casts shadows.
fn key_light(settings: &mut Settings) -> Option<&mut LightSettings> {
    settings.lights.iter_mut().find(|light| light.on && light.casts_shadows)
}

/// Makes the key light a disc of an angular width in degrees.
fn widen_key(settings: &mut Settings, angle_deg: f64) {
    if let Some(key) = key_light(settings) {
        (key.shape, key.angle_deg) = (LightShape::Disc, angle_deg);
    }
}

fn cover_look(first: &Settings) -> Settings {
    let mut cover = Settings { sky: sky(SkyMode::Gradient, COVER_SKY), ..first.clone() };
    widen_key(&mut cover, COVER_KEY_DEG);
    cover.scattering.bounces = cover.scattering.bounces.max(COVER_BOUNCES);
    cover.output.background = STUDIO;
    cover
}

fn journal_look(first: &Settings) -> Settings {
    let mut journal = Settings { sky: sky(SkyMode::White, JOURNAL_SKY), ..first.clone() };
    widen_key(&mut journal, COVER_KEY_DEG);
    journal.output.background = LIGHT_STUDIO;
    journal.floor.shadow_only = true;
    journal
}

fn atlas_look(first: &Settings) -> Settings {
    let mut atlas = Settings { sky: sky(SkyMode::White, ATLAS_SKY), ..first.clone() };
    widen_key(&mut atlas, ATLAS_KEY_DEG);
    if let Some(key) = key_light(&mut atlas) {
        key.intensity *= ATLAS_KEY;
    }
    atlas.shading.specular = 0.0;
    atlas.output.background = PAGE;
    atlas.floor.shadow_only = true;
    atlas
}

fn glass_look(first: &Settings) -> Settings {
    let mut glass = Settings {
        sky: sky(SkyMode::Gradient, COVER_SKY),
        lights: LightingRig::Rim.lights(&first.camera),
        ..first.clone()
    };
    transfer::scale_opacity(&mut glass.layer_mut().transfer, GLASS_OPACITY);
    glass.layer_mut().labels.modify_all(|_, look| look.opacity *= GLASS_OPACITY);
    (glass.shading.specular, glass.shading.shininess) = (GLASS_SPECULAR, GLASS_SHININESS);
    glass.output.background = BLACK;
    glass.floor.on = false;
    glass
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::first_settings;
    use crate::first_look::tests::ball;
    use chiaroscuro_volume::Histogram;

    #[test]
    fn view_and_matter_are_those_of_the_first_look() {
        let volume = ball(200.0, 0.0);
        let first = first_settings(&volume, &Histogram::from_volume(&volume));
        for LookProposal { name, settings, .. } in publication_looks(&first) {
            assert_eq!(settings.camera, first.camera, "{name}");
            assert_ne!(settings.output.background, first.output.background, "{name}");
            let is_same = settings.layer().transfer == first.layer().transfer;
            assert_eq!(is_same, name != "Glass", "{name}");
            assert!(settings.sky.mode != SkyMode::Off, "{name}");
        }
    }

    #[test]
    fn looks_without_a_light_have_none_to_widen() {
        let volume = ball(200.0, 0.0);
        let mut first = first_settings(&volume, &Histogram::from_volume(&volume));
        first.lights.clear();
        assert_eq!(publication_looks(&first).map(|look| look.settings.lights.len()), [0, 0, 0, 3]);
    }
}
