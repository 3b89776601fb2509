//! Sky visibility (ambient occlusion): a volume that stores how much of the sky each point sees, as the two moments
//! that correspond to the spherical harmonics of orders 0 and 1.
//!
//! Extinction is averaged over blocks of voxels, light is swept through them from many directions, and the
//! transmittance is summed into two moments over directions: the mean transmittance V₀, and the mean V₁ of
//! transmittance times direction.

pub(super) mod block_texture;
pub(super) mod direction_batches;
pub(super) mod extinction_blocks;
pub(super) mod fill;
pub(super) mod floor_map;
pub(super) mod sharpened_blocks;
pub(super) mod sheets;
pub(super) mod surfaces;
pub(super) mod sweep;
pub(super) mod volume;
