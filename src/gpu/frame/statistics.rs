//! What a renderer keeps and what it has done, in numbers.

use super::job::Job;
use crate::gpu::light::combine::CollapsedLight;
use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::display::Target;
use crate::gpu::resources::readback::read_word;
use crate::gpu::scatter::voxels::ScatterVoxels;
use crate::gpu::volume::GpuVolume;
use crate::gpu::{GpuError, Renderer};

/// A light's volume, for display.
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
    /// The volumes of a job's lights, in the order of the settings.
    pub fn light_figures(&self, job: &Job) -> Vec<Option<LightFigures>> {
        let figures = |key: &Option<_>| {
            let light = self.lights.iter().find(|light| Some(&light.key) == key.as_ref())?;
            // Others only take note of what they will do, and return at once.
            let fill_ms = light.fill_ms.filter(|_| self.context.is_software());
            Some(LightFigures { complete: light.complete, fill_ms, bytes: light.bytes() })
        };
        job.keys.iter().map(figures).collect()
    }

    /// How often the light volume of each light of the settings was filled; counted where its first
    /// march is submitted.
    pub fn light_rebuilds(&self) -> &[u64] {
        &self.rebuilds
    }

    /// Light volumes that are complete and kept.
    pub fn cached_light_volumes(&self) -> usize {
        self.lights.iter().filter(|light| light.complete).count()
    }

    /// Bytes of our textures on the GPU now.
    pub fn gpu_bytes(&self) -> u64 {
        let targets = self.front.iter().chain(&self.back).map(Target::bytes).sum::<u64>();
        let lights = self.light_bytes();
        let voxels = self.voxels.as_ref().map_or(0, ScatterVoxels::bytes) + self.recycled.bytes();
        targets + lights + voxels + self.volume.as_ref().map_or(0, GpuVolume::bytes)
    }

    /// Bytes of light volumes, of which pictures look up those of their lights, or one for all.
    pub fn light_bytes(&self) -> u64 {
        let collapsed = self.collapsed.as_ref().map_or(0, CollapsedLight::bytes);
        collapsed + self.lights.iter().map(LightVolume::bytes).sum::<u64>()
    }

    /// How many footprints the last picture has splatted; 0 of one that gathers. Waits for it.
    ///
    /// # Errors
    /// When the GPU cannot do it.
    pub fn splats(&self) -> Result<u64, GpuError> {
        self.splats.as_ref().map_or(Ok(0), |counter| read_word(&self.context, counter).map(u64::from))
    }

    /// How many buffers, bind groups and sheets were made for passes so far: while the same things are drawn
    /// again and again, none.
    pub fn made(&self) -> u64 {
        self.recycled.made()
    }
}
