//! Caches of light volumes that successive pictures share: attenuation, sky visibility, scattered light.

pub(super) mod bounces;
pub(in crate::gpu) mod light;
mod reach;
pub(super) mod sky;
