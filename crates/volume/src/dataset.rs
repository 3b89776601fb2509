//! Dataset: a volume together with its bricks, cells and histogram.

use std::sync::Arc;

use super::{BrickBounds, Corrections, DensityMapping, Histogram, Volume, VolumeError};

/// Volume with the bounds of its bricks and its histogram, which are derived from it and so cannot be combined with
/// those of another volume. Clones share the voxels.
#[derive(Debug, Clone)]
pub struct Dataset {
    volume: Arc<Volume>,
    bricks: Arc<BrickBounds>,
    histogram: Arc<Histogram>,
}

impl Dataset {
    /// Computes bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        let volume = volume.into();
        let (bricks, histogram) =
            (Arc::new(BrickBounds::from_volume(&volume)), Arc::new(Histogram::from_volume(&volume)));
        Self { volume, bricks, histogram }
    }

    /// Returns the dataset with the same voxels mapped to densities in another way, and with bounds and histogram of
    /// these.
    #[must_use]
    pub fn with_density_mapping(&self, shown: impl Into<DensityMapping>) -> Self {
        let shown = shown.into();
        if shown == self.volume.density_mapping() {
            self.clone()
        } else {
            Self::new(self.volume.with_density_mapping(shown))
        }
    }

    /// Returns the dataset with the opened volume corrected; immediate if voxel values are unaffected.
    ///
    /// # Errors
    /// Fails like [`Volume::corrected`].
    pub fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let volume = self.volume.corrected(by)?;
        if !volume.shares_voxels(&self.volume) {
            return Ok(Self::new(volume));
        }
        let volume = Arc::new(volume.with_density_mapping(self.volume.density_mapping()));
        Ok(Self { volume, ..self.clone() })
    }

    /// Returns the volume whose voxels are shown.
    pub fn volume(&self) -> &Arc<Volume> {
        &self.volume
    }

    /// Returns the density bounds of bricks of 8³ and cells of 2³ voxels.
    pub fn bricks(&self) -> &Arc<BrickBounds> {
        &self.bricks
    }

    /// Returns the histogram of densities.
    pub fn histogram(&self) -> &Arc<Histogram> {
        &self.histogram
    }
}
