//! Indirect light: sky visibility, bounced light, and random walks to verify it.

pub(super) mod bounces;
mod diffusion;
mod random_walks;
mod series;
pub(super) mod sky;
mod sky_surfaces;
