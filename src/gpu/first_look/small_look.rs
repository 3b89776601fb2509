//! A look on a small copy of its volume: how bright it is, and how to draw it quickly.

use super::balance::SmallPictures;
use super::measures::exposure_for;
use super::small_volume::quick;
use crate::data::{Dataset, Volume};
use crate::gpu::{GpuError, Renderer};
use crate::model::Settings;

/// A look that was measured on a small copy of its volume.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallLook {
    /// The look, balanced and exposed.
    pub settings: Settings,
    /// How it is drawn with the copy, quickly.
    pub quick: Settings,
}

impl SmallLook {
    /// Measures a look of a whole volume with a small copy of it, which the renderer shows.
    ///
    /// # Errors
    /// When the GPU cannot do it.
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

    /// A look whose brightness is known.
    pub fn known(whole: &Volume, small: &Dataset, settings: Settings) -> Self {
        Self { quick: quick(&settings, whole, small.volume()), settings }
    }
}
