//! Description of an image that is written in several resolutions.

use super::ExportVolume;
use chiaroscuro_volume::{FileLabelTable, SpacingUnit, ValueMeaning, VoxelType};

/// Description of an image: grid, place, numbers and labels.
#[derive(Debug, Clone, PartialEq)]
pub struct PyramidSpec {
    pub(super) name: String,
    /// Voxels along x, y, z.
    pub(super) dims: [usize; 3],
    pub(super) voxel_type: VoxelType,
    /// Distances between voxels along x, y, z, in the unit.
    pub(super) spacing: [f64; 3],
    /// Place of the centre of the first voxel, in the unit.
    pub(super) translation: [f64; 3],
    /// Unit of lengths, if it is known.
    pub(super) unit: Option<SpacingUnit>,
    /// Number of missing voxels, which is left out of means.
    pub(super) padding: Option<f64>,
    /// True if the coarser levels have the most frequent number of a block, not its mean.
    pub(super) has_label_numbers: bool,
    /// Names and colours of labels, if the volume is known to hold labels.
    pub(super) labels: Option<FileLabelTable>,
}

impl PyramidSpec {
    /// Creates the description of a volume as it is exported.
    pub fn new(volume: &ExportVolume<'_>) -> Self {
        let unit = Some(volume.length_unit()).filter(|_| !volume.has_unknown_scale());
        let unit_mm = unit.map_or(1.0, SpacingUnit::mm);
        let translation = volume.world_from_index().translation;
        let translation = if volume.is_axis_aligned() { translation.to_array() } else { [0.0; 3] };
        let hints = volume.hints();
        let is_stated = hints.meaning == ValueMeaning::Labels || !hints.labels.is_empty();
        Self {
            name: volume.name().to_owned(),
            dims: volume.dims(),
            voxel_type: volume.voxel_type(),
            spacing: volume.spacing_mm().map(|length| length / unit_mm),
            // Without the sign of a negative zero.
            translation: translation.map(|length| length / unit_mm + 0.0),
            unit,
            padding: hints.padding,
            has_label_numbers: volume.is_label_map(),
            labels: is_stated.then(|| hints.labels.clone()),
        }
    }

    /// Creates the description of a volume of which only the first slices are read, and `overview` some voxels of the
    /// whole, by which missing voxels and labels are known.
    #[must_use]
    pub fn with_whole(self, depth: usize, overview: &ExportVolume<'_>) -> Self {
        let Self { dims: [width, height, _], .. } = self;
        Self {
            dims: [width, height, depth],
            padding: overview.hints().padding,
            has_label_numbers: overview.is_label_map(),
            ..self
        }
    }

    /// Number of a voxel in little-endian bytes of which nothing is stored.
    pub(super) fn fill(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        super::append_number(&mut bytes, self.voxel_type, self.padding.unwrap_or(0.0));
        bytes
    }
}
