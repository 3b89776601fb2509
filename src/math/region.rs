//! Convex parts of a grid: a box along its axes, cut by a plane.

use glam::DVec3;

use super::Bounds;

/// A half-space: all points with normal · p ≤ offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// Of length 1; it points to what is not part of it.
    pub normal: DVec3,
    /// Of the plane from the origin, along the normal.
    pub offset: f64,
}

impl HalfSpace {
    /// How far a point lies within; negative outside.
    pub fn depth_of(&self, point: DVec3) -> f64 {
        self.offset - self.normal.dot(point)
    }
}

/// A convex part of index space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Nothing lies below this along any axis; minus infinity where nothing is cut.
    pub low: DVec3,
    /// Nor above this.
    pub high: DVec3,
    /// Nor outside this.
    pub plane: Option<HalfSpace>,
}

impl Region {
    /// All of space.
    pub const EVERYTHING: Self = Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY, plane: None };

    /// What of it lies within a box.
    #[must_use]
    pub fn within(&self, bounds: &Bounds) -> Self {
        Self { low: self.low.max(bounds.min), high: self.high.min(bounds.max), plane: self.plane }
    }

    /// Where a ray enters and where it leaves, in lengths of its direction; the first is the larger one if it
    /// never enters.
    pub fn span(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        // Each bound: how far the origin lies within it, and how fast the ray gets deeper.
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
            bound(plane.depth_of(origin), -plane.normal.dot(direction));
        }
        (enter, leave)
    }

    /// Whether a point is part of it.
    pub fn contains(&self, point: DVec3) -> bool {
        let in_box = point.cmpge(self.low).all() && point.cmple(self.high).all();
        in_box && self.plane.is_none_or(|plane| plane.depth_of(point) >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_enter_and_leave() {
        let half = HalfSpace { normal: DVec3::new(0.6, 0.8, 0.0), offset: 3.0 };
        let region = Region { low: DVec3::splat(-1.0), high: DVec3::splat(4.0), plane: Some(half) };
        assert_eq!(region.span(DVec3::new(-3.0, 0.0, 0.0), DVec3::X), (2.0, 7.0));
        assert_eq!(region.span(DVec3::new(-3.0, 0.0, 0.0), DVec3::X * 2.0), (1.0, 3.5));
        assert_eq!(region.span(DVec3::new(0.0, 0.0, 9.0), DVec3::NEG_Z), (5.0, 10.0));
        let (enter, leave) = region.span(DVec3::new(4.0, 4.0, 0.0), DVec3::Z);
        assert!(enter > leave, "outside the plane");
        let (enter, leave) = region.span(DVec3::new(9.0, 0.0, 0.0), DVec3::Z);
        assert!(enter > leave, "outside the box");
        for at in [0.5, 2.5, 6.5, 7.5] {
            let point = DVec3::new(at - 3.0, 0.0, 0.0);
            assert_eq!(region.contains(point), (2.0..=7.0).contains(&at), "{at}");
        }
    }

    #[test]
    fn a_part_within_a_box_is_in_both() {
        let half = HalfSpace { normal: DVec3::Z, offset: 0.5 };
        let region = Region { low: DVec3::splat(-9.0), high: DVec3::new(2.0, 9.0, 9.0), plane: Some(half) };
        let within = region.within(&Bounds { min: DVec3::ZERO, max: DVec3::splat(3.0) });
        assert_eq!((within.low, within.high), (DVec3::ZERO, DVec3::new(2.0, 3.0, 3.0)));
        assert_eq!(within.plane, Some(half));
    }

    #[test]
    fn everything_is_everywhere() {
        let (enter, leave) = Region::EVERYTHING.span(DVec3::ZERO, DVec3::new(0.3, 0.0, -1.0));
        assert_eq!((enter, leave), (f64::NEG_INFINITY, f64::INFINITY));
        assert!(Region::EVERYTHING.contains(DVec3::splat(1e30)));
    }
}
