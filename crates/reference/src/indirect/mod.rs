//! Indirect light: sky visibility, bounced light, and random walks to verify it.

pub(super) mod bounces;
mod random_walks;
pub(super) mod sky;
