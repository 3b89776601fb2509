//! Parts that the readers of all formats share: files, numbers, placement, and companion files.

pub(super) mod beside;
pub(super) mod content;
pub(super) mod input;
pub(super) mod label_files;
pub(super) mod number;
pub(super) mod placement;
pub(super) mod read_files;
pub(super) mod reader;
pub(super) mod rescaled;
pub(super) mod samples;
pub(super) mod sieve;
mod stored;
pub(super) mod text_numbers;
pub(super) mod voxels;

use super::{Dimension, Endian, LoadControl, LoadError, LoadOptions, Offer};
