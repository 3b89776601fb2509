//! The light of a sky: how open to it each place is.
//!
//! Blocks of voxels get a mean extinction, light is followed through them from many directions, and what arrives is
//! gathered into two moments over the directions: their mean V₀ and V₁.

pub(super) mod batches;
pub(super) mod blocks;
pub(super) mod build;
pub(super) mod floor_map;
pub(super) mod sheets;
pub(super) mod sweep;
pub(super) mod volume;
