//! Extent of the material: cuts, the faces of the grid, missing voxels, and normals of its surfaces.

pub(super) mod cut;
pub(super) mod point_weights;
mod presence;
pub(super) mod presence_pyramids;
pub(super) mod surface_normals;
