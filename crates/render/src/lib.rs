//! The wgpu renderer: splatting with sheet buffers, computed in gather form.
//!
//! ```
//! use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, first_look};
//! use chiaroscuro_volume::{Dataset, synthetic};
//!
//! // A built-in volume of 24³ voxels; `open` of chiaroscuro-volume-io reads files.
//! let dataset = Dataset::new(synthetic::builtin("chair", Some(24))?);
//! let mut renderer = Renderer::new(&GpuContext::headless()?)?;
//! let settings = first_look(&mut renderer, &dataset)?;
//! let bytes = renderer.render_display(&dataset, &settings, [64, 48], &RenderOptions::default())?;
//! let middle = &bytes[4 * (24 * 64 + 32)..][..3];
//! assert!(bytes.len() == 64 * 48 * 4 && middle != &bytes[..3], "the chair stands before the background");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Volumetric shadows follow *Splatting With Shadows* (Nulkar & Mueller, 2001), cited below as P: light is attenuated
//! on its way to the material and again on its way to the eye, and both passes are image-aligned sheet-buffer
//! splatting. Independent of the window.
//!
//! Begin with [`Renderer`], and follow a picture: `plan/keys/mod.rs` has the inputs of each cached product,
//! `frame/frame_plan/mod.rs` lists the steps of those that are stale, and `frame/encode/mod.rs` records them with the
//! passes in the other folders. The light volume is filled by `light/march.rs`, which fills sheets with transmittance,
//! and `light/backproject.rs`, which splats them into the volume; `frame/light_fill.rs` has the order of their steps,
//! also if `light/raycast.rs` casts rays instead. The shaders are in the folder `shaders` of the repository.
//!
//! Spaces: *index* (voxel centres at integers) → *world* (millimetres) → *scene* (the volume's longest edge spans
//! [−1, 1]) → sheets (pixels and depth along an axis of projection).

mod context;
mod eye;
mod first_look;
mod frame;
mod light;
mod output;
mod pipelines;
pub mod plan;
mod readback;
mod resources;
mod scatter;
mod scattered_light;
mod sky;
mod volume;

pub use self::readback::part_pages::{BandError, PartPages};
pub use self::readback::pictures::is_empty_light;
pub use self::readback::statistics::LightVolumeStatistics;
pub use self::readback::tiled::{BandProgress, PictureBands};
pub use context::check_driver_address_space;
pub use context::error::GpuError;
pub use context::{GpuContext, OpeningTimes, device_descriptor};
pub use first_look::{
    LightSearch, LightSearchResult, LightSuggestion, LightingScore, MeasuredSettings, SearchedLight,
    UndecidedPart, automatic_exposure, complete_first_look, dark_fraction, downsampled_volume, first_look,
    first_look_upright, mean_luminance, measure_balance, measure_balance_fast, shadowed_fraction,
    visible_fraction,
};
pub use frame::downsample_to_fit::{bytes_with_one_light, downsample_to_fit, downsampled_dims};
pub use frame::picture_painter::PicturePainter;
pub use frame::render_job::RenderJob;
pub use frame::renderer::Renderer;
pub use frame::report::{RenderReport, RenderedPicture, StepCounts};
pub use frame::step::RenderStage;
pub use output::light_volume_export::{AttenuationSlice, export_slice};
pub use output::picture_distance::PictureDistance;
pub use output::window_painter::{WindowPainter, WindowPicture};
#[cfg(feature = "testing")]
pub use pipelines::layouts::{ShaderBindings, shader_bindings};
#[cfg(feature = "testing")]
pub use pipelines::library_pool::pooled_library;
#[cfg(feature = "testing")]
pub use pipelines::preprocessor::shader_conditions;
#[cfg(feature = "testing")]
pub use pipelines::shader_files::SHADERS;
pub use pipelines::shader_library::ShaderLibrary;
#[cfg(feature = "testing")]
pub use pipelines::uniforms;
pub use plan::{PictureOptions, RenderOptions, TestSwitches, WorkOptions};
pub use resources::textures::AttenuationData;
#[cfg(feature = "testing")]
pub use volume::brick_list::LISTED_PER_ROW;
#[cfg(feature = "testing")]
pub use volume::stored_density;
