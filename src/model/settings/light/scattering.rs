//! Light that bounces inside the volume: what material scatters lights what is around it.

use serde::{Deserialize, Serialize};

use crate::model::Resolution;

/// Most bounces that are followed; what further ones would bring is told from two of them, where there are three or more.
pub const MAX_BOUNCES: u32 = 12;

/// How much further than straight on light may be scattered, or back: beyond it matter is a mirror, or is not there.
pub const MAX_ANISOTROPY: f64 = 0.9;

/// Light that material scatters, until it is absorbed or leaves: wax, skin and clouds glow from within.
///
/// It is scattered in all directions and in the colours of the transfer function, which bleed onto what is near. What lights the eye sees without a bounce is as fine as ever; what has bounced is found in blocks of voxels, and kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Scattering {
    /// How many bounces are followed, at most [`MAX_BOUNCES`]; none: no light bounces.
    pub bounces: u32,
    /// What of light that is met is scattered, times the colour: the rest is absorbed.
    pub albedo: f64,
    /// What of bounced light is shown.
    pub strength: f64,
    /// Where light of matter that is no surface goes on its first bounce, the one that the eye sees as fine as ever: the mean
    /// cosine of the angle, 0 evenly, towards 1 forward as in clouds, towards −1 back. Henyey and Greenstein's phase function.
    pub anisotropy: f64,
    /// Multiplies the extinction that bouncing light meets: less lets it in deeper.
    pub density_scale: f64,
    /// In how many directions light is followed on its last bounce, the one that is seen.
    pub directions: u32,
    /// How finely.
    pub resolution: Resolution,
}

impl Scattering {
    /// In how many directions light is followed on all bounces but the last, of which there are `directions`: what they leave
    /// uneven, the last evens out.
    pub fn directions_of_a_bounce(directions: u32) -> u32 {
        (directions / 4).clamp(6, 14)
    }
}

impl Default for Scattering {
    fn default() -> Self {
        Self {
            bounces: 0,
            albedo: 0.9,
            strength: 1.0,
            anisotropy: 0.0,
            density_scale: 1.0,
            directions: 64,
            resolution: Resolution::Quarter,
        }
    }
}
