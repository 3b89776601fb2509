//! Lights of a picture, each with its attenuation volume among the cached ones.

use crate::frame::loaded_volume::LoadedVolume;
use crate::light::light_uniform::LightInput;
use crate::light::light_volume::LightVolume;
use crate::plan::{ActiveLight, ActiveLights};

/// Returns the lights of a picture, each with its volume.
pub(crate) fn light_inputs<'a>(
    lit: &'a ActiveLights,
    slots: &[Option<usize>],
    loaded: &'a LoadedVolume,
) -> Vec<LightInput<'a>> {
    light_inputs_of(lit.all(), slots, loaded)
}

pub(super) fn light_inputs_of<'a>(
    lights: &'a [ActiveLight],
    slots: &[Option<usize>],
    loaded: &'a LoadedVolume,
) -> Vec<LightInput<'a>> {
    let volume_of = |index: usize| -> Option<&'a LightVolume> {
        let slot = slots.get(index).copied().flatten()?;
        loaded.lights.get(slot).map(|light| &light.product)
    };
    lights.iter().map(|lit| LightInput { light: lit, volume: volume_of(lit.index) }).collect()
}
