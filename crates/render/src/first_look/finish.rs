//! Completion of a first look: light search, floor, balance and exposure.

use super::balance::{BrightnessPictures, with_fast_shadows};
use super::light_search::{LightSearch, LightSearchResult, SearchedLight};
use crate::{GpuError, Renderer};
use chiaroscuro_scene::{Settings, first_look::floor_color};
use chiaroscuro_volume::Dataset;

/// Part of the settings that is still to be chosen automatically.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UndecidedPart {
    /// Positions of the lights.
    Lights,
    /// Presence of a floor, chosen together with the lights.
    Floor,
    /// Balance: factor for lights that compensates for their shadows.
    Balance,
    /// Exposure of the displayed picture.
    Exposure,
}

impl UndecidedPart {
    /// All parts, in the order in which they are chosen.
    pub const ALL: [Self; 4] = [Self::Lights, Self::Floor, Self::Balance, Self::Exposure];

    /// Returns the path of the setting that holds the part. A part whose setting is given is not chosen automatically.
    pub const fn path(self) -> &'static str {
        match self {
            Self::Lights => "lights",
            Self::Floor => "floor",
            Self::Balance => "shadows.balance",
            Self::Exposure => "output.exposure",
        }
    }
}

/// Returns the settings with all `open` parts chosen. Uploads the volume and fills the light volumes.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn complete_first_look(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
    open: &[UndecidedPart],
) -> Result<Settings, GpuError> {
    let mut look = settings.clone();
    if open.contains(&UndecidedPart::Lights)
        && let Some(found) = search_lights(renderer, dataset, settings)?
    {
        let found = found.apply(settings);
        look.lights = found.lights;
        if open.contains(&UndecidedPart::Floor) {
            look.floor = found.floor;
        }
    }
    if open.contains(&UndecidedPart::Balance) || open.contains(&UndecidedPart::Exposure) {
        // Measured with shadows even if they are off: pictures with and without are equally bright.
        let seen = BrightnessPictures::draw(renderer, dataset, &with_fast_shadows(&look))?;
        if open.contains(&UndecidedPart::Balance) {
            look.shadows.balance = seen.balance();
        }
        if open.contains(&UndecidedPart::Exposure) {
            look.output.exposure = seen.exposure(&look);
        }
    }
    if look.floor.on && !settings.floor.on {
        // The exposure, on which the floor's colour depends, has only now been determined.
        look.floor.color = floor_color(look.output.exposure);
    }
    look.sanitise();
    Ok(look)
}

/// Searches for lights; `None` if nothing is visible, or if memory for the search is exhausted, which need not
/// prevent the picture.
fn search_lights(
    renderer: &Renderer,
    dataset: &Dataset,
    settings: &Settings,
) -> Result<Option<LightSearchResult>, GpuError> {
    let search = LightSearch::new(renderer.shaders(), dataset, settings, SearchedLight::KeyAndRim);
    match search.and_then(LightSearch::run) {
        Err(err @ (GpuError::OutOfMemory { .. } | GpuError::OverLimit { .. })) => {
            log::warn!("the light search was skipped: {err}");
            Ok(None)
        }
        found => found,
    }
}
