//! Slices of a volume, and the layers of its regular grid, which are made from them.

use std::ops::Range;

use super::header::image_plane::ImagePlane;

/// Slice of a volume: one image, or one tile of a mosaic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DicomSlice {
    /// Index of its file among the headers.
    pub(crate) file: usize,
    /// Index of the frame within the file, from 0.
    pub(crate) frame: usize,
    /// Index of the tile within a mosaic image, from 0; `None` for a whole image.
    pub(crate) tile: Option<usize>,
    pub(crate) plane: ImagePlane,
}

/// Layer of a volume's regular grid, made from slices by their indices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SliceLayer {
    /// Voxels of a single slice, unchanged.
    Slice(usize),
    /// Linear interpolation of two slices: `share` of the second, the rest of the first.
    Blend {
        pictures: [usize; 2],
        share: f64,
        /// True if a slice is missing at this position.
        is_missing: bool,
    },
    /// Masks of segments at one position.
    Masks(Range<usize>),
    /// Gap in which nothing was measured.
    Empty,
}

/// Rule for filling missing slices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GapFill {
    /// Linear interpolation between the adjacent slices.
    Interpolate,
    /// Nearest slice, for values that are indices into a palette.
    Nearest,
    /// No segment: only slices that contain a segment are stored.
    NoSegment,
}

impl SliceLayer {
    /// Returns the indices of the slices that the layer is made from.
    pub(crate) fn slices(&self) -> Range<usize> {
        match self {
            Self::Slice(picture) => *picture..*picture + 1,
            // The two slices are adjacent.
            Self::Blend { pictures: [low, high], .. } => *low..*high + 1,
            Self::Masks(pictures) => pictures.clone(),
            Self::Empty => 0..0,
        }
    }
}
