//! Keys: the inputs of each product of the renderer.
//!
//! A product is cached together with its key, and is stale exactly if the key that a picture needs differs. Settings
//! are destructured without `..`, so that a new field does not compile until it is classified.

mod bounces;
mod combined;
mod display;
mod eye;
mod light;
mod light_lookup;
mod lit_lights;
mod sky;
mod table;
#[cfg(test)]
mod tests;
mod uniform_light_color;

pub use bounces::BouncesKey;
pub use combined::CombinedKey;
pub use display::DisplayKey;
pub use eye::{AntialiasedKey, EyeKey, FloorKey};
pub use light::LightKey;
pub use lit_lights::{ActiveLight, ActiveLights, AttenuationMethod};
pub use sky::SkyKey;
pub use table::{EyeTableKey, OpacityKey, TablesKey};
pub use uniform_light_color::UniformLightColor;

use super::{RenderOptions, RenderRequest, VolumeKey};

/// Keys of all products that a picture needs.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameKeys {
    /// Density, pyramid and gradients on the GPU.
    pub volume: VolumeKey,
    /// Lookup tables of both transfer functions, and the cells that they show.
    pub tables: TablesKey,
    /// Attenuation volume of each light of the settings, at the resolution of the settings; `None` for lights
    /// without.
    pub lights: Vec<Option<LightKey>>,
    /// Combined diffuse light of all lights, if the settings request it.
    pub combined: Option<CombinedKey>,
    /// Volume of sky visibility, if there is one.
    pub sky: Option<SkyKey>,
    /// Volume of bounced light, if any light bounces.
    pub bounces: Option<BouncesKey>,
    /// Linear light of the volume.
    pub eye: EyeKey,
    /// Linear light of the volume, antialiased, if there are several rays through each sample.
    pub antialiased: Option<AntialiasedKey>,
    /// Linear light on the floor, if there is one.
    pub floor: Option<FloorKey>,
    /// Display of both on screen or in a file.
    pub display: DisplayKey,
}

impl FrameKeys {
    /// Computes the keys of a picture: a pure function of request and options.
    pub fn new(request: &RenderRequest, options: &RenderOptions) -> Self {
        let request = &*request.resolved_mode();
        let lights: Vec<_> =
            (0..request.settings.lights.len()).map(|index| LightKey::new(request, index)).collect();
        let combined = CombinedKey::new(request, options);
        let sky = SkyKey::new(request);
        let bounces = BouncesKey::new(request);
        let eye = EyeKey::new(request, options, &lights, combined.as_ref(), sky.as_ref(), bounces.as_ref());
        Self {
            volume: request.volume_key(),
            tables: TablesKey::new(request),
            antialiased: AntialiasedKey::new(request, options, &eye),
            floor: FloorKey::new(request, options, &eye),
            display: DisplayKey::new(request, options),
            lights,
            combined,
            sky,
            bounces,
            eye,
        }
    }

    /// Returns the number of light volumes of this picture that another picture does not have.
    pub fn count_lights_missing_in(&self, other: &Self) -> usize {
        self.lights_missing_in(other).count()
    }

    /// Returns true if another picture does not have the volume of each light with a size.
    pub fn lacks_area_light_in(&self, other: &Self) -> bool {
        self.lights_missing_in(other).any(|key| key.samples() > 1)
    }

    /// Returns the keys of light volumes that another picture does not have.
    fn lights_missing_in<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = &'a LightKey> {
        let keys = self.lights.iter().flatten();
        keys.filter(|key| !other.lights.iter().flatten().any(|known| known == *key))
    }
}
