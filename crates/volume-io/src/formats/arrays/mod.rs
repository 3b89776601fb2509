//! Formats that hold arrays of any number of dimensions, whose axes have to be interpreted.

pub(super) mod numpy;
mod zip;

use super::{Endian, FileDimension, LoadError, VolumeOffer};
use super::{input, number, placement, reader, samples, voxels};
