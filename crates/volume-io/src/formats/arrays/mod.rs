//! Formats that hold arrays of any number of dimensions, whose axes have to be interpreted.

pub(super) mod hdf5;
pub(super) mod numpy;
mod volume_axes;
pub(super) mod zarr;
mod zip;

use super::{Endian, FileDimension, LoadControl, LoadError, LoadOptions, VolumeOffer};
use super::{input, number, placement, reader, samples, voxels};
