//! Makes the pipelines that the first pictures and previews will need, ahead of time: each can take
//! a driver tens of milliseconds, which a window must not wait for.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::gpu::eye::{floor, gather as eye};
use crate::gpu::light::{backproject as light_backproject, march as light_march};
use crate::gpu::resources::kernel::cut_constant;
use crate::gpu::{GpuError, ShaderLibrary};
use crate::model::{ClipPlane, Cuts, Kernel, Sampling, Settings, Shadows};

/// Lights of a first look, and how many of them cast shadows.
const FIRST_LIGHTS: (usize, usize) = (2, 1);

impl ShaderLibrary {
    /// Makes the usual variants of every shader, until `stop`. To be called on a thread of its own.
    ///
    /// # Errors
    /// When the driver refuses a shader.
    pub fn warm_up(&self, stop: &AtomicBool) -> Result<(), GpuError> {
        for shader in [
            "volume/prefilter.wgsl",
            "volume/downsample.wgsl",
            "volume/gradients.wgsl",
            "output/display.wgsl",
        ] {
            self.warm(shader, &[], stop)?;
        }
        self.warm_up_passes(&Cuts::default(), stop)
    }

    fn warm(&self, shader: &str, constants: &[(&str, f64)], stop: &AtomicBool) -> Result<(), GpuError> {
        if !stop.load(Ordering::Relaxed) {
            self.pipeline(shader, constants)?;
        }
        Ok(())
    }

    /// Makes variants that the user may ask for later: the floor, and what remains after cuts. To be called on a
    /// thread of its own when nothing else is waited for.
    ///
    /// # Errors
    /// As [`Self::warm_up`].
    pub fn warm_up_rest(&self, stop: &AtomicBool) -> Result<(), GpuError> {
        for kernel in [Kernel::Prefiltered, Kernel::BSpline] {
            let shadows = Shadows { kernel, ..Shadows::default() };
            let settings = Settings { shadows, ..Settings::default() };
            self.warm("eye/floor.wgsl", &floor::constants(&settings, FIRST_LIGHTS), stop)?;
        }
        let plane = ClipPlane { on: true, ..ClipPlane::default() };
        self.warm_up_passes(&Cuts { plane, ..Cuts::default() }, stop)
    }

    /// The passes of a splatted picture, of whole volumes or of what remains of them.
    fn warm_up_passes(&self, cuts: &Cuts, stop: &AtomicBool) -> Result<(), GpuError> {
        for flag in [false, true] {
            for kernel in [Kernel::Prefiltered, Kernel::BSpline] {
                let sampling = Sampling { kernel, ..Sampling::default() };
                let mut constants = eye::constants(&sampling, &Shadows::default(), flag, FIRST_LIGHTS);
                constants.push(cut_constant(cuts.seen()));
                // Of stretched kernels only in previews.
                constants.push(eye::gradient_constant(!flag || kernel == Kernel::Prefiltered));
                self.warm("eye/gather.wgsl", &constants, stop)?;
                let shadows = Shadows { kernel, ..Shadows::default() };
                self.warm(
                    "light/backproject.wgsl",
                    &light_backproject::constants(&self.context, &shadows, flag),
                    stop,
                )?;
                let settings = Settings { shadows, cuts: cuts.clone(), ..Settings::default() };
                self.warm("light/march.wgsl", &light_march::constants(&settings, flag), stop)?;
            }
        }
        Ok(())
    }
}
