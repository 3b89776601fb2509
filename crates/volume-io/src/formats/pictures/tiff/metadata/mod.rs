//! Metadata in TIFF files, by the program that wrote them: slice, channel and time of each page, and the voxel size.

mod contiguous;
pub(super) mod imagej;
pub(super) mod imagej_channels;
pub(super) mod lsm;
pub(super) mod lsm_channels;
pub(super) mod ome;
pub(super) mod palette;
pub(super) mod shaped;
mod spacing;
