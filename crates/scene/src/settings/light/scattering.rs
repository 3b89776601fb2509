//! Multiple scattering: light that bounces inside the volume and illuminates nearby material.

use serde::{Deserialize, Serialize};

use super::direction_sets::sky_direction_set;
use crate::LightVolumeResolution;

/// Largest number of simulated bounces; with two or more, diffusion gives what all later ones bring.
pub const MAX_BOUNCES: u32 = 12;

/// Largest magnitude of the phase function's anisotropy: beyond it a material acts as a mirror, or is not visible at
/// all.
pub const MAX_ANISOTROPY: f64 = 0.9;

/// Multiple scattering of light until it is absorbed or leaves: wax, skin and clouds glow from within.
///
/// Light is scattered in all directions and in the colours of the transfer function, which bleed onto nearby
/// material. The light that the eye sees without a bounce has full detail; bounced light is computed in blocks of
/// voxels, and cached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ScatteringSettings {
    /// Number of simulated bounces, at most [`MAX_BOUNCES`]; 0 disables scattering, and with two or more all bounces
    /// count, found the more exactly.
    pub bounces: u32,
    /// Scattering albedo: share of interacting light that is scattered, times the colour; the rest is absorbed.
    pub albedo: f64,
    /// Factor for the displayed bounced light.
    pub strength: f64,
    /// Anisotropy of the Henyey–Greenstein phase function for the first bounce in material that is not a surface,
    /// which is the one with full detail: the mean cosine of the scattering angle, 0 even, towards 1 forward as in
    /// clouds, towards −1 backward.
    pub anisotropy: f64,
    /// Factor for the extinction of bounced light: a lower one lets it in deeper.
    pub density_scale: f64,
    /// Number of directions of the last bounce, which is the visible one; [`sky_direction_set`] returns the number
    /// that serves it.
    pub directions: u32,
    /// Resolution of the volume of bounced light.
    pub resolution: LightVolumeResolution,
}

impl ScatteringSettings {
    /// Returns the number of directions of all bounces but the last, which has `directions`: the last bounce evens
    /// out their irregularities.
    pub fn inner_bounce_directions(directions: u32) -> u32 {
        sky_direction_set(sky_direction_set(directions) / 4)
    }
}

impl Default for ScatteringSettings {
    fn default() -> Self {
        Self {
            bounces: 0,
            albedo: 0.9,
            strength: 1.0,
            anisotropy: 0.0,
            density_scale: 1.0,
            directions: 48,
            resolution: LightVolumeResolution::Quarter,
        }
    }
}
