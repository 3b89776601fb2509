//! Settings measured on a downsampled volume: balance and exposure, and a fast variant for drawing.

use super::balance::SmallPictures;
use super::measures::exposure_for;
use super::small_volume::quick;
use crate::data::{Dataset, Volume};
use crate::gpu::{GpuError, Renderer};
use crate::model::Settings;

/// Settings that were measured on a downsampled copy of their volume.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallLook {
    /// Settings for the whole volume, balanced and exposed.
    pub settings: Settings,
    /// Fast variant for drawing the downsampled volume.
    pub quick: Settings,
}

impl SmallLook {
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
        let seen = SmallPictures::of(renderer, small, &quick(&settings, whole, small.volume()))?;
        settings.shadows.balance = seen.balance();
        settings.output.exposure = exposure_for(&seen.balanced(settings.shadows.balance));
        settings.sanitise();
        Ok(Self::known(whole, small, settings))
    }

    /// Creates the pair of settings for which balance and exposure are known.
    pub fn known(whole: &Volume, small: &Dataset, settings: Settings) -> Self {
        Self { quick: quick(&settings, whole, small.volume()), settings }
    }
}
