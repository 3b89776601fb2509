//! What the shown picture is made from, besides its linear light.

use crate::model::{Depth, Output};
use crate::plan::{PixelWindow, RenderOptions, Request};

/// Everything that turns linear light into what is shown: nothing else depends on it, so that a change of it costs
/// one display pass.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayKey {
    output: Output,
    transparent: bool,
    exposure: f32,
    /// Background gradients span the whole picture.
    shown: PixelWindow,
    samples: u32,
    depth: Depth,
}

impl DisplayKey {
    /// The key of what a request shows.
    pub fn of(request: &Request, options: &RenderOptions) -> Self {
        Self {
            output: request.settings.output.clone(),
            transparent: options.transparent,
            exposure: options.exposure,
            shown: options.shown(request),
            samples: options.samples,
            depth: options.depth,
        }
    }

    /// What the same request shows with another exposure.
    #[must_use]
    pub fn exposed(self, exposure: f32) -> Self {
        Self { exposure, ..self }
    }
}
