//! Key of the displayed picture, apart from its linear light.

use crate::plan::{PixelWindow, RenderOptions, RenderRequest};
use chiaroscuro_scene::{Background, OutputSettings, PixelFormat, ToneMap};

/// Inputs of the conversion from linear light to the displayed picture: nothing else depends on them, so that a
/// change costs only one display pass.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayKey {
    background: Background,
    tone_map: ToneMap,
    output_exposure: f64,
    transparent: bool,
    exposure: f32,
    /// Displayed part; background gradients span the whole picture.
    shown: PixelWindow,
    samples: u32,
    depth: PixelFormat,
}

impl DisplayKey {
    /// Creates the key of the displayed picture of a request.
    pub fn new(request: &RenderRequest, options: &RenderOptions) -> Self {
        let OutputSettings {
            background,
            tone_map,
            exposure: output_exposure,
            // The request's options say how many rays a picture has.
            antialiasing: _,
        } = request.settings.output;
        Self {
            background,
            tone_map,
            output_exposure,
            transparent: options.picture.transparent,
            exposure: options.picture.exposure,
            shown: options.displayed_window(request),
            samples: options.picture.samples,
            depth: options.picture.depth,
        }
    }

    /// Returns the key with another exposure.
    #[must_use]
    pub fn with_exposure(self, exposure: f32) -> Self {
        Self { exposure, ..self }
    }
}
