//! Values of voxels: how they are stored, and which of them matter.

pub(super) mod range;
pub(super) mod robust;
pub(super) mod samples;
