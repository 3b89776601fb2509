//! The wgpu renderer: splatting with sheet buffers, computed in gather form.
//!
//! One folder per stage of the picture, in the order in which the stages depend on each other; one file per compute
//! pass, named like its shader. Independent of the window.

mod context;
mod eye;
mod first_look;
mod frame;
mod light;
mod output;
mod picture_painter;
mod pipelines;
mod readback;
mod resources;
mod scatter;
mod scattered_light;
mod sky;
mod volume;

pub use self::readback::pictures::is_empty_light;
pub use self::readback::statistics::LightVolumeStatistics;
pub use self::readback::tiled::PictureBands;
pub use crate::plan::RenderOptions;
#[cfg(feature = "window")]
pub(crate) use context::check_driver_address_space;
pub use context::error::GpuError;
pub use context::{GpuContext, device_descriptor};
pub use first_look::{
    LightSearch, LightSearchResult, LightSuggestion, LightingScore, MeasuredSettings, SearchedLight,
    UndecidedPart, automatic_exposure, complete_first_look, dark_fraction, downsampled_volume, first_look,
    first_look_upright, mean_luminance, measure_balance, measure_balance_fast, shadowed_fraction,
    visible_fraction,
};
pub use frame::downsample_to_fit::{bytes_with_one_light, downsample_to_fit, downsampled_dims};
pub use frame::render_job::RenderJob;
pub use frame::renderer::Renderer;
pub use frame::report::{RenderReport, RenderedPicture, StepCounts};
pub use frame::step::RenderStage;
pub use output::light_volume_export::{AttenuationSlice, export_slice, light_volume_nrrd};
pub use output::picture_distance::PictureDistance;
pub use output::window_painter::{WindowPainter, WindowPicture};
pub use picture_painter::PicturePainter;
#[cfg(feature = "testing")]
pub use pipelines::layouts::{ShaderBindings, shader_bindings};
#[cfg(feature = "testing")]
pub use pipelines::preprocessor::shader_conditions;
#[cfg(feature = "testing")]
pub use pipelines::shader_files::SHADERS;
pub use pipelines::shader_library::ShaderLibrary;
#[cfg(feature = "testing")]
pub use pipelines::uniforms;
pub use resources::textures::AttenuationData;
#[cfg(feature = "testing")]
pub use volume::brick_list::LISTED_PER_ROW;
#[cfg(feature = "testing")]
pub use volume::stored_density;
