//! Light that bounces: what material scatters lights what is around it.
//!
//! Blocks of voxels get a mean extinction and what of it scatters light, for each colour. From what unscattered light finds
//! there they give off light, which is followed in many directions through them, as a sky's is, and gathered; what has been
//! gathered makes them give off more, bounce by bounce. What infinitely many would bring is told from two, where there
//! are three or more.

pub(super) mod build;
pub(super) mod steps;
mod textures;
pub(super) mod volume;
