//! Parts that the readers of all formats share: files, numbers, placement, and companion files.

pub(super) mod chunk_codecs;
pub(super) mod companion_path;
pub(super) mod content;
pub(super) mod input;
pub(super) mod label_tables;
pub(super) mod number;
mod parallel_read;
pub(super) mod placement;
pub(super) mod reader;
pub(super) mod rescale;
pub(super) mod samples;
pub(super) mod text_numbers;
pub(super) mod voxel_filter;
pub(super) mod voxels;

use super::{Endian, LoadOptions};
use chiaroscuro_volume::{FileDimension, LoadControl, LoadError, VolumeOffer};
