//! The renderer: sheet-buffer splatting in gather form, on wgpu.
//!
//! One file per pass, with the same stem as its shader. [`Renderer`] reads top to bottom and owns
//! every cache. Knows nothing of the window.

mod bands;
mod clock;
mod context;
mod counts;
mod display;
mod distance;
mod error;
mod export_light;
mod eye;
mod first_look;
mod fit;
mod footprint_table;
mod gradients;
mod ground;
mod inspect;
mod job;
mod kernel;
mod light_backproject;
mod light_cache;
mod light_collapse;
mod light_march;
mod light_raycast;
mod light_volume;
mod listed_bricks;
mod pass;
mod picture;
mod pipeline_cache;
mod prefilter;
mod readback;
mod recycled;
mod renderer;
mod scatter_eye;
mod scatter_footprints;
mod scatter_light;
mod scatter_splat;
mod scatter_voxels;
mod shader;
mod sheet_lists;
mod steps;
mod tables;
pub mod uniforms;
mod volume;
mod warm_up;
mod window;

pub use bands::Bands;
pub use context::{Context, device_descriptor};
pub use counts::LightFigures;
pub use distance::Distance;
pub use error::GpuError;
pub use export_light::{LightSlice, export_slice, light_volume_nrrd};
pub use first_look::{balance, dark_share, first_look, mean_luminance};
pub use fit::fitted;
pub use job::{Job, Stage};
pub use picture::{Picture, RenderOptions, Report};
pub use readback::Attenuation;
pub use renderer::Renderer;
pub use shader::{SHADERS, ShaderLibrary};
pub use volume::stored_density;
pub use window::{WindowPainter, WindowPicture};
