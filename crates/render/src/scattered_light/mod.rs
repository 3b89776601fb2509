//! Multiple scattering: light that is scattered by the material and illuminates other parts of it.
//!
//! Extinction and scattering are averaged over blocks of voxels, for each colour. Blocks scatter the direct light;
//! that light is swept through the blocks in many directions, like a sky's, and gathered, bounce by bounce. With
//! two or more bounces, a diffusion equation gives what all later ones bring.

mod block_passes;
mod diffusion;
pub(super) mod fill;
mod source_variant;
pub(super) mod steps;
mod textures;
pub(super) mod volume;
