//! Geometry of the passes: sheet frames, bricks and cells, and the reach of samples.

pub(super) mod brick_set;
pub(super) mod cell_distances;
pub(super) mod cell_set;
pub(super) mod eye_frame;
pub(super) mod floor_plane;
pub(super) mod light_frame;
pub(super) mod march_tiles;
pub(super) mod near_field_cells;
pub(super) mod pixel_window;
pub(super) mod reach;
pub(super) mod sheet_frame;
pub(super) mod slice_order;
pub(super) mod sweep;
pub(super) mod sweep_tiles;
