//! Axis-aligned bounding boxes in double precision.

use glam::DVec3;

/// Axis-aligned bounding box; the code that builds it defines the space and unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Corner with the smallest coordinates.
    pub min: DVec3,
    /// Corner with the largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// Returns the bounding box of a grid of `dims` voxels in index space, grown by `pad` voxels on every side.
    ///
    /// Voxel centres lie at integers, so the box without padding is `[-½, n − ½]` along each axis.
    pub fn of_grid(dims: [usize; 3], pad: f64) -> Self {
        let n = DVec3::new(dims[0] as f64, dims[1] as f64, dims[2] as f64);
        Self { min: DVec3::splat(-0.5 - pad), max: n - DVec3::splat(0.5 - pad) }
    }

    /// Returns the eight corners of the box; bit `a` of a corner's index selects `max` along axis `a`.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Returns the bounding box of the points; no points give an inverted box (`min` = +∞, `max` = −∞).
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        let empty = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        points
            .into_iter()
            .fold(empty, |bounds, point| Self { min: bounds.min.min(point), max: bounds.max.max(point) })
    }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;

    #[test]
    fn grid_box_spans_whole_voxels() {
        let bounds = Aabb::of_grid([4, 5, 6], 2.0);
        assert_eq!(bounds.min, DVec3::splat(-2.5));
        assert_eq!(bounds.max, DVec3::new(5.5, 6.5, 7.5));
    }

    #[test]
    fn a_turned_box_is_wider() {
        let turn = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4);
        let corners = Aabb { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) }.corners();
        let turned = Aabb::from_points(corners.map(|corner| turn.transform_point3(corner)));
        assert!((turned.max.x - 2f64.sqrt()).abs() < 1e-12);
        assert!((turned.max.z - 1.0).abs() < 1e-12);
    }
}
