//! The wgpu renderer: splatting with sheet buffers, computed in gather form.
//!
//! One folder per stage of the picture, in the order in which the stages depend on each other; one file per compute
//! pass, named like its shader. Independent of the window.

mod bounces;
mod context;
mod eye;
mod first_look;
mod frame;
mod light;
mod output;
mod painter;
mod pipelines;
mod readback;
mod resources;
mod scatter;
mod sky;
mod volume;

pub use self::readback::pictures::is_empty_light;
pub use self::readback::statistics::LightFigures;
pub use self::readback::tiled::Bands;
pub use crate::plan::RenderOptions;
#[cfg(feature = "window")]
pub(crate) use context::check_room_for_drivers;
pub use context::error::GpuError;
pub use context::{Context, device_descriptor};
pub use first_look::{
    Found, LightSearch, Open, Score, SmallLook, Sought, Suggestion, balance, balance_quickly, dark_share,
    exposure_for, finish_look, first_look, first_look_upright, mean_luminance, seen_share, shadowed_share,
    small_volume,
};
pub use frame::fit::{bytes_with_one_light, fitted, held_of};
pub use frame::job::Job;
pub use frame::renderer::Renderer;
pub use frame::report::{Picture, Report, Runs};
pub use frame::step::Stage;
pub use output::distance::Distance;
pub use output::light_slice::{LightSlice, export_slice, light_volume_nrrd};
pub use output::window::{WindowPainter, WindowPicture};
pub use painter::PicturePainter;
#[cfg(feature = "testing")]
pub use pipelines::conditions::shader_conditions;
#[cfg(feature = "testing")]
pub use pipelines::layouts::{ShaderBindings, shader_bindings};
pub use pipelines::shader::ShaderLibrary;
#[cfg(feature = "testing")]
pub use pipelines::shader_files::SHADERS;
#[cfg(feature = "testing")]
pub use pipelines::uniforms;
pub use resources::readback::Attenuation;
#[cfg(feature = "testing")]
pub use volume::listed_bricks::LISTED_PER_ROW;
#[cfg(feature = "testing")]
pub use volume::stored_density;
