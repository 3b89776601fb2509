//! Volumes whose slices are pictures: pages of one file, or files of their own.

mod pile;
pub(super) mod slices;
pub(super) mod tiff;
