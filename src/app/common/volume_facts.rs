//! What the panels and the transfer function editor know of the open volume.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::worker::loader::Reading;
use crate::data::{DataKind, Dataset, Histogram, ValueRange, ValueRanges, VoxelType};
use crate::math::SceneSpace;

/// Facts about a volume; all of them fixed, but for what of its values is shown.
#[derive(Debug, Clone)]
pub(crate) struct VolumeFacts {
    /// What the user calls it.
    pub name: String,
    /// What was opened: a path or the name of a built-in volume.
    pub source: PathBuf,
    /// How the volume was read.
    pub reading: Reading,
    /// Voxels along x, y, z.
    pub dims: [usize; 3],
    /// Voxels along x, y, z in the file, before any were averaged.
    pub file_dims: [usize; 3],
    /// The type of the voxels, such as `uint8`.
    pub voxel_type: &'static str,
    /// Millimetres between voxel centres along x, y, z.
    pub spacing_mm: [f64; 3],
    /// All values of the file, and those that matter.
    pub ranges: ValueRanges,
    /// The values that the picture shows, which the histogram counts.
    pub range: ValueRange,
    /// How many different values there can be, for integers.
    pub levels: Option<usize>,
    /// Voxels that are not finite.
    pub non_finite_voxels: usize,
    /// Bytes of the voxels.
    pub bytes: u64,
    /// How the grid lies in scene space.
    pub scene: SceneSpace,
    /// What kind of data it holds.
    pub kind: DataKind,
    /// Whether +x, +y and +z are a body's right, front and head.
    pub is_anatomical: bool,
    /// How often each value occurs.
    pub histogram: Arc<Histogram>,
}

/// How many whole numbers there are from one end of a range to the other, however far apart somebody has typed them.
fn levels_in(range: ValueRange) -> usize {
    (range.span() as usize).saturating_add(1)
}

impl VolumeFacts {
    /// Collects the facts.
    pub(crate) fn of(source: PathBuf, reading: Reading, dataset: &Dataset) -> Self {
        let volume = dataset.volume();
        let voxel_type = volume.samples().voxel_type();
        let range = volume.shown_range();
        let whole = !matches!(voxel_type, VoxelType::F32 | VoxelType::F64);
        Self {
            name: volume.name().to_owned(),
            source,
            reading,
            dims: volume.dims(),
            file_dims: volume.file_dims(),
            voxel_type: voxel_type.name(),
            spacing_mm: volume.spacing_mm().into(),
            ranges: volume.ranges(),
            range,
            levels: whole.then(|| levels_in(range)),
            non_finite_voxels: volume.non_finite_voxels(),
            bytes: (volume.voxel_count() * voxel_type.bytes()) as u64,
            scene: volume.scene(),
            kind: volume.kind().kind,
            is_anatomical: volume.is_anatomical(),
            histogram: Arc::clone(dataset.histogram()),
        }
    }

    /// Takes over what of the values is shown from now on.
    pub(crate) fn follow(&mut self, dataset: &Dataset) {
        let fresh = Self::of(std::mem::take(&mut self.source), self.reading, dataset);
        *self = fresh;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_levels_however_long_they_are() {
        assert_eq!(levels_in(ValueRange::new(0.0, 255.0)), 256);
        assert_eq!(levels_in(ValueRange::new(-1e300, 1e300)), usize::MAX);
        assert_eq!(levels_in(ValueRange::new(f64::MIN, f64::MAX)), usize::MAX);
    }
}
