//! One picture from request to pixels: what must be computed, in which steps, and what is kept.

pub(super) mod debug;
pub(super) mod encode;
pub(super) mod first_look;
pub(super) mod job;
pub(super) mod light_cache;
pub(super) mod options;
pub(super) mod renderer;
pub(super) mod statistics;
pub(super) mod tiled;
pub(super) mod warm_up;
