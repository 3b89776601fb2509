//! Lengths that can follow the volume.

use serde::{Deserialize, Serialize};

use crate::math::SceneSpace;

/// A length, in the unit that travels best.
///
/// A preset for skulls says millimetres, one for
/// anything says voxels, a benchmark that must look the same at every resolution says a share of
/// the volume's longest edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Length {
    /// Millimetres.
    Mm(f64),
    /// Edges of a cube as large as a voxel.
    Voxels(f64),
    /// Shares of the longest edge of the volume's box.
    Extent(f64),
}

impl Length {
    /// The length in scene units.
    pub fn in_scene(self, scene: &SceneSpace) -> f64 {
        match self {
            Self::Mm(mm) => mm / scene.mm_per_unit,
            Self::Voxels(count) => count * scene.mean_edge(),
            // The longest edge is two units long.
            Self::Extent(share) => 2.0 * share,
        }
    }

    /// The bare number, whatever the unit.
    pub fn number(self) -> f64 {
        match self {
            Self::Mm(number) | Self::Voxels(number) | Self::Extent(number) => number,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DVec3};

    #[test]
    fn units_agree() {
        let scene = SceneSpace::new([64, 64, 64], DAffine3::from_scale(DVec3::splat(2.0)));
        for same in [Length::Mm(2.0), Length::Voxels(1.0), Length::Extent(1.0 / 64.0)] {
            assert!((same.in_scene(&scene) - 2.0 / 64.0).abs() < 1e-12, "{same:?}");
        }
    }
}
