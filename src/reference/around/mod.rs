//! Indirect light: sky visibility, bounced light, and random walks to verify it.

pub(super) mod bounces;
pub(super) mod sky;
mod walks;
