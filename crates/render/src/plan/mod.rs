//! Frame planning: the keys of a picture's products, and the geometry of its passes. Pure functions only, but for
//! [`fill_pages`] and [`fill_part`], which read.
//!
//! [`FrameKeys`] are the inputs of each product; the renderer caches products with their keys, and recomputes those
//! whose key differs. `geometry` lays out sheets, bricks and cells. [`probe()`] finds what is under a pixel.

mod geometry;
mod keys;
mod pages;
mod pixel_rays;
mod probe;
mod request;

pub use self::geometry::brick_set::BrickSet;
pub use self::geometry::cell_distances::{CellDistances, MAX_CELL_DISTANCE};
pub use self::geometry::cell_set::CellSet;
pub use self::geometry::eye_frame::{eye_frame, picture_frame, preview_slab};
pub use self::geometry::floor_plane::{FloorPlane, FloorTexels};
pub use self::geometry::light_frame::{
    LightView, MAX_KERNEL_PIXELS, MIN_KERNEL_VOXELS, SheetPosition, light_views,
};
pub use self::geometry::march_tiles::{MarchTiles, TILE_EDGE, TILE_FIRST_BIT, TILE_ROW_BIT};
pub use self::geometry::near_field_cells::NearFieldOffset;
pub use self::geometry::pixel_window::PixelWindow;
pub use self::geometry::reach::{
    bias_reach, lookup_reach, ray_reach, reverse_reach, reverse_reach_voxels, sample_reach,
    scatter_reach_bricks, slab_reach, stretch_reach,
};
pub use self::geometry::sheet_frame::{GradientSteps, MAX_STRETCH_LEVEL, PixelLinear, SheetFrame};
pub use self::geometry::slice_order::SliceOrder;
pub use self::geometry::sweep::{SlicePosition, SweepFrame};
pub use self::geometry::sweep_tiles::{END_SLICE_BIT, SweepTiles, boxes_around};
pub use self::pixel_rays::PixelRay;
pub use chiaroscuro_scene::{directions_above, sweep_directions};
pub use keys::{
    ActiveLight, ActiveLights, AntialiasedKey, AttenuationMethod, BouncesKey, CombinedKey, DisplayKey,
    EyeKey, EyeTableKey, FloorKey, FrameKeys, LightKey, OpacityKey, SkyKey, TablesKey, UniformLightColor,
};
pub use pages::{PageDemand, PagedView, density_visibility, fill_pages, fill_part, page_demand, shows_pages};
pub use probe::{LightArrival, Probe, probe, probe_layers};
pub use request::{PictureOptions, RenderOptions, RenderRequest, TestSwitches, VolumeKey, WorkOptions};
