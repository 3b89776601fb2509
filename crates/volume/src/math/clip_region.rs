//! Convex clip regions: an axis-aligned box intersected with a half-space, and ray intersection.

use glam::DVec3;

use super::Aabb;

/// Half-space of all points with normal · p ≤ offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// Unit normal of the boundary plane, pointing out of the half-space.
    pub normal: DVec3,
    /// Signed distance of the boundary plane from the origin, along the normal.
    pub offset: f64,
}

impl HalfSpace {
    /// Returns the signed distance of a point from the boundary plane: positive inside the half-space, negative
    /// outside.
    pub fn signed_distance(&self, point: DVec3) -> f64 {
        self.offset - self.normal.dot(point)
    }
}

/// Convex part of index space: a box along the axes, intersected with a half-space if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipRegion {
    /// Lower bounds along the axes; −∞ where nothing is clipped.
    pub low: DVec3,
    /// Upper bounds along the axes; +∞ where nothing is clipped.
    pub high: DVec3,
    /// Half-space that clips the box, if any.
    pub plane: Option<HalfSpace>,
}

/// Part of a ray inside a region, in multiples of the length of the ray's direction. It is entered behind its end if
/// the ray misses the region.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RayInterval {
    /// Parameter of the ray where it enters the region.
    pub enter: f64,
    /// Parameter of the ray where it leaves the region.
    pub leave: f64,
}

impl ClipRegion {
    /// Unbounded region that clips nothing.
    pub const UNBOUNDED: Self = Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY, plane: None };

    /// Returns the intersection with an axis-aligned box.
    #[must_use]
    pub fn intersection(&self, bounds: &Aabb) -> Self {
        Self { low: self.low.max(bounds.min), high: self.high.min(bounds.max), plane: self.plane }
    }

    /// Returns the part of a ray inside the region (slab method).
    pub fn ray_interval(&self, origin: DVec3, direction: DVec3) -> RayInterval {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        // Each boundary: signed depth of the origin inside it, and the rate at which that grows along the ray.
        let mut bound = |depth: f64, speed: f64| {
            if speed > 0.0 {
                enter = enter.max(-depth / speed);
            } else if speed < 0.0 {
                leave = leave.min(-depth / speed);
            } else if depth < 0.0 {
                enter = f64::INFINITY;
            }
        };
        for axis in 0..3 {
            bound(origin[axis] - self.low[axis], direction[axis]);
            bound(self.high[axis] - origin[axis], -direction[axis]);
        }
        if let Some(plane) = &self.plane {
            bound(plane.signed_distance(origin), -plane.normal.dot(direction));
        }
        RayInterval { enter, leave }
    }

    /// Returns true if a point lies inside the region or on its boundary.
    pub fn contains(&self, point: DVec3) -> bool {
        let in_box = point.cmpge(self.low).all() && point.cmple(self.high).all();
        in_box && self.plane.is_none_or(|plane| plane.signed_distance(point) >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_enter_and_leave() {
        let half = HalfSpace { normal: DVec3::new(0.6, 0.8, 0.0), offset: 3.0 };
        let region = ClipRegion { low: DVec3::splat(-1.0), high: DVec3::splat(4.0), plane: Some(half) };
        assert_eq!(
            region.ray_interval(DVec3::new(-3.0, 0.0, 0.0), DVec3::X),
            RayInterval { enter: 2.0, leave: 7.0 }
        );
        assert_eq!(
            region.ray_interval(DVec3::new(-3.0, 0.0, 0.0), DVec3::X * 2.0),
            RayInterval { enter: 1.0, leave: 3.5 }
        );
        assert_eq!(
            region.ray_interval(DVec3::new(0.0, 0.0, 9.0), DVec3::NEG_Z),
            RayInterval { enter: 5.0, leave: 10.0 }
        );
        let RayInterval { enter, leave } = region.ray_interval(DVec3::new(4.0, 4.0, 0.0), DVec3::Z);
        assert!(enter > leave, "outside the plane");
        let RayInterval { enter, leave } = region.ray_interval(DVec3::new(9.0, 0.0, 0.0), DVec3::Z);
        assert!(enter > leave, "outside the box");
        for at in [0.5, 2.5, 6.5, 7.5] {
            let point = DVec3::new(at - 3.0, 0.0, 0.0);
            assert_eq!(region.contains(point), (2.0..=7.0).contains(&at), "{at}");
        }
    }

    #[test]
    fn a_part_within_a_box_is_in_both() {
        let half = HalfSpace { normal: DVec3::Z, offset: 0.5 };
        let region =
            ClipRegion { low: DVec3::splat(-9.0), high: DVec3::new(2.0, 9.0, 9.0), plane: Some(half) };
        let within = region.intersection(&Aabb { min: DVec3::ZERO, max: DVec3::splat(3.0) });
        assert_eq!((within.low, within.high), (DVec3::ZERO, DVec3::new(2.0, 3.0, 3.0)));
        assert_eq!(within.plane, Some(half));
    }

    #[test]
    fn everything_is_everywhere() {
        let RayInterval { enter, leave } =
            ClipRegion::UNBOUNDED.ray_interval(DVec3::ZERO, DVec3::new(0.3, 0.0, -1.0));
        assert_eq!((enter, leave), (f64::NEG_INFINITY, f64::INFINITY));
        assert!(ClipRegion::UNBOUNDED.contains(DVec3::splat(1e30)));
    }
}
