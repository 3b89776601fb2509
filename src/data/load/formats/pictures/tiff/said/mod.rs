//! Metadata in TIFF files, by the program that wrote them: slice, channel and time of each page, and the voxel size.

mod contiguous;
pub(super) mod imagej;
mod length;
pub(super) mod lsm;
pub(super) mod names;
pub(super) mod ome;
pub(super) mod palette;
mod place;
pub(super) mod shaped;
