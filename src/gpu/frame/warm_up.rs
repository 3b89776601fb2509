//! Makes the pipelines that the first pictures and previews will need, ahead of time: each can take
//! a driver tens of milliseconds, which a window must not wait for.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::gpu::eye::floor::FloorVariant;
use crate::gpu::eye::gather::GatherVariant;
use crate::gpu::light::backproject::BackprojectVariant;
use crate::gpu::light::march::MarchVariant;
use crate::gpu::output::display::DisplayVariant;
use crate::gpu::pipelines::variant::{LightCount, Only, Variant};
use crate::gpu::{GpuError, ShaderLibrary};
use crate::model::{ClipPlane, Cuts, Kernel, Sampling, Settings, Shadows, Slabs};

/// Lights of a first look.
const FIRST_LIGHTS: LightCount = LightCount { all: 2, shadowed: 1 };

/// Kernels and slabs of previews and of pictures.
const LOOKS: [(Kernel, Slabs); 2] =
    [(Kernel::Prefiltered, Slabs::Preintegrated), (Kernel::BSpline, Slabs::ByNeed)];

impl ShaderLibrary {
    /// Makes the usual variants of every shader, until `stop`. To be called on a thread of its own.
    ///
    /// # Errors
    /// When the driver refuses a shader.
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

    /// Makes variants that the user may ask for later: the floor, and what remains after cuts. To be called on a
    /// thread of its own when nothing else is waited for.
    ///
    /// # Errors
    /// As [`Self::warm_up`].
    pub fn warm_up_rest(&self, stop: &AtomicBool) -> Result<(), GpuError> {
        for (kernel, _) in LOOKS {
            let shadows = Shadows { kernel, ..Shadows::default() };
            let settings = Settings { shadows, ..Settings::default() };
            self.warm(&FloorVariant::of(&settings, FIRST_LIGHTS), stop)?;
        }
        let plane = ClipPlane { on: true, ..ClipPlane::default() };
        self.warm_up_passes(&Cuts { plane, ..Cuts::default() }, stop)
    }

    /// The passes of a splatted picture, of whole volumes or of what remains of them.
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
