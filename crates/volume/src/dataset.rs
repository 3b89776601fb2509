//! Dataset: the fields on one grid, each a volume together with its bricks, cells and histogram.

use std::sync::Arc;

use super::{BrickBounds, Corrections, DensityMapping, Histogram, Volume, VolumeError};

/// Volume of one quantity with the bounds of its bricks and its histogram, which are derived from it and so cannot be
/// combined with those of another volume. Clones share the voxels.
#[derive(Debug, Clone)]
pub struct DatasetField {
    volume: Arc<Volume>,
    bricks: Arc<BrickBounds>,
    histogram: Arc<Histogram>,
}

/// Fields on one grid, of one file. Today there is one, which is shown; a second one would be a second element, and
/// share grid and provenance with the first. Clones share the voxels.
#[derive(Debug, Clone)]
pub struct Dataset {
    /// Fields of the file, never empty; the first one is shown.
    fields: Arc<[DatasetField]>,
}

impl DatasetField {
    /// Computes bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        let volume = volume.into();
        let (bricks, histogram) =
            (Arc::new(BrickBounds::from_volume(&volume)), Arc::new(Histogram::from_volume(&volume)));
        Self { volume, bricks, histogram }
    }

    /// Maps the same voxels to densities in another way, with bounds and histogram of these.
    fn with_density_mapping(&self, shown: DensityMapping) -> Self {
        if shown == self.volume.density_mapping() {
            self.clone()
        } else {
            Self::new(self.volume.with_density_mapping(shown))
        }
    }

    /// Corrects the opened volume; immediate if voxel values are unaffected.
    fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        let volume = self.volume.corrected(by)?;
        if !volume.shares_voxels(&self.volume) {
            return Ok(Self::new(volume));
        }
        let volume = Arc::new(volume.with_density_mapping(self.volume.density_mapping()));
        Ok(Self { volume, ..self.clone() })
    }

    /// Returns the volume of the field: its voxels with grid and provenance.
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

impl Dataset {
    /// Computes bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        Self { fields: Arc::new([DatasetField::new(volume)]) }
    }

    /// Returns the dataset with the shown voxels mapped to densities in another way, and with bounds and histogram of
    /// these.
    #[must_use]
    pub fn with_density_mapping(&self, shown: impl Into<DensityMapping>) -> Self {
        // The quantity belongs to a field: a range of one means nothing for another.
        let field = self.field().with_density_mapping(shown.into());
        Self { fields: std::iter::once(field).chain(self.fields[1..].iter().cloned()).collect() }
    }

    /// Returns the dataset with the opened volume corrected; immediate if voxel values are unaffected.
    ///
    /// # Errors
    /// Fails like [`Volume::corrected`].
    pub fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        // Corrections move the grid, and so apply to every field on it.
        let fields = self.fields.iter().map(|field| field.corrected(by)).collect::<Result<_, _>>()?;
        Ok(Self { fields })
    }

    /// Returns the field that is shown, the only one today.
    pub fn field(&self) -> &DatasetField {
        &self.fields[0]
    }

    /// Returns the volume whose voxels are shown.
    pub fn volume(&self) -> &Arc<Volume> {
        self.field().volume()
    }

    /// Returns the density bounds of bricks of 8³ and cells of 2³ voxels.
    pub fn bricks(&self) -> &Arc<BrickBounds> {
        self.field().bricks()
    }

    /// Returns the histogram of densities.
    pub fn histogram(&self) -> &Arc<Histogram> {
        self.field().histogram()
    }
}
