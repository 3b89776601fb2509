//! DICOM pixels: storage layout, location, decompression, and conversion to voxels.

mod codec;
pub(super) mod conversion;
mod jpeg_ls;
pub(super) mod layout;
mod lossy_jpeg;
pub(super) mod pixel_store;
mod rle;
pub(super) mod size_check;
