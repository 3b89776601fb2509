//! What readers of all formats share: files, numbers, places, and what stands beside a file.

pub(super) mod beside;
pub(super) mod content;
pub(super) mod input;
pub(super) mod label_files;
mod large_pages;
pub(super) mod number;
pub(super) mod placement;
pub(super) mod reader;
pub(super) mod rescaled;
pub(super) mod samples;
mod stored;
pub(super) mod text_numbers;

use super::{Dimension, Endian, LoadControl, LoadError, LoadOptions, Offer};
