//! Inventory of a file: the volumes, channels, time steps and components it holds beside the one that was opened.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::offer::{FileDimension, VolumeOffer};
use super::portion::Portion;

/// Largest number of fields that one picture can show: the channels of a texel on the GPU.
pub const MAX_FIELDS: usize = 4;

/// Aspect in which the volumes of a file differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChoiceAspect {
    /// Several series, channels, time steps or arrays.
    Dimension(FileDimension),
    /// Components of voxels with several numbers each.
    Component,
}

impl ChoiceAspect {
    /// Aspects of which a file's volumes are on one grid and can be shown together. Time steps can if they are few: files
    /// of four dimensions call anything that differs a time step.
    pub const SHOWN_TOGETHER: [Self; 3] =
        [Self::Dimension(FileDimension::Frame), Self::Dimension(FileDimension::Channel), Self::Component];

    /// Returns true if a file's volumes that differ in this aspect, `count` of them, can be shown together.
    pub fn is_shown_together(self, count: usize) -> bool {
        let is_few = self != Self::Dimension(FileDimension::Frame) || count <= MAX_FIELDS;
        Self::SHOWN_TOGETHER.contains(&self) && is_few
    }

    /// All aspects, in the order in which the user selects.
    pub const ALL: [Self; 6] = [
        Self::Dimension(FileDimension::Series),
        Self::Dimension(FileDimension::Array),
        Self::Dimension(FileDimension::Channel),
        Self::Dimension(FileDimension::Frame),
        Self::Dimension(FileDimension::Level),
        Self::Component,
    ];

    /// Returns true if a volume takes over the look of another one that differs in this aspect: both show the same
    /// object with the same range of values.
    pub fn keeps_look(self) -> bool {
        matches!(self, Self::Dimension(FileDimension::Frame | FileDimension::Level) | Self::Component)
    }

    /// Returns the command-line option that selects in this aspect.
    pub fn option(self) -> &'static str {
        match self {
            Self::Dimension(dimension) => dimension.option(),
            Self::Component => "--component",
        }
    }

    /// Returns the plural name, for messages.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Dimension(dimension) => dimension.plural(),
            Self::Component => "components",
        }
    }

    /// Returns the index of this aspect in [`Self::ALL`].
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|&other| other == self).unwrap_or_default()
    }
}

/// Several volumes of a file, one of which was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VolumeAlternatives {
    /// Dimension in which the volumes differ.
    pub dimension: FileDimension,
    /// All volumes, at least two.
    pub offers: Vec<VolumeOffer>,
    /// Index of the volume that was opened.
    pub selected: usize,
    /// Selection that matched no volume, if any; the first volume was opened instead.
    pub unmatched_selection: Option<String>,
}

/// Value shown for voxels of several numbers when no component is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefaultComponent {
    /// Length (magnitude) of the vector.
    Magnitude,
    /// Luminance of the linear colour.
    Luminance,
    /// First component: the grey value if an opacity follows it, or the first layer.
    First,
}

/// Components of voxels that hold several numbers each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VoxelComponents {
    /// Numbers per voxel, at least two.
    pub count: usize,
    /// True if they are a colour: red, green and blue, possibly followed by an opacity.
    pub is_color: bool,
    /// Value shown when no component is selected.
    pub default_component: DefaultComponent,
    /// Index of the component that is shown, from 0, if one was selected.
    pub selected: Option<usize>,
}

/// Inventory of a file, to the extent that it was read to open one volume.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FileContents {
    /// Name of the file's format; `None` without a file.
    pub format: Option<&'static str>,
    /// One entry for each dimension in which the file's volumes differ.
    pub alternatives: Vec<VolumeAlternatives>,
    /// Components of a voxel, if there are several.
    pub components: Option<VoxelComponents>,
    /// Voxels of the grid along x, y, z, if known.
    pub grid: Option<[usize; 3]>,
    /// Portion of the grid that was read.
    pub portion: Portion,
}

impl FileContents {
    /// Returns the volumes that differ in a dimension.
    pub fn alternatives_in(&self, dimension: FileDimension) -> Option<&VolumeAlternatives> {
        self.alternatives.iter().find(|several| several.dimension == dimension)
    }
}

/// Recorder of the volumes that readers find while they open one of them; clones share the record.
#[derive(Debug, Clone, Default)]
pub struct ContentsRecorder(Arc<Mutex<RecordedContents>>);

#[derive(Debug, Default)]
struct RecordedContents {
    held: FileContents,
    is_averaged: bool,
    /// Aspects in which a reader has queried the choice, among several volumes or only one.
    queried: Vec<ChoiceAspect>,
}

/// Watches are equal only if they share their record.
impl PartialEq for ContentsRecorder {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for ContentsRecorder {}

impl ContentsRecorder {
    /// Returns a copy of the inventory recorded so far.
    pub fn contents(&self) -> FileContents {
        self.lock().held.clone()
    }

    /// Returns true if blocks were averaged while they were read.
    pub fn was_averaged_while_reading(&self) -> bool {
        self.lock().is_averaged
    }

    /// Returns true if a reader has queried the choice in this aspect.
    pub(super) fn was_queried(&self, aspect: ChoiceAspect) -> bool {
        self.lock().queried.contains(&aspect)
    }

    pub(super) fn record_query(&self, aspect: ChoiceAspect) {
        let asked = &mut self.lock().queried;
        if !asked.contains(&aspect) {
            asked.push(aspect);
        }
    }

    fn lock(&self) -> MutexGuard<'_, RecordedContents> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn record_alternatives(&self, several: VolumeAlternatives) {
        let held = &mut self.lock().held;
        // The header of a data file may be read twice; the later record replaces the earlier.
        held.alternatives.retain(|known| known.dimension != several.dimension);
        held.alternatives.push(several);
    }

    pub(super) fn record_format(&self, format: &'static str) {
        self.lock().held.format = Some(format);
    }

    pub(super) fn record_grid(&self, dims: [usize; 3]) {
        self.lock().held.grid = Some(dims);
    }

    pub(super) fn record_averaging(&self) {
        self.lock().is_averaged = true;
    }

    pub(super) fn record_components(&self, components: VoxelComponents) {
        self.lock().held.components = Some(components);
    }
}
