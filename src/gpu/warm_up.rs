//! Makes the pipelines that the first pictures and previews will need, ahead of time: each can take
//! a driver tens of milliseconds, which a window must not wait for.

use super::kernel::cut_constant;
use super::{GpuError, ShaderLibrary, eye, light_backproject, light_march};
use crate::model::{Kernel, Remains, Sampling, Settings, Shadows};

/// Lights of a first look, and how many of them cast shadows.
const FIRST_LIGHTS: (usize, usize) = (2, 1);

impl ShaderLibrary {
    /// Makes the usual variants of every shader. To be called on a thread of its own.
    ///
    /// # Errors
    /// When the driver refuses a shader.
    pub fn warm_up(&self) -> Result<(), GpuError> {
        for shader in ["prefilter.wgsl", "downsample.wgsl", "gradients.wgsl", "display.wgsl"] {
            self.pipeline(shader, &[])?;
        }
        let (lights, shadowed) = FIRST_LIGHTS;
        for flag in [false, true] {
            for kernel in [Kernel::Prefiltered, Kernel::BSpline] {
                let sampling = Sampling { kernel, ..Sampling::default() };
                let mut constants = eye::constants(&sampling, &Shadows::default(), flag, (lights, shadowed));
                // Of stretched kernels only in previews.
                constants.push(cut_constant(Remains::default()));
                constants.push(eye::gradient_constant(!flag || kernel == Kernel::Prefiltered));
                self.pipeline("eye.wgsl", &constants)?;
                let shadows = Shadows { kernel, ..Shadows::default() };
                self.pipeline("light_backproject.wgsl", &light_backproject::constants(&shadows, flag))?;
                let settings = Settings { shadows, ..Settings::default() };
                self.pipeline("light_march.wgsl", &light_march::constants(&settings, flag))?;
            }
        }
        Ok(())
    }
}
