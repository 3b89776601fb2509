//! Signed axes of the scene, and the rotation that makes one of them point up.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Signed direction along an axis of the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SceneAxis {
    /// Direction along the +x axis.
    PlusX,
    /// Direction along the −x axis.
    MinusX,
    /// Direction along the +y axis.
    PlusY,
    /// Direction along the −y axis.
    MinusY,
    /// Direction along the +z axis.
    #[default]
    PlusZ,
    /// Direction along the −z axis.
    MinusZ,
}

impl SceneAxis {
    /// All six signed axes, x first.
    pub const ALL: [Self; 6] =
        [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ];

    /// Returns the axis as a unit vector.
    pub fn direction(self) -> DVec3 {
        match self {
            Self::PlusX => DVec3::X,
            Self::MinusX => DVec3::NEG_X,
            Self::PlusY => DVec3::Y,
            Self::MinusY => DVec3::NEG_Y,
            Self::PlusZ => DVec3::Z,
            Self::MinusZ => DVec3::NEG_Z,
        }
    }

    /// Returns the axis nearest to a direction.
    pub fn nearest(direction: DVec3) -> Self {
        let along = |axis: &Self| axis.direction().dot(direction);
        Self::ALL.into_iter().max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or_default()
    }

    /// Returns the rotation from upright space, in which z is up, to the scene in which this axis points up. Never a
    /// reflection.
    pub fn scene_from_upright(self) -> DMat3 {
        let upside_down = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
        match self {
            Self::PlusZ => DMat3::IDENTITY,
            Self::MinusZ => upside_down,
            // Cyclic permutation: each axis takes the place of the next.
            Self::PlusX => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
            Self::MinusX => Self::PlusX.scene_from_upright() * upside_down,
            Self::PlusY => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
            Self::MinusY => Self::PlusY.scene_from_upright() * upside_down,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_can_point_up_and_nothing_is_mirrored() {
        for axis in SceneAxis::ALL {
            let upright = axis.scene_from_upright();
            assert_eq!(upright * DVec3::Z, axis.direction(), "{axis:?}");
            assert_eq!(upright.determinant(), 1.0, "{axis:?}");
            assert_eq!(upright * upright.transpose(), DMat3::IDENTITY, "{axis:?}");
            assert_eq!(SceneAxis::nearest(axis.direction() + DVec3::new(0.1, -0.2, 0.15)), axis);
        }
    }
}
