//! Volumes whose slices are pictures: the pages of a file, or files of their own.

mod pile;
pub(super) mod slices;
pub(super) mod tiff;
