//! Frame: one picture from request to pixels, with the plan, the steps and the caches.

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
