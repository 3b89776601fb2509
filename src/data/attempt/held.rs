//! What a file holds beside the one volume that is opened of it, for a window in which another can be chosen.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::offer::{Dimension, Offer};
use super::portion::Portion;

/// In what volumes of a file differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aspect {
    /// Series, channels, time steps or arrays.
    Of(Dimension),
    /// What is shown of voxels of several numbers.
    Component,
}

impl Aspect {
    /// All of them, in the order in which people choose.
    pub const ALL: [Self; 5] = [
        Self::Of(Dimension::Series),
        Self::Of(Dimension::Array),
        Self::Of(Dimension::Channel),
        Self::Of(Dimension::Frame),
        Self::Component,
    ];

    /// Whether a volume is shown with the look of another that differs from it in this: both are of one thing, with the
    /// same values.
    pub fn keeps_look(self) -> bool {
        matches!(self, Self::Of(Dimension::Frame) | Self::Component)
    }

    /// The option of the command line that chooses.
    pub fn option(self) -> &'static str {
        match self {
            Self::Of(dimension) => dimension.option(),
            Self::Component => "--component",
        }
    }

    /// Several of them, in words.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Of(dimension) => dimension.plural(),
            Self::Component => "components",
        }
    }

    /// Its place in [`Self::ALL`].
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|&other| other == self).unwrap_or_default()
    }
}

/// Several volumes of a file, one of which was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Several {
    /// In what they differ.
    pub dimension: Dimension,
    /// All of them: two at least.
    pub offers: Vec<Offer>,
    /// Which of them was opened.
    pub at: usize,
    /// What was asked for, if that is none of them: the first was opened then.
    pub missed: Option<String>,
}

/// What voxels of several numbers show when no component is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// The length of the vector.
    Magnitude,
    /// How light the colour is.
    Luminance,
    /// The first component: of grey with its opacity, and of layers.
    First,
}

/// Voxels of several numbers, of which one is shown, or what all of them make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components {
    /// How many numbers a voxel has: two at least.
    pub count: usize,
    /// Whether they are a colour: red, green and blue, perhaps with an opacity after them.
    pub is_color: bool,
    /// What they show where none is named.
    pub whole: Whole,
    /// The component that is shown, from 0, if one was named.
    pub shown: Option<usize>,
}

/// All that a file holds, as far as it was read for one volume.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Held {
    /// A row for each way in which volumes of it differ.
    pub several: Vec<Several>,
    /// Of voxels of several numbers.
    pub components: Option<Components>,
    /// Voxels along x, y, z of the grid, where it is known.
    pub grid: Option<[usize; 3]>,
    /// What of that was read.
    pub portion: Portion,
}

impl Held {
    /// The volumes that differ in a dimension.
    pub fn of(&self, dimension: Dimension) -> Option<&Several> {
        self.several.iter().find(|several| several.dimension == dimension)
    }
}

/// Where readers write down what they have found, while they open the first volume of several.
#[derive(Debug, Clone, Default)]
pub struct Watch(Arc<Mutex<Seen>>);

#[derive(Debug, Default)]
struct Seen {
    held: Held,
    is_averaged: bool,
    /// Aspects that a reader has asked the choice for, of several volumes or of one.
    asked: Vec<Aspect>,
}

/// Only a watch itself is the same.
impl PartialEq for Watch {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Watch {}

impl Watch {
    /// What was found until now.
    pub fn held(&self) -> Held {
        self.seen().held.clone()
    }

    /// Whether blocks were averaged while they were read.
    pub(in crate::data) fn has_averaged(&self) -> bool {
        self.seen().is_averaged
    }

    /// True where a reader has asked which of them is meant.
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
        // A header beside its data is read twice.
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
