//! One picture from request to pixels: what must be computed, in which steps, and what is kept.

pub(super) mod encode;
pub(super) mod fit;
pub(super) mod job;
pub(super) mod light_build;
pub(super) mod light_cache;
mod loaded;
mod plan;
pub(super) mod renderer;
pub(super) mod report;
mod sky_cache;
pub(super) mod step;
mod targets;
#[cfg(test)]
mod tests;
pub(super) mod warm_up;
