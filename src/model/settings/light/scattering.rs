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
    /// How finely …
    pub resolution: Resolution,
    /// … and in how many blocks along the volume's longest edge at least, as far as there are voxels: what is small in voxels
    /// is as large in the picture as anything else.
    pub least_blocks: u32,
}

/// Most blocks along an edge that can be asked for, whatever the resolution.
pub const MOST_LEAST_BLOCKS: u32 = 256;

impl Scattering {
    /// In how many directions light is followed on all bounces but the last, of which there are `directions`: what they leave
    /// uneven, the last evens out.
    pub fn directions_of_a_bounce(directions: u32) -> u32 {
        (directions / 4).clamp(6, 14)
    }

    /// Voxels along the edges of the blocks of a volume of so many.
    pub fn divisor(&self, dims: [usize; 3]) -> usize {
        let longest = dims.into_iter().max().unwrap_or(1);
        let mut divisor = self.resolution.divisor();
        while divisor > 1 && longest.div_ceil(divisor) < self.least_blocks as usize {
            divisor /= 2;
        }
        divisor
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
            // What a volume of 128³ voxels has at a quarter.
            least_blocks: 32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_volumes_are_followed_in_smaller_blocks() {
        let of = |n: usize, resolution, least_blocks| {
            Scattering { resolution, least_blocks, ..Scattering::default() }.divisor([n, n / 2, 1])
        };
        assert_eq!(of(128, Resolution::Quarter, 32), 4);
        assert_eq!(of(124, Resolution::Quarter, 32), 2);
        assert_eq!(of(24, Resolution::Quarter, 32), 1);
        assert_eq!(of(24, Resolution::Quarter, 0), 4);
        assert_eq!(of(512, Resolution::Half, 32), 2);
        assert_eq!(of(512, Resolution::Full, 32), 1);
    }
}
