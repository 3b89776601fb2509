//! Pre-compilation of the pipelines for the first pictures and previews: each can take a driver tens of milliseconds,
//! which would stall the window.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::gpu::eye::floor::FloorVariant;
use crate::gpu::eye::gather::GatherVariant;
use crate::gpu::light::backproject::BackprojectVariant;
use crate::gpu::light::march::MarchVariant;
use crate::gpu::output::display::DisplayVariant;
use crate::gpu::pipelines::variant::{LightCount, Only, Variant};
use crate::gpu::{GpuError, ShaderLibrary};
use crate::model::{ClipPlane, Cuts, Kernel, Sampling, Settings, Shadows, Slabs};

/// Number of lights in a first look.
const FIRST_LIGHTS: LightCount = LightCount { all: 2, shadowed: 1 };

/// Kernels and slabs of previews and of pictures.
const LOOKS: [(Kernel, Slabs); 2] =
    [(Kernel::Prefiltered, Slabs::Preintegrated), (Kernel::BSpline, Slabs::ByNeed)];

impl ShaderLibrary {
    /// Compiles the usual variants of every shader, until `stop` is set. To be called on a separate thread.
    ///
    /// # Errors
    /// Returns an error if the driver rejects a shader.
    pub fn warm_up(&self, stop: &AtomicBool) -> Result<(), GpuError> {
        for shader in ["volume/prefilter.wgsl", "volume/downsample.wgsl", "volume/gradients.wgsl"] {
            self.warm(&Only(shader), stop)?;
        }
        self.warm(&Only("light/clear_margin.wgsl"), stop)?;
        self.warm(&DisplayVariant { samples: 1, is_linear: false, is_deep: false }, stop)?;
        self.warm_up_passes(&Cuts::default(), stop)
    }

    fn warm(&self, variant: &impl Variant, stop: &AtomicBool) -> Result<(), GpuError> {
        if !stop.load(Ordering::Relaxed) {
            self.pipeline(variant)?;
        }
        Ok(())
    }

    /// Compiles variants that the user may need later: the floor, and cuts. To be called on a separate thread while
    /// the program is idle.
    ///
    /// # Errors
    /// Same as [`Self::warm_up`].
    pub fn warm_up_rest(&self, stop: &AtomicBool) -> Result<(), GpuError> {
        for (kernel, _) in LOOKS {
            let shadows = Shadows { kernel, ..Shadows::default() };
            let settings = Settings { shadows, ..Settings::default() };
            self.warm(&FloorVariant::of(&settings, FIRST_LIGHTS), stop)?;
        }
        let plane = ClipPlane { on: true, ..ClipPlane::default() };
        self.warm_up_passes(&Cuts { plane, ..Cuts::default() }, stop)
    }

    /// Compiles the passes of a splatted picture, of the whole volume or with cuts.
    fn warm_up_passes(&self, cuts: &Cuts, stop: &AtomicBool) -> Result<(), GpuError> {
        for is_stretched in [false, true] {
            for (kernel, slabs) in LOOKS {
                let settings = Settings {
                    sampling: Sampling { kernel, slabs, ..Sampling::default() },
                    shadows: Shadows { kernel, ..Shadows::default() },
                    cuts: cuts.clone(),
                    ..Settings::default()
                };
                let eye = GatherVariant::of(&settings, FIRST_LIGHTS, is_stretched);
                self.warm(&eye.with_gradients(true), stop)?;
                self.warm(&BackprojectVariant::of(&self.context, &settings.shadows, is_stretched), stop)?;
                self.warm(&MarchVariant::of(&settings, is_stretched), stop)?;
            }
        }
        Ok(())
    }
}
