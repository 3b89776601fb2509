//! Slices of a volume, and the layers of its even grid that are made of them.

use std::ops::Range;

use super::header::plane::Plane;

/// A picture, or a part of one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slice {
    /// Its file, by its number among the headers.
    pub(crate) file: usize,
    /// From 0.
    pub(crate) frame: usize,
    /// Of slices that lie side by side in one picture, from 0.
    pub(crate) tile: Option<usize>,
    pub(crate) plane: Plane,
}

/// A layer of a volume, made of pictures by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Layer {
    /// A picture as it is.
    Picture(usize),
    /// Linear interpolation: this share of the second, the rest of the first.
    Between {
        pictures: [usize; 2],
        share: f64,
        /// No slice lies here, where one should.
        is_missing: bool,
    },
    /// The masks of segments.
    Masks(Range<usize>),
    /// Nothing is known.
    Empty,
}

/// What stands where slices are missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Filling {
    /// Means of the slices beside it.
    Means,
    /// The nearest slice: values are numbers of something.
    Nearest,
    /// No segment: only slices with one in them are stored.
    NoSegment,
}

impl Layer {
    /// The pictures that it is made of.
    pub(crate) fn pictures(&self) -> Range<usize> {
        match self {
            Self::Picture(picture) => *picture..*picture + 1,
            // Neighbours.
            Self::Between { pictures: [low, high], .. } => *low..*high + 1,
            Self::Masks(pictures) => pictures.clone(),
            Self::Empty => 0..0,
        }
    }
}
