//! Light pass: from density to the attenuation volume of each light.
//!
//! The march (density seen from the light, into sheets of transmittance) and the back-projection (sheets into voxels)
//! fill a light volume; casting rays from its voxels is the alternative. The volume of an area light is the average
//! over points on it, weighted by their cosines to surfaces if the light is wide.

pub(super) mod area_light;
pub(super) mod backproject;
pub(super) mod block_normals;
pub(super) mod colored_shadows;
pub(super) mod combined_light;
pub(super) mod fill_inputs;
pub(super) mod floor_shadow;
pub(super) mod light_uniform;
pub(super) mod light_volume;
pub(super) mod march;
pub(super) mod raycast;
