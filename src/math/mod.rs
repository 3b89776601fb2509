//! Spaces and small geometry: what everything else may use and what knows nothing else.
//!
//! Names of transforms read right to left: `scene_from_index` takes a point in index space and
//! gives it in scene space. All of this is f64; the GPU gets f32 at the very end.

mod bounds;
mod false_color;
mod luminance;
mod region;
mod scene;
mod srgb;

pub use bounds::Bounds;
pub use false_color::false_color;
pub use luminance::luminance;
pub use region::{HalfSpace, Region};
pub use scene::SceneSpace;
pub use srgb::{linear_from_srgb, srgb_from_linear};
