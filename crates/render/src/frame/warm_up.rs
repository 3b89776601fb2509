//! Pre-compilation of the pipelines for the first pictures and previews: each can take a driver tens of milliseconds,
//! which would stall the window.

use crate::eye::antialiasing::EDGES;
use crate::eye::eye_variant::EyeVariant;
use crate::eye::floor::FloorVariant;
use crate::light::backproject::BackprojectVariant;
use crate::light::march::MarchVariant;
use crate::output::display::DisplayVariant;
use crate::pipelines::pipeline_variant::{LightCount, PipelineVariant, SingleVariant};
use crate::{GpuError, RenderOptions, Renderer, ShaderLibrary};
use chiaroscuro_scene::{
    ClipPlane, Clipping, ReconstructionKernel, SamplingSettings, Settings, ShadowSettings, SkyMode,
    SkySettings, SlabMode, first_look,
};
use chiaroscuro_volume::{CancelToken, Dataset, synthetic::builtin};

/// Number of lights in a first look.
const FIRST_LIGHTS: LightCount = LightCount { all: 2, shadowed: 2 };

/// Edge of the volume that is drawn to compile the passes of soft light, in voxels, and the size of its picture.
const WARM_UP_VOXELS: usize = 32;
const WARM_UP_SIZE: [u32; 2] = [16, 12];

/// Kernels and slabs of previews and of pictures.
const KERNELS_AND_SLABS: [(ReconstructionKernel, SlabMode); 2] = [
    (ReconstructionKernel::Prefiltered, SlabMode::Preintegrated),
    (ReconstructionKernel::BSpline, SlabMode::ByNeed),
];

impl ShaderLibrary {
    /// Compiles the usual variants of every shader, until `cancel` is cancelled. To be called on a separate thread.
    ///
    /// # Errors
    /// Returns an error if a shader is invalid.
    pub fn warm_up(&self, cancel: &CancelToken) -> Result<(), GpuError> {
        for shader in ["volume/prefilter.wgsl", "volume/downsample.wgsl", "volume/gradients.wgsl"] {
            self.compile_unless_cancelled(&SingleVariant(shader), cancel)?;
        }
        self.compile_unless_cancelled(&SingleVariant("light/clear_margin.wgsl"), cancel)?;
        self.compile_unless_cancelled(&EDGES, cancel)?;
        self.compile_unless_cancelled(
            &DisplayVariant { samples: 1, is_linear: false, is_deep: false },
            cancel,
        )?;
        self.warm_up_passes(&Clipping::default(), cancel)?;
        self.warm_up_soft_light(false, cancel)
    }

    /// Compiles the passes of soft light, by drawing a small volume's first look, with a floor or without.
    fn warm_up_soft_light(&self, has_floor: bool, cancel: &CancelToken) -> Result<(), GpuError> {
        if cancel.is_cancelled() {
            return Ok(());
        }
        let Ok(volume) = builtin("chair", Some(WARM_UP_VOXELS)) else { return Ok(()) };
        let dataset = Dataset::new(volume);
        let mut look = first_look::first_settings(dataset.volume(), dataset.histogram());
        // As many blocks per voxel as in large volumes.
        look.shadows.least_blocks = 1;
        look.floor.on = has_floor;
        let mut renderer = Renderer::with_shaders(&self.context, self.clone())?;
        renderer.draw(&dataset, &look, WARM_UP_SIZE, &RenderOptions::default())
    }

    fn compile_unless_cancelled(
        &self,
        variant: &impl PipelineVariant,
        cancel: &CancelToken,
    ) -> Result<(), GpuError> {
        if !cancel.is_cancelled() {
            self.pipeline(variant)?;
        }
        Ok(())
    }

    /// Compiles variants that the user may need later: the floor, and cuts. To be called on a separate thread while
    /// the program is idle.
    ///
    /// # Errors
    /// Same as [`Self::warm_up`].
    pub fn warm_up_optional(&self, cancel: &CancelToken) -> Result<(), GpuError> {
        for (kernel, _) in KERNELS_AND_SLABS {
            let shadows = ShadowSettings { kernel, ..ShadowSettings::default() };
            let sky = SkySettings { mode: SkyMode::Gradient, ..SkySettings::default() };
            let settings = Settings { shadows, sky, ..Settings::default() };
            self.compile_unless_cancelled(&FloorVariant::from_settings(&settings, FIRST_LIGHTS), cancel)?;
        }
        self.warm_up_soft_light(true, cancel)?;
        let plane = ClipPlane { on: true, ..ClipPlane::default() };
        self.warm_up_passes(&Clipping { plane, ..Clipping::default() }, cancel)
    }

    /// Compiles the passes of a splatted picture, of the whole volume or with cuts.
    fn warm_up_passes(&self, cuts: &Clipping, cancel: &CancelToken) -> Result<(), GpuError> {
        for is_stretched in [false, true] {
            for (kernel, slabs) in KERNELS_AND_SLABS {
                let settings = Settings {
                    sampling: SamplingSettings { kernel, slabs, ..SamplingSettings::default() },
                    shadows: ShadowSettings { kernel, ..ShadowSettings::default() },
                    sky: SkySettings { mode: SkyMode::Gradient, ..SkySettings::default() },
                    cuts: cuts.clone(),
                    ..Settings::default()
                };
                let eye = EyeVariant::from_settings(&settings, FIRST_LIGHTS, is_stretched);
                self.compile_unless_cancelled(&eye.with_gradients(true), cancel)?;
                self.compile_unless_cancelled(
                    &BackprojectVariant::from_shadows(&self.context, &settings.shadows, is_stretched),
                    cancel,
                )?;
                self.compile_unless_cancelled(&MarchVariant::from_settings(&settings, is_stretched), cancel)?;
            }
        }
        Ok(())
    }
}
