//! DICOM pixels: storage layout, location, decompression, and conversion to voxels.

mod bits;
mod codec;
pub(super) mod conversion;
pub(super) mod layout;
pub(super) mod pixel_store;
mod rle;
pub(super) mod size_check;
