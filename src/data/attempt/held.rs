//! Inventory of a file: the volumes, channels, time steps and components it holds beside the one that was opened.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::offer::{Dimension, Offer};
use super::portion::Portion;

/// Aspect in which the volumes of a file differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aspect {
    /// Several series, channels, time steps or arrays.
    Of(Dimension),
    /// Components of voxels with several numbers each.
    Component,
}

impl Aspect {
    /// All aspects, in the order in which the user selects.
    pub const ALL: [Self; 5] = [
        Self::Of(Dimension::Series),
        Self::Of(Dimension::Array),
        Self::Of(Dimension::Channel),
        Self::Of(Dimension::Frame),
        Self::Component,
    ];

    /// Returns true if a volume takes over the look of another one that differs in this aspect: both show the same
    /// object with the same range of values.
    pub fn keeps_look(self) -> bool {
        matches!(self, Self::Of(Dimension::Frame) | Self::Component)
    }

    /// Returns the command-line option that selects in this aspect.
    pub fn option(self) -> &'static str {
        match self {
            Self::Of(dimension) => dimension.option(),
            Self::Component => "--component",
        }
    }

    /// Returns the plural name, for messages.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Of(dimension) => dimension.plural(),
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
pub struct Several {
    /// Dimension in which the volumes differ.
    pub dimension: Dimension,
    /// All volumes, at least two.
    pub offers: Vec<Offer>,
    /// Index of the volume that was opened.
    pub at: usize,
    /// Selection that matched no volume, if any; the first volume was opened instead.
    pub missed: Option<String>,
}

/// Value shown for voxels of several numbers when no component is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// Length (magnitude) of the vector.
    Magnitude,
    /// Luminance of the linear colour.
    Luminance,
    /// First component: the grey value if an opacity follows it, or the first layer.
    First,
}

/// Components of voxels that hold several numbers each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components {
    /// Numbers per voxel, at least two.
    pub count: usize,
    /// True if they are a colour: red, green and blue, possibly followed by an opacity.
    pub is_color: bool,
    /// Value shown when no component is selected.
    pub whole: Whole,
    /// Index of the component that is shown, from 0, if one was selected.
    pub shown: Option<usize>,
}

/// Inventory of a file, to the extent that it was read to open one volume.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Held {
    /// One entry for each dimension in which the file's volumes differ.
    pub several: Vec<Several>,
    /// Components of a voxel, if there are several.
    pub components: Option<Components>,
    /// Voxels of the grid along x, y, z, if known.
    pub grid: Option<[usize; 3]>,
    /// Portion of the grid that was read.
    pub portion: Portion,
}

impl Held {
    /// Returns the volumes that differ in a dimension.
    pub fn of(&self, dimension: Dimension) -> Option<&Several> {
        self.several.iter().find(|several| several.dimension == dimension)
    }
}

/// Recorder of the volumes that readers find while they open one of them; clones share the record.
#[derive(Debug, Clone, Default)]
pub struct Watch(Arc<Mutex<Seen>>);

#[derive(Debug, Default)]
struct Seen {
    held: Held,
    is_averaged: bool,
    /// Aspects in which a reader has queried the choice, among several volumes or only one.
    asked: Vec<Aspect>,
}

/// Watches are equal only if they share their record.
impl PartialEq for Watch {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Watch {}

impl Watch {
    /// Returns a copy of the inventory recorded so far.
    pub fn held(&self) -> Held {
        self.seen().held.clone()
    }

    /// Returns true if blocks were averaged while they were read.
    pub(in crate::data) fn has_averaged(&self) -> bool {
        self.seen().is_averaged
    }

    /// Returns true if a reader has queried the choice in this aspect.
    pub(super) fn was_asked(&self, aspect: Aspect) -> bool {
        self.seen().asked.contains(&aspect)
    }

    pub(super) fn asks(&self, aspect: Aspect) {
        let asked = &mut self.seen().asked;
        if !asked.contains(&aspect) {
            asked.push(aspect);
        }
    }

    fn seen(&self) -> MutexGuard<'_, Seen> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn saw_several(&self, several: Several) {
        let held = &mut self.seen().held;
        // The header of a data file may be read twice; the later record replaces the earlier.
        held.several.retain(|known| known.dimension != several.dimension);
        held.several.push(several);
    }

    pub(super) fn saw_grid(&self, dims: [usize; 3]) {
        self.seen().held.grid = Some(dims);
    }

    pub(super) fn saw_averaging(&self) {
        self.seen().is_averaged = true;
    }

    pub(super) fn saw_components(&self, components: Components) {
        self.seen().held.components = Some(components);
    }
}
