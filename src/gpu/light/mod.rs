//! Light pass: from density to the attenuation volume of each light.
//!
//! The march (density seen from the light, into sheets of transmittance) and the back-projection (sheets into voxels)
//! fill a light volume; casting rays from its voxels is the alternative. The volume of an area light is the average
//! over points on it.

pub(super) mod average;
pub(super) mod backproject;
pub(super) mod colors;
pub(super) mod combine;
pub(super) mod floor_shadow;
pub(super) mod march;
pub(super) mod packed;
pub(super) mod raycast;
pub(super) mod volume;
