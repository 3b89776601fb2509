//! What of the volume is there to be seen or to attenuate light: what cuts leave, within the grid, where no voxel is
//! missing.

pub(super) mod cut;
mod presence;
