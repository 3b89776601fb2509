//! Settings measured on a downsampled volume: balance and exposure, and a fast variant for drawing.

use super::balance::BrightnessPictures;
use super::small_volume::fast_settings;
use crate::{GpuError, Renderer};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Dataset, Volume};

/// Settings that were measured on a downsampled copy of their volume.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSettings {
    /// Settings for the whole volume, balanced and exposed.
    pub settings: Settings,
    /// Fast variant for drawing the downsampled volume.
    pub fast: Settings,
}

impl MeasuredSettings {
    /// Measures settings of the whole volume on a downsampled copy, which the renderer draws.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn measure(
        renderer: &mut Renderer,
        whole: &Volume,
        small: &Dataset,
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        let mut settings = settings.clone();
        let seen =
            BrightnessPictures::draw(renderer, small, &fast_settings(&settings, whole, small.volume()))?;
        settings.shadows.balance = seen.balance();
        settings.output.exposure = seen.exposure(&settings);
        settings.sanitise();
        Ok(Self::new(whole, small, settings))
    }

    /// Creates the pair of settings for which balance and exposure are known.
    pub fn new(whole: &Volume, small: &Dataset, settings: Settings) -> Self {
        Self { fast: fast_settings(&settings, whole, small.volume()), settings }
    }
}
