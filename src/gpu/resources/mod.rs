//! Resources shared by all passes: pooled buffers and textures, dispatches, cache entries.

pub(super) mod cached;
pub(super) mod fill_time;
pub(super) mod part;
pub(super) mod pass;
pub(super) mod pool;
pub(super) mod readback;
pub(super) mod ring;
pub(super) mod tools;
