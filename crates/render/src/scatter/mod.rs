//! Scattering engine: splats voxels into sheets, and sheets into the picture and back into the grid.

pub(super) mod eye;
pub(super) mod footprint_table;
pub(super) mod footprints;
pub(super) mod light;
pub(super) mod sheet_lists;
pub(super) mod splat;
pub(super) mod voxels;
