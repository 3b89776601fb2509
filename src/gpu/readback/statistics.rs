//! Statistics of a renderer: cached volumes, memory and work done.

use crate::gpu::light::volume::LightVolume;
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::resources::readback::read_word;
use crate::gpu::{GpuError, Renderer};
use crate::plan::{BouncesKey, LightKey, Request, SkyKey};

/// Statistics of a light volume, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightFigures {
    /// `true` if the volume is filled.
    pub complete: bool,
    /// Time to fill the volume, in milliseconds, on adapters that execute commands synchronously; else `None`.
    pub fill_ms: Option<f64>,
    /// Size of the texture, in bytes.
    pub bytes: u64,
}

impl Renderer {
    /// Returns the statistics of a request's light volumes at full resolution, in the order of the settings.
    pub fn light_figures(&self, request: &Request) -> Vec<Option<LightFigures>> {
        let Some(loaded) = &self.loaded else { return Vec::new() };
        let figures = |key: &Option<LightKey>| {
            let wanted = key.as_ref()?;
            let is_same = |light: &&Cached<LightKey, LightVolume>| *light.key() == *wanted;
            let light = loaded.value.lights.iter().find(is_same)?;
            Some(self.filled(light.is_complete(), &light.value.fill, light.value.bytes()))
        };
        (0..request.settings.lights.len()).map(|light| figures(&LightKey::of(request, light))).collect()
    }

    /// Returns the statistics of a request's sky volume at full resolution, if there is one.
    pub fn sky_figures(&self, request: &Request) -> Option<LightFigures> {
        let wanted = SkyKey::of(request)?;
        let sky = self.loaded.as_ref()?.value.skies.iter().find(|sky| *sky.key() == wanted)?;
        Some(self.filled(sky.is_complete(), &sky.value.fill, sky.value.bytes()))
    }

    /// Returns the number of voxels along the edge of a block in the last used sky volume; larger than requested if
    /// the rays would take too much memory.
    pub fn sky_divisor(&self) -> Option<usize> {
        let skies = &self.loaded.as_ref()?.value.skies;
        skies.iter().max_by_key(|sky| sky.value.last_used).map(|sky| sky.value.divisor)
    }

    /// Returns the statistics of a request's scattered-light volume at full resolution, if there is one.
    pub fn bounces_figures(&self, request: &Request) -> Option<LightFigures> {
        let wanted = BouncesKey::of(request)?;
        let known = &self.loaded.as_ref()?.value.bounces;
        let bounces = known.iter().find(|bounces| *bounces.key() == wanted)?;
        Some(self.filled(bounces.is_complete(), &bounces.value.fill, bounces.value.bytes()))
    }

    fn filled(&self, complete: bool, fill: &FillTime, bytes: u64) -> LightFigures {
        // On graphics cards submission is asynchronous, and the time measured is meaningless.
        let fill_ms = fill.took_ms().filter(|_| self.context().is_software());
        LightFigures { complete, fill_ms, bytes }
    }

    /// Returns true if the volume of the last picture is completely transparent.
    pub fn shows_nothing(&self) -> bool {
        self.loaded.as_ref().is_some_and(|loaded| loaded.value.tables.value.eye.is_empty)
    }

    /// Returns the number of times each light's volume was filled, counted at its first march.
    pub fn light_rebuilds(&self) -> &[u64] {
        &self.fills
    }

    /// Returns the number of complete light volumes in the cache.
    pub fn cached_light_volumes(&self) -> usize {
        let lights = self.loaded.iter().flat_map(|loaded| &loaded.value.lights);
        lights.filter(|light| light.is_complete()).count()
    }

    /// Returns the current size of the renderer's textures and buffers on the GPU, in bytes.
    pub fn gpu_bytes(&self) -> u64 {
        let loaded = self.loaded.as_ref().map_or(0, |loaded| loaded.value.bytes());
        self.targets.bytes() + self.tools.pool.bytes() + loaded
    }

    /// Returns the size of all attenuation volumes and the combined one, in bytes.
    pub fn light_bytes(&self) -> u64 {
        self.loaded.as_ref().map_or(0, |loaded| loaded.value.light_bytes())
    }

    /// Returns the number of footprints that the last picture splatted; 0 for the gathering engine. Waits for the
    /// picture.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn splats(&self) -> Result<u64, GpuError> {
        let counter = self.targets.front.light.value.splats.as_ref();
        counter.map_or(Ok(0), |counter| read_word(self.context(), counter).map(u64::from))
    }

    /// Returns the number of buffers, bind groups and rings made so far, which stays constant while the same things
    /// are drawn again.
    pub fn made(&self) -> u64 {
        self.tools.pool.made()
    }
}
