//! Lengths in millimetres, voxels or shares of the volume's extent.

use serde::{Deserialize, Serialize};

use chiaroscuro_volume::math::SceneSpace;

/// Length with the unit in which it carries over to other volumes.
///
/// A preset for skulls uses millimetres, one for any data uses voxels, and a benchmark that must look the same at
/// every resolution uses shares of the volume's longest edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OpacityLength {
    /// Length in millimetres of world space.
    Mm(f64),
    /// Multiples of the edge of a cube with a voxel's volume.
    Voxels(f64),
    /// Fraction of the longest edge of the volume's box.
    Extent(f64),
}

impl OpacityLength {
    /// Converts the length to scene units.
    pub fn scene_units(self, scene: &SceneSpace) -> f64 {
        match self {
            Self::Mm(mm) => mm / scene.mm_per_unit,
            Self::Voxels(count) => count * scene.mean_edge(),
            // The longest edge has two scene units.
            Self::Extent(share) => 2.0 * share,
        }
    }

    /// Returns the length times a factor, in the same unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Mm(mm) => Self::Mm(factor * mm),
            Self::Voxels(count) => Self::Voxels(factor * count),
            Self::Extent(share) => Self::Extent(factor * share),
        }
    }

    /// Returns the number without its unit.
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
        for same in [OpacityLength::Mm(2.0), OpacityLength::Voxels(1.0), OpacityLength::Extent(1.0 / 64.0)] {
            assert!((same.scene_units(&scene) - 2.0 / 64.0).abs() < 1e-12, "{same:?}");
        }
    }
}
