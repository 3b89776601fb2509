//! Chiaroscuro: a viewer for volume data with volumetric shadows.
//!
//! ```
//! use chiaroscuro::data::load::{LoadControl, LoadOptions};
//! use chiaroscuro::data::{Dataset, open};
//! use chiaroscuro::gpu::{GpuContext, RenderOptions, Renderer, first_look};
//!
//! // A built-in volume of 24³ voxels; the name of a RAW or NRRD file does as well.
//! let volume = open("builtin:chair:24", &LoadOptions::default(), &LoadControl::new())?;
//! let dataset = Dataset::new(volume);
//! let mut renderer = Renderer::new(&GpuContext::headless()?)?;
//! let settings = first_look(&mut renderer, &dataset)?;
//! let bytes = renderer.render_display(&dataset, &settings, [64, 48], &RenderOptions::default())?;
//! let middle = &bytes[4 * (24 * 64 + 32)..][..3];
//! assert!(bytes.len() == 64 * 48 * 4 && middle != &bytes[..3], "the chair stands before the background");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `examples/` writes such a picture to a file and shows a light volume as an array, a turntable, and the renderer
//! inside another wgpu program. [`gpu::Renderer`] is the entry point to everything else.
//!
//! Volumetric shadows follow *Splatting With Shadows* (Nulkar & Mueller, 2001), cited below as P: light is attenuated
//! on its way to the material and again on its way to the eye, and both passes are image-aligned sheet-buffer
//! splatting.
//!
//! Modules import downwards only, in this order:
//!
//! | module | contents |
//! |---|---|
//! | `fault` | fault injection for tests |
//! | [`math`] | spaces and boxes |
//! | [`data`] | volumes: readers, built-ins, histograms, bricks |
//! | [`model`] | `Settings`, the single value that describes the whole look |
//! | [`plan`] | cache keys of a picture's products; geometry of the passes |
//! | [`export`] | writing files: pictures, animations, volumes |
//! | `reference` | the paper in f64, literal and slow; with the feature `testing` |
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
mod fault;
pub mod gpu;
pub mod math;
pub mod model;
pub mod plan;
#[cfg(feature = "testing")]
pub mod reference;
