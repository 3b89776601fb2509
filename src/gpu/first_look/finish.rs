//! The end of a first look, for those who wait for it: the light that was sought, and the brightness that goes with it.

use super::balance::{SmallPictures, with_quick_shadows};
use super::light_search::{Found, LightSearch, Sought};
use super::measures::exposure_for;
use crate::data::Dataset;
use crate::gpu::{GpuError, Renderer};
use crate::model::Settings;

/// A part of a look that nobody has decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// Where the lights stand.
    Lights,
    /// Whether there is a floor; decided with the lights.
    Floor,
    /// How much brighter lights are for their shadows.
    Balance,
    /// How bright the picture is shown.
    Exposure,
}

/// Automatic settings with all parts decided that are open. Uploads the volume and fills the light volumes on the way.
///
/// # Errors
/// When the GPU cannot do it.
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
        // Whether or not there are shadows: pictures with and without are as bright.
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

/// Seeks the lights; `None` if nothing is seen, or there is no room for it: the picture can be made all the same.
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
