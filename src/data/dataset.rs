//! A volume together with what follows from its voxels, and from the values that it shows.

use std::sync::Arc;

use super::{Bricks, Corrections, Histogram, Shown, Volume, VolumeError};

/// A volume with the bounds of its bricks and its histogram, which are made from it and cannot be mixed up with
/// those of another. Copies share the voxels.
#[derive(Debug, Clone)]
pub struct Dataset {
    volume: Arc<Volume>,
    bricks: Arc<Bricks>,
    histogram: Arc<Histogram>,
}

impl Dataset {
    /// Finds bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        let volume = volume.into();
        let (bricks, histogram) = (Arc::new(Bricks::of(&volume)), Arc::new(Histogram::of(&volume)));
        Self { volume, bricks, histogram }
    }

    /// The same voxels with densities that stand for something else, and bounds and histogram of these densities.
    #[must_use]
    pub fn showing(&self, shown: impl Into<Shown>) -> Self {
        let shown = shown.into();
        if shown == self.volume.shown() { self.clone() } else { Self::new(self.volume.showing(shown)) }
    }

    /// The volume that was opened, corrected; where its values stay, at once.
    ///
    /// # Errors
    /// As [`Volume::corrected`].
    pub fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let volume = self.volume.corrected(by)?;
        if !volume.shares_voxels(&self.volume) {
            return Ok(Self::new(volume));
        }
        let volume = Arc::new(volume.showing(self.volume.shown()));
        Ok(Self { volume, ..self.clone() })
    }

    /// The voxels.
    pub fn volume(&self) -> &Arc<Volume> {
        &self.volume
    }

    /// Bounds of the density in bricks of 8³ and cells of 2³ voxels.
    pub fn bricks(&self) -> &Arc<Bricks> {
        &self.bricks
    }

    /// How often each density occurs.
    pub fn histogram(&self) -> &Arc<Histogram> {
        &self.histogram
    }
}
