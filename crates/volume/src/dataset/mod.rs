//! Dataset: the fields on one grid, each a volume together with its bricks, cells and histogram.

mod error;

use std::path::PathBuf;
use std::sync::Arc;

pub use error::{AddFieldError, StepError};

use super::{
    BrickBounds, Corrections, DensityMapping, Histogram, MAX_FIELDS, PageCache, PageSource, PagesId,
    ResidentPages, ValueRanges, Volume, VolumeChoice, VolumeError, VolumeId, VoxelMask,
};

/// Volume of one quantity with the bounds of its bricks and its histogram, which are derived from it and so cannot be
/// combined with those of another volume. Clones share the voxels.
#[derive(Debug, Clone)]
pub struct DatasetField {
    volume: Arc<Volume>,
    bricks: Arc<BrickBounds>,
    histogram: Arc<Histogram>,
    /// Source of a further field; that of the first one is known to its scene.
    origin: Option<Arc<FieldOrigin>>,
}

/// Source of a field of a dataset, by which it can be opened again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldOrigin {
    /// Path of the file, or `builtin:NAME`.
    pub source: PathBuf,
    /// Content ID of the volume as it was opened, before it was resampled.
    pub opened_id: u64,
    /// Selected volume, if the file has several.
    pub choice: VolumeChoice,
}

/// Fields on one grid, of one or of several files. Clones share the voxels.
#[derive(Debug, Clone)]
pub struct Dataset {
    /// Fields, 1 … [`MAX_FIELDS`]; the first one has the grid, the corrections and the metadata of the scene.
    fields: Arc<[DatasetField]>,
    /// Pages of levels that are finer than the first field.
    pages: Option<Arc<ResidentPages>>,
}

impl DatasetField {
    /// Computes bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        let volume = volume.into();
        let (bricks, histogram) =
            (Arc::new(BrickBounds::from_volume(&volume)), Arc::new(Histogram::from_volume(&volume)));
        Self { volume, bricks, histogram, origin: None }
    }

    /// Maps the same voxels to densities in another way, with bounds and histogram of these.
    fn with_density_mapping(&self, shown: DensityMapping) -> Self {
        if shown == self.volume.density_mapping() {
            self.clone()
        } else {
            Self { origin: self.origin.clone(), ..Self::new(self.volume.with_density_mapping(shown)) }
        }
    }

    /// Counts as having other ranges of values; densities represent the robust one, unless they represent labels.
    fn with_ranges(&self, ranges: ValueRanges) -> Self {
        let volume = self.volume.as_ref().clone().with_ranges(ranges);
        let shown = match volume.density_mapping() {
            DensityMapping::Range(_) => DensityMapping::Range(ranges.robust),
            DensityMapping::Labels => DensityMapping::Labels,
        };
        Self { volume: Arc::new(volume), ..self.clone() }.with_density_mapping(shown)
    }

    /// Hides voxels by a mask, with the cells that are left.
    fn with_mask(&self, mask: Option<&Arc<VoxelMask>>) -> Self {
        if self.volume.mask().is_none() && mask.is_none() {
            return self.clone();
        }
        let volume = self.volume.with_mask(mask.cloned());
        Self {
            bricks: Arc::new(self.bricks.with_presence_of(&volume)),
            volume: Arc::new(volume),
            ..self.clone()
        }
    }

    /// Corrects the opened volume; immediate if voxel values are unaffected.
    fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        // The next picture hides voxels again, where they are then.
        let whole = self.with_mask(None);
        let volume = whole.volume.corrected(by)?;
        if !volume.shares_voxels(&whole.volume) {
            return Ok(Self { origin: whole.origin, ..Self::new(volume) });
        }
        let volume = Arc::new(volume.with_density_mapping(whole.volume.density_mapping()));
        Ok(Self { volume, ..whole })
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

    /// Returns the source of a further field.
    pub fn origin(&self) -> Option<&FieldOrigin> {
        self.origin.as_deref()
    }
}

impl Dataset {
    fn from_fields(fields: impl IntoIterator<Item = DatasetField>) -> Self {
        Self { fields: fields.into_iter().collect(), pages: None }
    }

    /// Computes bounds and histogram of a volume: about a second for 512³ voxels.
    pub fn new(volume: impl Into<Arc<Volume>>) -> Self {
        Self::from_fields([DatasetField::new(volume)])
    }

    /// Returns the dataset with the voxels of the first field mapped to densities in another way, and with bounds and
    /// histogram of these.
    #[must_use]
    pub fn with_density_mapping(&self, shown: impl Into<DensityMapping>) -> Self {
        self.with_density_mappings([shown.into()])
    }

    /// Returns the dataset with the voxels of its first fields mapped to densities in other ways, one for each field.
    #[must_use]
    pub fn with_density_mappings(&self, shown: impl IntoIterator<Item = DensityMapping>) -> Self {
        // The quantity belongs to a field: a range of one means nothing for another.
        let mut shown = shown.into_iter();
        let mapped = |field: &DatasetField| {
            shown.next().map_or_else(|| field.clone(), |shown| field.with_density_mapping(shown))
        };
        Self::from_fields(self.fields.iter().map(mapped)).with_pages(self.pages.clone())
    }

    /// Returns the dataset with voxels of all fields hidden by a mask, in place of an earlier one ([`Volume::with_mask`]).
    #[must_use]
    pub fn with_mask(&self, mask: Option<&Arc<VoxelMask>>) -> Self {
        self.with_mask_where(mask, |_| true)
    }

    /// Returns the dataset with voxels hidden by a mask as [`Self::with_mask`] does, in those fields with an index for which
    /// `hides` is true.
    #[must_use]
    pub fn with_mask_where(&self, mask: Option<&Arc<VoxelMask>>, hides: impl Fn(usize) -> bool) -> Self {
        let fields = self.fields.iter().enumerate();
        let hidden = fields.map(|(at, field)| field.with_mask(mask.filter(|_| hides(at))));
        Self::from_fields(hidden).with_pages(self.pages.clone())
    }

    /// Returns the dataset with the opened volume corrected; immediate if voxel values are unaffected.
    ///
    /// # Errors
    /// Fails like [`Volume::corrected`].
    pub fn corrected(&self, by: &Corrections) -> Result<Self, VolumeError> {
        // Corrections of the grid apply to every field on it, those of values to the file that they are of.
        let of_grid = by.of_grid();
        let corrected =
            |(index, field): (usize, &DatasetField)| field.corrected(if index == 0 { by } else { &of_grid });
        Ok(Self::from_fields(self.fields.iter().enumerate().map(corrected).collect::<Result<Vec<_>, _>>()?))
    }

    /// Returns the dataset with another time step of the same object, with the corrections, the ranges of values and the kind
    /// of data that this one has, so that it looks the same. Fields of which no step is given stay.
    ///
    /// # Arguments
    /// * `first`: step of the first field, as it was opened.
    /// * `further`: steps of further fields, each with the index of its field.
    ///
    /// # Errors
    /// Fails like [`Volume::corrected`], and if further fields do not meet the grid of the first.
    pub fn with_step(&self, first: &Volume, mut further: Vec<(usize, Volume)>) -> Result<Self, StepError> {
        let shown = self.volume();
        let by = shown.corrections();
        let mut fields = vec![DatasetField::new(first.corrected(by)?.with_look_of(shown))];
        for (index, field) in self.fields.iter().enumerate().skip(1) {
            let volume = field.volume();
            let step = further.iter().position(|(at, _)| *at == index).map(|at| further.swap_remove(at).1);
            let Some(step) = step else {
                if volume.has_grid_of(fields[0].volume()) {
                    fields.push(field.clone());
                } else {
                    let placed = volume.on_grid_of(fields[0].volume()).ok_or(StepError::Apart)?;
                    fields.push(Self::step_of_field(field, placed, field.origin.clone()));
                }
                continue;
            };
            let (opened_id, choice) = (step.opened_id(), step.contents().choice());
            let origin = field.origin().map(|origin| FieldOrigin { opened_id, choice, ..origin.clone() });
            // Grids are compared as they were opened, and corrected together.
            let placed = step.on_grid_of(first).ok_or(StepError::Apart)?.corrected(&by.of_grid())?;
            fields.push(Self::step_of_field(field, placed, origin.map(Arc::new)));
        }
        Ok(Self::from_fields(fields))
    }

    /// Creates another time step of a field, from a volume on the grid of the first.
    fn step_of_field(shown: &DatasetField, step: Volume, origin: Option<Arc<FieldOrigin>>) -> DatasetField {
        DatasetField { origin, ..DatasetField::new(step.with_look_of(shown.volume())) }
    }

    /// Returns the dataset with other ranges of values of its first field, as those of all time steps; densities represent
    /// the robust one, unless they represent labels.
    #[must_use]
    pub fn with_ranges(&self, ranges: ValueRanges) -> Self {
        self.with_ranges_of(0, ranges)
    }

    /// Returns the dataset with other ranges of values of the field with this index, as [`Self::with_ranges`] does.
    #[must_use]
    pub fn with_ranges_of(&self, index: usize, ranges: ValueRanges) -> Self {
        let changed = |(at, field): (usize, &DatasetField)| {
            if at == index { field.with_ranges(ranges) } else { field.clone() }
        };
        Self::from_fields(self.fields.iter().enumerate().map(changed))
    }

    /// Creates a dataset of volumes on one grid, the first of which is the one of the scene; at most [`MAX_FIELDS`] of
    /// them, and only those that have its dimensions.
    pub fn from_volumes(first: Volume, further: impl IntoIterator<Item = Volume>) -> Self {
        let dims = first.dims();
        let others = further.into_iter().filter(|volume| volume.dims() == dims).take(MAX_FIELDS - 1);
        Self::from_fields(std::iter::once(first).chain(others).map(DatasetField::new))
    }

    /// Adds a volume from a source as the last field, resampled to the grid of the first one where its own differs.
    ///
    /// # Errors
    /// Fails if there are [`MAX_FIELDS`] fields, or the two grids do not meet.
    pub fn with_field(&self, volume: &Volume, source: impl Into<PathBuf>) -> Result<Self, AddFieldError> {
        if self.fields.len() == MAX_FIELDS {
            return Err(AddFieldError::TooMany);
        }
        let origin = FieldOrigin {
            source: source.into(),
            opened_id: volume.opened_id(),
            choice: volume.contents().choice(),
        };
        let volume = volume.on_grid_of(self.volume()).ok_or(AddFieldError::Apart)?;
        let field = DatasetField { origin: Some(Arc::new(origin)), ..DatasetField::new(volume) };
        Ok(Self::from_fields(self.fields.iter().cloned().chain([field])))
    }

    /// Removes all fields but those with an index for which `keeps` is true; never the first.
    #[must_use]
    pub fn with_fields_where(&self, keeps: impl Fn(usize) -> bool) -> Self {
        let fields = self.fields.iter().enumerate().filter(|(index, _)| *index == 0 || keeps(*index));
        Self::from_fields(fields.map(|(_, field)| field.clone())).with_pages(self.pages.clone())
    }

    /// Replaces the further fields by others that were added to this dataset before, with its corrections of positions.
    #[must_use]
    pub fn with_further(&self, further: impl IntoIterator<Item = DatasetField>) -> Self {
        let by = self.volume().corrections().of_grid();
        // The first field has the same grid, so that what could be corrected for it can be for the others.
        let placed = |field: DatasetField| {
            let is_placed = *field.volume().corrections() == by;
            if is_placed { field } else { field.corrected(&by).unwrap_or(field) }
        };
        let first = std::iter::once(self.field().clone());
        Self::from_fields(first.chain(further.into_iter().map(placed)).take(MAX_FIELDS))
    }

    /// Returns the sources of the further fields.
    pub fn further_origins(&self) -> impl Iterator<Item = &FieldOrigin> {
        self.fields[1..].iter().filter_map(DatasetField::origin)
    }

    /// Returns all fields, the first of which has the grid of the scene.
    pub fn fields(&self) -> &Arc<[DatasetField]> {
        &self.fields
    }

    /// Returns the identity by which pictures of the dataset are cached: that of its volume if there is one field.
    pub fn id(&self) -> VolumeId {
        let mut id = self.volume().id();
        for (further, field) in id.further_ranges.iter_mut().zip(&self.fields[1..]) {
            let volume = field.volume();
            id.content_id = id.content_id.rotate_left(17) ^ volume.content_id();
            *further = Some(volume.ranges());
        }
        id.pages = self.pages().map_or_else(PagesId::default, |pages| pages.id());
        id
    }

    /// Returns the dataset with pages of levels that are finer than its first field.
    #[must_use]
    pub fn with_pages(self, pages: Option<Arc<ResidentPages>>) -> Self {
        Self { pages, ..self }
    }

    /// Creates a cache of pages for the first field, of at most `bytes`.
    pub fn page_cache(&self, source: Arc<dyn PageSource>, bytes: u64) -> PageCache {
        PageCache::new(source, self.volume().density_mapping(), Arc::clone(self.bricks()), bytes)
    }

    /// Returns the pages of finer levels, if there are some whose densities represent what those of the first field do.
    pub fn pages(&self) -> Option<&Arc<ResidentPages>> {
        self.pages.as_ref().filter(|pages| pages.mapping() == self.volume().density_mapping())
    }

    /// Returns the first field, which has the grid of the scene.
    pub fn field(&self) -> &DatasetField {
        &self.fields[0]
    }

    /// Returns the volume of the first field.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    fn ramp(name: &str, slope: u8) -> Volume {
        let values = (0..64).map(|at| slope * at).collect();
        Volume::with_spacing(name, [4; 3], DVec3::ONE, Samples::U8(values)).unwrap()
    }

    #[test]
    fn further_fields_come_back_with_the_corrections_of_the_first() {
        let first = Dataset::new(ramp("a", 1));
        let all = first.with_field(&ramp("b", 2), "b").unwrap().with_field(&ramp("c", 3), "c").unwrap();
        let names = |dataset: &Dataset| {
            dataset.further_origins().map(|origin| origin.source.clone()).collect::<Vec<_>>()
        };
        let last = all.with_further([all.fields()[2].clone()]);
        assert_eq!(names(&last), [PathBuf::from("c")]);
        assert_eq!(
            last.id(),
            first.with_field(&ramp("c", 3), "c").unwrap().id(),
            "as if b had never been added"
        );
        let by = Corrections { spacing: Some([2.0; 3]), ..Corrections::default() };
        let back = last.corrected(&by).unwrap().with_further(all.fields()[1..].iter().cloned());
        assert_eq!(back.id(), all.corrected(&by).unwrap().id());
    }
    #[test]
    fn time_steps_look_like_the_volume_that_is_shown() {
        let spaced = Corrections { spacing: Some([2.0; 3]), ..Corrections::default() };
        let shown = Dataset::new(ramp("a", 4)).with_field(&ramp("b", 2), "b").unwrap();
        let shown = shown.with_field(&ramp("c", 3), "c").unwrap().corrected(&spaced).unwrap();
        let step = shown.with_step(&ramp("a1", 1), vec![(2, ramp("c1", 2))]).unwrap();
        assert_eq!(step.volume().ranges(), shown.volume().ranges(), "a darker step stays darker");
        assert_eq!(step.volume().density_mapping(), shown.volume().density_mapping());
        assert_eq!(step.volume().density_of(63.0), 0.25);
        assert_eq!(step.volume().corrections(), &spaced);
        assert!(Arc::ptr_eq(step.fields()[1].volume(), shown.fields()[1].volume()), "of another file");
        let origins: Vec<_> = step.further_origins().map(|origin| origin.opened_id).collect();
        assert_eq!(origins, [ramp("b", 2).opened_id(), ramp("c1", 2).opened_id()]);
        assert_ne!(step.id().content_id, shown.id().content_id);
        let back = step.with_step(&ramp("a", 4), vec![(2, ramp("c", 3))]).unwrap();
        assert_eq!(back.id(), shown.id());
        let bright = ValueRanges::without_outliers(crate::ValueRange::new(0.0, 504.0));
        assert_eq!(shown.with_ranges(bright).volume().density_of(252.0), 0.5);
        let second = shown.with_ranges_of(1, bright);
        assert_eq!(second.fields()[1].volume().density_of(126.0), 0.25);
        assert_eq!(second.volume().ranges(), shown.volume().ranges(), "those of the other fields stay");
        assert_eq!(second.further_origins().count(), 2);
    }
}
