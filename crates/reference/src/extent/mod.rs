//! Extent of the material: cuts, the faces of the grid, and missing voxels.

pub(super) mod cut;
mod presence;
