//! Caches of light volumes that successive pictures share: attenuation, sky visibility, scattered light.

pub(crate) mod light_volumes;
mod lookup_reach;
pub(super) mod placement;
pub(super) mod scattered_light_volumes;
pub(super) mod sky_volumes;
pub(super) mod spare_volumes;
