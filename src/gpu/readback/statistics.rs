//! What a renderer keeps and what it has done, in numbers.

use crate::gpu::light::volume::LightVolume;
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::resources::readback::read_word;
use crate::gpu::{GpuError, Renderer};
use crate::plan::{BouncesKey, LightKey, Request, SkyKey};

/// A volume of light, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightFigures {
    /// Whether it is filled.
    pub complete: bool,
    /// From the beginning of its filling to the end, where the adapter works while it is told what to do.
    pub fill_ms: Option<f64>,
    /// Bytes of its texture.
    pub bytes: u64,
}

impl Renderer {
    /// The volumes of the lights of a request at full resolution, in the order of the settings.
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

    /// The volume of the sky of a request at full resolution, if there is one.
    pub fn sky_figures(&self, request: &Request) -> Option<LightFigures> {
        let wanted = SkyKey::of(request)?;
        let sky = self.loaded.as_ref()?.value.skies.iter().find(|sky| *sky.key() == wanted)?;
        Some(self.filled(sky.is_complete(), &sky.value.fill, sky.value.bytes()))
    }

    /// Voxels along the edge of a block of the sky's volume that was last used: more than were asked for where rays would take
    /// more room than they may.
    pub fn sky_divisor(&self) -> Option<usize> {
        let skies = &self.loaded.as_ref()?.value.skies;
        skies.iter().max_by_key(|sky| sky.value.last_used).map(|sky| sky.value.divisor)
    }

    /// The volume of bounced light of a request at full resolution, if there is one.
    pub fn bounces_figures(&self, request: &Request) -> Option<LightFigures> {
        let wanted = BouncesKey::of(request)?;
        let known = &self.loaded.as_ref()?.value.bounces;
        let bounces = known.iter().find(|bounces| *bounces.key() == wanted)?;
        Some(self.filled(bounces.is_complete(), &bounces.value.fill, bounces.value.bytes()))
    }

    fn filled(&self, complete: bool, fill: &FillTime, bytes: u64) -> LightFigures {
        // Others only take note of what they will do, and return at once.
        let fill_ms = fill.took_ms().filter(|_| self.context().is_software());
        LightFigures { complete, fill_ms, bytes }
    }

    /// Whether the last picture shows nothing of its volume: all of it is transparent.
    pub fn shows_nothing(&self) -> bool {
        self.loaded.as_ref().is_some_and(|loaded| loaded.value.tables.value.eye.is_empty)
    }

    /// How often the light volume of each light of the settings was filled; counted where its first
    /// march is submitted.
    pub fn light_rebuilds(&self) -> &[u64] {
        &self.fills
    }

    /// Light volumes that are complete and kept.
    pub fn cached_light_volumes(&self) -> usize {
        let lights = self.loaded.iter().flat_map(|loaded| &loaded.value.lights);
        lights.filter(|light| light.is_complete()).count()
    }

    /// Bytes of our textures on the GPU now.
    pub fn gpu_bytes(&self) -> u64 {
        let loaded = self.loaded.as_ref().map_or(0, |loaded| loaded.value.bytes());
        self.targets.bytes() + self.tools.pool.bytes() + loaded
    }

    /// Bytes of light volumes, of which pictures look up those of their lights, or one for all.
    pub fn light_bytes(&self) -> u64 {
        self.loaded.as_ref().map_or(0, |loaded| loaded.value.light_bytes())
    }

    /// How many footprints the last picture has splatted; 0 of one that gathers. Waits for it.
    ///
    /// # Errors
    /// When the GPU cannot do it.
    pub fn splats(&self) -> Result<u64, GpuError> {
        let counter = self.targets.front.light.value.splats.as_ref();
        counter.map_or(Ok(0), |counter| read_word(self.context(), counter).map(u64::from))
    }

    /// How many buffers, bind groups and sheets were made for passes so far: while the same things are drawn
    /// again and again, none.
    pub fn made(&self) -> u64 {
        self.tools.pool.made()
    }
}
