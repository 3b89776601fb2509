//! Completion of a first look: light search, floor, balance and exposure.

use super::balance::{SmallPictures, with_quick_shadows};
use super::light_search::{Found, LightSearch, Sought};
use super::measures::exposure_for;
use crate::data::Dataset;
use crate::gpu::{GpuError, Renderer};
use crate::model::Settings;

/// Part of the settings that is still to be chosen automatically.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// Positions of the lights.
    Lights,
    /// Presence of a floor, chosen together with the lights.
    Floor,
    /// Balance: factor for lights that compensates for their shadows.
    Balance,
    /// Exposure of the displayed picture.
    Exposure,
}

/// Returns the settings with all `open` parts chosen. Uploads the volume and fills the light volumes.
///
/// # Errors
/// Returns an error if the device fails or memory is exhausted.
pub fn finish_look(
    renderer: &mut Renderer,
    dataset: &Dataset,
    settings: &Settings,
    open: &[Open],
) -> Result<Settings, GpuError> {
    let mut look = settings.clone();
    if open.contains(&Open::Lights)
        && let Some(found) = seek(renderer, dataset, settings)?
    {
        let found = found.apply(settings);
        look.lights = found.lights;
        if open.contains(&Open::Floor) {
            look.floor = found.floor;
        }
    }
    if open.contains(&Open::Balance) || open.contains(&Open::Exposure) {
        // Measured with shadows even if they are off: pictures with and without are equally bright.
        let seen = SmallPictures::of(renderer, dataset, &with_quick_shadows(&look))?;
        if open.contains(&Open::Balance) {
            look.shadows.balance = seen.balance();
        }
        if open.contains(&Open::Exposure) {
            look.output.exposure = exposure_for(&seen.balanced(look.shadows.balance));
        }
    }
    look.sanitise();
    Ok(look)
}

/// Searches for lights; `None` if nothing is visible, or if memory for the search is exhausted, which need not
/// prevent the picture.
fn seek(renderer: &Renderer, dataset: &Dataset, settings: &Settings) -> Result<Option<Found>, GpuError> {
    let search = LightSearch::new(renderer.shaders(), dataset, settings, Sought::KeyAndFill);
    match search.and_then(LightSearch::run) {
        Err(err @ (GpuError::OutOfMemory { .. } | GpuError::OverLimit { .. })) => {
            log::warn!("no light was sought: {err}");
            Ok(None)
        }
        found => found,
    }
}
