//! Voxel values: storage types, ranges, and the robust range without outliers.

pub(super) mod fill_value;
pub(super) mod range;
pub(super) mod robust;
pub(super) mod samples;
pub(super) mod voxel_mask;
