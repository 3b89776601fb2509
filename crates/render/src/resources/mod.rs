//! Resources shared by all passes: pooled buffers and textures, dispatches, cache entries.

pub(super) mod cache_entry;
pub(super) mod fill_time;
pub(super) mod filled_cells;
pub(super) mod gpu_tools;
pub(super) mod host_clock;
pub(super) mod pass;
pub(super) mod product_cache;
pub(super) mod resource_pool;
pub(super) mod sheet_ring;
pub(super) mod submission_pace;
pub(super) mod textures;
pub(super) mod work_part;
