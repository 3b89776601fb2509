//! Coordinate spaces, geometry primitives and colour conversions, for this crate and those above it; they depend on no
//! other module.
//!
//! Names of transforms read right to left: `scene_from_index` maps a point in index space to scene space. All of this
//! is f64; values are converted to f32 when they are uploaded to the GPU.

mod bounds;
mod clip_region;
mod false_color;
mod luminance;
mod scene;
mod srgb;

pub use bounds::Aabb;
pub use clip_region::{ClipRegion, HalfSpace, RayInterval};
pub use false_color::false_color;
pub use luminance::luminance;
pub use scene::SceneSpace;
pub use srgb::{linear_from_srgb, srgb_from_linear};
