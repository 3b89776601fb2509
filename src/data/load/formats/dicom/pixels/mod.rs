//! DICOM pixels: storage layout, location, decompression, and conversion to voxels.

mod codec;
mod extended;
mod jpeg_ls;
pub(super) mod raster;
mod rle;
pub(super) mod room;
pub(super) mod shape;
pub(super) mod store;
