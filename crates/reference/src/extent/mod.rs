//! Extent of the material: cuts, the faces of the grid, missing voxels, and normals of its surfaces.

pub(super) mod cut;
mod presence;
pub(super) mod surface_normals;
