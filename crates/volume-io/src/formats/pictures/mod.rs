//! Volumes whose slices are pictures: pages of one file, or files of their own.

mod slice_reader;
pub(super) mod slices;
pub(super) mod tiff;
