//! Metadata in TIFF files, by the program that wrote them: slice, channel and time of each page, and the voxel size.

mod contiguous;
pub(super) mod imagej;
pub(super) mod imagej_names;
mod length_unit;
pub(super) mod lsm;
pub(super) mod lsm_names;
pub(super) mod ome;
pub(super) mod palette;
pub(super) mod shaped;
mod spacing;
