//! Chiaroscuro: see the shape of volume data.
//!
//! True volumetric shadows after *Splatting With Shadows* (Nulkar & Mueller, 2001), below cited as
//! P: light is attenuated on its way to the material and again on its way to the eye, and both
//! passes are image-aligned sheet-buffer splatting.
//!
//! Modules import downwards only, in this order:
//!
//! | module | holds |
//! |---|---|
//! | [`math`] | spaces and boxes |
//! | [`data`] | volumes: readers, built-ins, histograms, bricks |
//! | [`model`] | `Settings`, the one value that is the whole look |
//! | [`plan`] | what a change makes stale; the geometry of the passes |
//! | [`export`] | files that go out: pictures, pictures that move |
//! | [`mod@reference`] | the paper in f64, literal and slow |
//! | [`gpu`] | the renderer |
//! | `app` | the window; with the feature `window` |
//! | `cli` | the command line; with the feature `cli` |
//!
//! Spaces: *index* (voxel centres at integers) → *world* (millimetres) → *scene* (the volume's
//! longest edge spans [−1, 1]) → sheets (pixels and depth along an axis of projection).

#[cfg(feature = "window")]
pub mod app;
#[cfg(feature = "cli")]
pub mod cli;
pub mod data;
pub mod export;
pub mod gpu;
pub mod math;
pub mod model;
pub mod plan;
pub mod reference;
