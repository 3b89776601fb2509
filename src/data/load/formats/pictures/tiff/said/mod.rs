//! What programs say of the pages of their TIFF files: which slice, channel and time each is, and how large voxels are.

mod contiguous;
pub(super) mod imagej;
mod length;
pub(super) mod lsm;
pub(super) mod names;
pub(super) mod ome;
pub(super) mod palette;
mod place;
pub(super) mod shaped;
