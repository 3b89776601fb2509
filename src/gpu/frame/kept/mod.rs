//! What pictures share: which volumes a picture needs, which of them are there, and which are forgotten.

pub(super) mod bounces;
pub(in crate::gpu) mod light;
mod reach;
pub(super) mod sky;
