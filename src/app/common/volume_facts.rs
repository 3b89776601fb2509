//! What the panels and the transfer function editor know of the open volume.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::text::common::LengthUnit;
use crate::app::worker::loader::Reading;
use crate::data::load::Held;
use crate::data::{
    CountedLabel, DataKind, Dataset, Histogram, Shown, ValueRange, ValueRanges, Volume, VoxelType,
};
use crate::math::SceneSpace;
use crate::model::{LabelTable, Settings};

/// Facts about a volume; all of them fixed, but for what of its values is shown.
#[derive(Debug, Clone)]
pub(crate) struct VolumeFacts {
    /// What the user calls it.
    pub name: String,
    /// What was opened: a path or the name of a built-in volume.
    pub source: PathBuf,
    /// How the volume was read.
    pub reading: Reading,
    /// What else the file holds.
    pub held: Held,
    /// Voxels along x, y, z.
    pub dims: [usize; 3],
    /// Voxels along x, y, z in the file, before any were averaged.
    pub file_dims: [usize; 3],
    /// The type of the voxels, such as `uint8`.
    pub voxel_type: &'static str,
    /// The volume, which knows what its file says.
    pub of: Arc<Volume>,
    /// Millimetres between voxel centres along x, y, z.
    pub spacing_mm: [f64; 3],
    /// They are no millimetres: nobody knows how large voxels are.
    pub has_unknown_scale: bool,
    /// All values of the file, and those that matter.
    pub ranges: ValueRanges,
    /// What densities stand for in the picture and in the histogram.
    pub shown: Shown,
    /// The values that the picture shows.
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
    /// The labels of a label map, by number; of other data none.
    pub labels: Arc<[LabelRow]>,
    /// How often each value occurs.
    pub histogram: Arc<Histogram>,
}

/// How many whole numbers there are from one end of a range to the other, however far apart somebody has typed them.
fn levels_in(range: ValueRange) -> usize {
    (range.span() as usize).saturating_add(1)
}

/// A label of the volume.
#[derive(Debug, Clone)]
pub(crate) struct LabelRow {
    /// What voxels hold.
    pub number: i64,
    /// The number whose look it has: its own, unless there are more labels than looks.
    pub stands_for: i64,
    /// How many voxels hold it.
    pub voxels: u64,
    /// What the file calls it; empty if it does not say.
    in_file: String,
}

impl LabelRow {
    /// What a label is called: in the table, or else in the file.
    pub(crate) fn name(&self, table: &LabelTable) -> String {
        let own = table.get(self.number).map_or("", |look| &look.name);
        if own.is_empty() { self.in_file.clone() } else { own.to_owned() }
    }

    /// The labels of a volume that are known, or that it shows.
    fn all_of(volume: &Volume) -> Arc<[Self]> {
        let is_known = matches!(volume.kind().kind, DataKind::LabelMap { .. });
        let Some(labels) = (if is_known { volume.labels() } else { volume.shown_labels() }) else {
            return Arc::default();
        };
        let row = |label: &CountedLabel| Self {
            number: label.number,
            stands_for: labels.standing_for(label.number),
            voxels: label.voxels,
            in_file: volume.hints().labels.get(label.number).map_or_else(String::new, |own| own.name.clone()),
        };
        labels.labels().iter().map(row).collect()
    }
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
            held: volume.held().clone(),
            dims: volume.dims(),
            file_dims: volume.file_dims(),
            voxel_type: voxel_type.name(),
            of: Arc::clone(volume),
            spacing_mm: volume.spacing_mm().into(),
            has_unknown_scale: volume.has_unknown_scale(),
            ranges: volume.ranges(),
            shown: volume.shown(),
            range,
            levels: whole.then(|| levels_in(range)),
            non_finite_voxels: volume.non_finite_voxels(),
            bytes: (volume.voxel_count() * voxel_type.bytes()) as u64,
            scene: volume.scene(),
            kind: volume.kind().kind,
            is_anatomical: volume.is_anatomical(),
            labels: LabelRow::all_of(volume),
            histogram: Arc::clone(dataset.histogram()),
        }
    }

    /// The unit that suits lengths in the scene.
    pub(crate) fn length_unit(&self) -> LengthUnit {
        LengthUnit::of(self.of.length_unit())
    }

    /// The label that voxels of a value hold, in label maps.
    pub(crate) fn label_of(&self, value: f64) -> Option<&LabelRow> {
        self.labels.iter().find(|label| label.number as f64 == value)
    }

    /// Whether pictures with these settings show labels, which have looks by their numbers.
    pub(crate) fn is_shown_by_label(&self, settings: &Settings) -> bool {
        !settings.labels.is_empty() && !self.labels.is_empty()
    }

    /// Takes over what of the values is shown from now on.
    pub(crate) fn follow(&mut self, dataset: &Dataset) {
        let fresh = Self::of(std::mem::take(&mut self.source), std::mem::take(&mut self.reading), dataset);
        *self = fresh;
    }
}

/// Digits behind the point with which values of a range are told apart: a thousand of them, and whole ones of data that
/// have so many.
pub(crate) fn decimals(range: ValueRange) -> usize {
    let span = range.span().abs().max(1e-300);
    (2.0 - span.log10().floor()).clamp(0.0, 6.0) as usize
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
