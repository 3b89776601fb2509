//! Coordinate spaces, geometry primitives and colour conversions; every module may use them, and they depend on none.
//!
//! Names of transforms read right to left: `scene_from_index` maps a point in index space to scene space. All of this
//! is f64; values are converted to f32 when they are uploaded to the GPU.

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
