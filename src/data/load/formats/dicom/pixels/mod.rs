//! Pixels: how they are stored, where they are, how they are unpacked, and what voxels they become.

mod codec;
mod extended;
mod jpeg_ls;
pub(super) mod raster;
mod rle;
pub(super) mod room;
pub(super) mod shape;
pub(super) mod store;
