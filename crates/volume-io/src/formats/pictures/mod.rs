//! Volumes whose slices are pictures: pages of one file, or files of their own.

mod channels_and_times;
mod gaps;
mod slice_reader;
pub(super) mod slices;
pub(super) mod tiff;
