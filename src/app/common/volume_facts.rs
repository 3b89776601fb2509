//! Facts about the open volume, for the panels and the transfer function editor.

use std::path::PathBuf;
use std::sync::Arc;

use super::alternatives::Alternatives;
use crate::app::text::{self, common::LengthUnit};
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_scene::{LabelTable, Settings};
use chiaroscuro_volume::{
    ChoiceAspect, CountedLabel, DataKind, Dataset, DatasetField, DensityMapping, FieldOrigin, FileContents,
    Histogram, Observer, ValueRange, ValueRanges, Volume, VoxelType, math::SceneSpace,
};

/// Facts about a volume, all fixed except for the range of values that is shown.
#[derive(Debug, Clone)]
pub(crate) struct VolumeFacts {
    /// Name of the volume for display.
    pub name: String,
    /// Path of the file, or name of a built-in volume.
    pub source: PathBuf,
    /// Options with which the volume was read.
    pub reading: ReadChoices,
    /// Series, channels, time steps and components of the file.
    pub held: FileContents,
    /// Number of voxels along x, y and z.
    pub dims: [usize; 3],
    /// Number of voxels along x, y and z in the file, before averaging.
    pub file_dims: [usize; 3],
    /// Name of the voxel type, such as `uint8`.
    pub voxel_type: &'static str,
    /// Volume itself, with the metadata of its file.
    pub volume: Arc<Volume>,
    /// Distance between voxel centres along x, y and z, in mm.
    pub spacing_mm: [f64; 3],
    /// True if the voxel size is unknown, so that the spacing is not in mm.
    pub has_unknown_scale: bool,
    /// Full and robust ranges of the values.
    pub ranges: ValueRanges,
    /// Quantity that densities stand for in the picture and in the histogram.
    pub shown: DensityMapping,
    /// Range of values that the picture shows.
    pub range: ValueRange,
    /// Number of integers in the range shown; `None` for floating-point voxels.
    pub levels: Option<usize>,
    /// Number of voxels that are NaN or infinite.
    pub non_finite_voxels: usize,
    /// Memory of the voxels, in bytes.
    pub bytes: u64,
    /// Placement of the grid in scene space.
    pub scene: SceneSpace,
    /// Kind of data that the volume holds.
    pub kind: DataKind,
    /// True if +x, +y and +z are a body's right, front and head.
    pub is_anatomical: bool,
    /// Labels of a label map, by number; empty for other data.
    pub labels: Arc<[LabelRow]>,
    /// Index of the layer that shows the volume.
    pub layer: usize,
    /// Further volumes that are shown as layers.
    pub further: Vec<FurtherVolume>,
    /// Histogram of the values that are shown.
    pub histogram: Arc<Histogram>,
}

/// Further volume that is shown as a layer.
#[derive(Debug, Clone)]
pub(crate) struct FurtherVolume {
    /// Facts about the volume on the grid of the first one.
    pub facts: VolumeFacts,
    /// Source by which it is opened again.
    pub origin: FieldOrigin,
}

impl FurtherVolume {
    fn new((layer, field): (usize, &DatasetField)) -> Option<Self> {
        let origin = field.origin()?.clone();
        let facts = VolumeFacts::from_field(field, origin.source.clone(), ReadChoices::default());
        Some(Self { facts: VolumeFacts { layer, ..facts }, origin })
    }
}

/// Counts the integers in a range; saturates, since typed ranges may be of any length.
fn levels_in(range: ValueRange) -> usize {
    (range.span() as usize).saturating_add(1)
}

/// Label of the volume, with its number of voxels.
#[derive(Debug, Clone)]
pub(crate) struct LabelRow {
    /// Value of the voxels with this label.
    pub number: i64,
    /// Number of the label whose look it has: its own, unless there are more labels than classes.
    pub look_number: i64,
    /// Number of voxels with this label.
    pub voxels: u64,
    /// Name of the label in the file; empty if there is none.
    in_file: String,
}

impl LabelRow {
    /// Returns the name of the label in the table, or else in the file.
    pub(crate) fn name(&self, table: &LabelTable) -> String {
        let own = table.get(self.number).map_or("", |look| &look.name);
        if own.is_empty() { self.in_file.clone() } else { own.to_owned() }
    }

    /// Lists the labels of a label map, or those by which the volume is shown.
    fn all_of(volume: &Volume) -> Arc<[Self]> {
        let is_known = matches!(volume.kind().kind, DataKind::LabelMap { .. });
        let Some(labels) = (if is_known { volume.labels() } else { volume.shown_labels() }) else {
            return Arc::default();
        };
        let row = |label: &CountedLabel| Self {
            number: label.number,
            look_number: labels.representative_of(label.number),
            voxels: label.voxels,
            in_file: volume
                .metadata()
                .labels
                .get(label.number)
                .map_or_else(String::new, |own| own.name.clone()),
        };
        labels.labels().iter().map(row).collect()
    }
}

/// Value of a voxel in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct VoxelValue {
    /// Number in data units, or number and name of a label.
    pub words: String,
    /// True for a label.
    pub is_label: bool,
}

impl VolumeFacts {
    /// Collects the facts about a dataset.
    pub(crate) fn new(source: PathBuf, reading: ReadChoices, dataset: &Dataset) -> Self {
        let further = dataset.fields().iter().enumerate().skip(1).filter_map(FurtherVolume::new).collect();
        Self { further, ..Self::from_field(dataset.field(), source, reading) }
    }

    /// Collects the facts about one field of a dataset.
    fn from_field(field: &DatasetField, source: PathBuf, reading: ReadChoices) -> Self {
        let volume = field.volume();
        let voxel_type = volume.samples().voxel_type();
        let range = volume.shown_range();
        let whole = !matches!(voxel_type, VoxelType::F32 | VoxelType::F64);
        Self {
            name: volume.name().to_owned(),
            source,
            reading,
            held: volume.contents().clone(),
            dims: volume.dims(),
            file_dims: volume.file_dims(),
            voxel_type: voxel_type.name(),
            volume: Arc::clone(volume),
            spacing_mm: volume.spacing_mm().into(),
            has_unknown_scale: volume.has_unknown_scale(),
            ranges: volume.ranges(),
            shown: volume.density_mapping(),
            range,
            levels: whole.then(|| levels_in(range)),
            non_finite_voxels: volume.non_finite_voxels(),
            bytes: (volume.voxel_count() * voxel_type.bytes()) as u64,
            scene: volume.scene(),
            kind: volume.kind().kind,
            is_anatomical: volume.is_anatomical(),
            labels: LabelRow::all_of(volume),
            layer: 0,
            further: Vec::new(),
            histogram: Arc::clone(field.histogram()),
        }
    }

    /// Returns the facts about the volume of a layer, or about the first one if there is no such layer.
    pub(crate) fn of_layer(&self, layer: usize) -> &Self {
        let further = layer.checked_sub(1).and_then(|at| self.further.get(at));
        further.map_or(self, |further| &further.facts)
    }

    /// Returns true if all volumes are shown with the value ranges that a dataset has.
    pub(crate) fn shows_ranges_of(&self, dataset: &Dataset) -> bool {
        let fields = dataset.fields().iter().enumerate();
        let is_same = |(layer, field): (usize, &DatasetField)| {
            self.of_layer(layer).shown == field.volume().density_mapping()
        };
        fields.clone().count() == self.further.len() + 1 && fields.into_iter().all(is_same)
    }

    /// Name of the channel or component that is shown, or else of the volume.
    pub(crate) fn part_name(&self) -> String {
        let mut parts = ChoiceAspect::SHOWN_TOGETHER.into_iter().filter_map(|aspect| {
            Alternatives::new(&self.held, aspect).filter(|all| aspect.is_shown_together(all.count()))
        });
        parts.next_back().map_or_else(|| self.name.clone(), |all| all.name(all.current()))
    }

    /// Unit of length that suits the size of the volume.
    pub(crate) fn length_unit(&self) -> LengthUnit {
        LengthUnit::from_spacing_unit(self.volume.length_unit())
    }

    /// Finds the label of the voxels with a value, in label maps.
    pub(crate) fn label_of(&self, value: f64) -> Option<&LabelRow> {
        self.labels.iter().find(|label| label.number as f64 == value)
    }

    /// Returns true if pictures with these settings show labels, whose looks are in a table.
    pub(crate) fn is_shown_by_label(&self, settings: &Settings) -> bool {
        !settings.layer_at(self.layer).labels.is_empty() && !self.labels.is_empty()
    }

    /// Returns the value at a voxel, or its label if labels are shown; `None` where the voxel is missing, or has a label
    /// without a look, which is the background.
    pub(crate) fn value_at(&self, settings: &Settings, [x, y, z]: [usize; 3]) -> Option<VoxelValue> {
        let [nx, ny, _] = self.dims;
        if self.volume.presence_for(Observer::Eye, x + nx * (y + ny * z)) <= 0.0 {
            return None;
        }
        let value = self.volume.value(x, y, z);
        if !self.is_shown_by_label(settings) {
            let words = text::probe::number(value, range_decimals(self.volume.table_range()));
            return Some(VoxelValue { words, is_label: false });
        }
        let (label, table) = (self.label_of(value)?, &settings.layer_at(self.layer).labels);
        table.get(label.look_number)?;
        Some(VoxelValue { words: text::probe::label(label.number, &label.name(table)), is_label: true })
    }

    /// Updates the facts for a dataset that shows other values or is corrected.
    pub(crate) fn update(&mut self, dataset: &Dataset) {
        let fresh = Self::new(std::mem::take(&mut self.source), std::mem::take(&mut self.reading), dataset);
        *self = fresh;
    }
}

/// Number of decimals, 0 to 6, that resolves a range into 100 to 1000 steps; ranges of at least 100 have whole
/// numbers.
pub(crate) fn range_decimals(range: ValueRange) -> usize {
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
