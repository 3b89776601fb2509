//! The light pass: from density to the attenuation of each light.
//!
//! March (density seen from the light to sheets of transmittance) and back-projection (sheets to voxels) fill a
//! light volume; rays from its voxels are the other way. Of a light that has a size it is the mean of those of points on it.

pub(super) mod average;
pub(super) mod backproject;
pub(super) mod colors;
pub(super) mod combine;
pub(super) mod floor_shadow;
pub(super) mod march;
pub(super) mod packed;
pub(super) mod raycast;
pub(super) mod volume;
