//! Placement: volumes of light that a picture looks up are found in the caches, recycled or created.

use super::light_volumes::LightEntries;
use super::scattered_light_volumes::ScatteredLightPlace;
use super::sky_volumes::SkyPlace;
use crate::GpuError;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::plan::{ActiveLights, LightKey};
use crate::resources::gpu_tools::GpuTools;

/// Volumes of light that a picture looks up, and the work to fill them.
#[derive(Debug, Default)]
pub(crate) struct VolumePlacement {
    pub lights: LightEntries,
    pub sky: SkyPlace,
    pub bounces: ScatteredLightPlace,
}

impl VolumePlacement {
    /// Finds or creates all volumes that a picture looks up.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        tools: &GpuTools,
        loaded: &mut LoadedVolume,
        wanted: ProductRequest<'_>,
    ) -> Result<Self, GpuError> {
        let lights = place_lights(tools, loaded, wanted)?;
        if lights.builds.is_empty() {
            tools.pool.drop_ring();
        }
        Ok(Self {
            lights,
            sky: loaded.find_or_create_sky(tools, wanted)?,
            bounces: loaded.find_or_create_scattered_light(tools, wanted)?,
        })
    }

    /// Finds or creates the volumes that a floor needs under a picture that is already drawn.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn place_for_floor(
        &mut self,
        tools: &GpuTools,
        loaded: &mut LoadedVolume,
        wanted: ProductRequest<'_>,
        lights: &ActiveLights,
    ) -> Result<(), GpuError> {
        self.sky = loaded.find_or_create_sky(tools, wanted)?;
        // Area lights also have floor shadow maps; for other lights rays are cast.
        let has_map = lights.shadowed().iter().any(|lit| lit.light.area.is_some());
        if has_map && wanted.keys.combined.is_none() {
            self.lights = place_lights(tools, loaded, wanted)?;
        }
        Ok(())
    }
}

/// Finds or creates the light volumes of a picture, recycling those of an interrupted one.
fn place_lights(
    tools: &GpuTools,
    loaded: &mut LoadedVolume,
    wanted: ProductRequest<'_>,
) -> Result<LightEntries, GpuError> {
    // Cached bind groups would keep the temporary volumes of the interrupted filling alive.
    let has_scratch = |key: &LightKey| key.samples() > 1 || key.has_colors();
    let is_half_filled = loaded.lights.iter().any(|light| !light.is_complete() && has_scratch(light.key()));
    let mut recyclable = loaded.take_incomplete();
    let placed = loaded.find_or_create_lights(wanted, &mut recyclable)?;
    if is_half_filled || !recyclable.is_empty() {
        drop(recyclable);
        tools.pool.drop_bind_groups();
    }
    Ok(placed)
}
