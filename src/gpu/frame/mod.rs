//! One picture from request to pixels: what must be computed, in which steps, and what is kept.

pub(super) mod encode;
pub(super) mod fit;
pub(super) mod job;
pub(super) mod kept;
pub(super) mod light_build;
mod loaded;
mod plan;
pub(super) mod renderer;
pub(super) mod report;
pub(super) mod step;
mod targets;
#[cfg(test)]
mod tests;
pub(super) mod warm_up;
