//! Light from all around: of a sky, and what bounces.

pub(super) mod bounces;
pub(super) mod sky;
mod walks;
