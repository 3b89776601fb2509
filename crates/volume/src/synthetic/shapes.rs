//! Signed distance functions of simple shapes: negative inside.
//!
//! After I. Quilez, "Distance functions", <https://iquilezles.org/articles/distfunctions/>. Those of the tapered and
//! the bowed shapes deviate from the true distance by a few percent, which a soft edge hides.

use glam::{DMat3, DVec3};

use crate::math::Aabb;

/// Geometric shape in coordinates p.
#[derive(Debug, Clone, Copy)]
pub(super) enum SdfShape {
    Sphere {
        centre: DVec3,
        radius: f64,
    },
    /// Box whose edges are rounded by `radius`; the columns of `axes` are its own axes.
    Box {
        centre: DVec3,
        axes: DMat3,
        half: DVec3,
        radius: f64,
    },
    /// Rod with round ends, tapered between a radius at each end.
    Rod {
        from: DVec3,
        to: DVec3,
        radii: [f64; 2],
    },
    /// Rounded board along x that bows to +y and rises in its middle, and leans to +y with z.
    Board {
        centre: DVec3,
        half: DVec3,
        radius: f64,
        bow: f64,
        crown: f64,
        lean: f64,
    },
}

impl SdfShape {
    /// Creates a rounded box aligned with the coordinate axes.
    pub(super) fn upright_box(centre: [f64; 3], half: [f64; 3], radius: f64) -> Self {
        Self::Box { centre: centre.into(), axes: DMat3::IDENTITY, half: half.into(), radius }
    }

    /// Creates a rod of constant radius.
    pub(super) fn rod(from: [f64; 3], to: [f64; 3], radius: f64) -> Self {
        Self::Rod { from: from.into(), to: to.into(), radii: [radius; 2] }
    }

    /// Creates a flat bar between two points that do not differ in x alone: `half_width` is along x.
    pub(super) fn bar(from: DVec3, to: DVec3, half_width: f64, half_thickness: f64, radius: f64) -> Self {
        let along = (to - from).normalize_or(DVec3::Z);
        let across = along.cross(DVec3::X).normalize_or(DVec3::Y);
        let axes = DMat3::from_cols(across.cross(along), across, along);
        let half = DVec3::new(half_width, half_thickness, from.distance(to) / 2.0);
        Self::Box { centre: (from + to) / 2.0, axes, half, radius }
    }

    /// Returns the signed distance of `p` from the surface.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        match *self {
            Self::Sphere { centre, radius } => p.distance(centre) - radius,
            Self::Box { centre, axes, half, radius } => {
                rounded_box(axes.transpose() * (p - centre), half, radius)
            }
            Self::Rod { from, to, radii: [at_from, at_to] } => {
                let axis = to - from;
                let t = ((p - from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                p.distance(from + axis * t) - (at_from + (at_to - at_from) * t)
            }
            Self::Board { centre, half, radius, bow, crown, lean } => {
                let local = p - centre;
                let t = (local.x / half.x).clamp(-1.0, 1.0);
                let arch = 1.0 - t * t;
                let straight =
                    DVec3::new(local.x, local.y - bow * arch - lean * local.z, local.z - crown * arch);
                rounded_box(straight, half, radius)
            }
        }
    }

    /// Returns a bounding box of the shape.
    pub(super) fn bounds(&self) -> Aabb {
        match *self {
            Self::Sphere { centre, radius } => Aabb { min: centre - radius, max: centre + radius },
            Self::Box { centre, axes, half, .. } => {
                let reach =
                    axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
                Aabb { min: centre - reach, max: centre + reach }
            }
            Self::Rod { from, to, radii: [at_from, at_to] } => {
                Aabb { min: (from - at_from).min(to - at_to), max: (from + at_from).max(to + at_to) }
            }
            Self::Board { centre, half, bow, crown, lean, .. } => {
                let rise = half.z + crown.abs();
                let reach = DVec3::new(half.x, half.y + bow.abs() + lean.abs() * rise, rise);
                Aabb { min: centre - reach, max: centre + reach }
            }
        }
    }
}

/// Returns the signed distance of `p` from a rounded box around the origin; `half` includes the rounding.
fn rounded_box(p: DVec3, half: DVec3, radius: f64) -> f64 {
    let q = p.abs() - (half - radius);
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - radius
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_right_where_they_are_easy() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        let sphere = SdfShape::Sphere { centre: DVec3::X, radius: 0.5 };
        near(sphere.distance(DVec3::ZERO), 0.5);
        let cube = SdfShape::upright_box([0.0; 3], [0.5; 3], 0.1);
        near(cube.distance(DVec3::X), 0.5);
        near(cube.distance(DVec3::ZERO), -0.5);
        near(cube.distance(DVec3::splat(0.5)), 0.1 * 3f64.sqrt() - 0.1);
        let rod = SdfShape::rod([0.0; 3], [0.0, 0.0, 1.0], 0.25);
        near(rod.distance(DVec3::new(1.0, 0.0, 0.5)), 0.75);
        near(rod.distance(DVec3::new(0.0, 0.0, 2.0)), 0.75);
        let bar = SdfShape::bar(DVec3::ZERO, DVec3::Y, 0.2, 0.1, 0.0);
        near(bar.distance(DVec3::new(0.5, 0.5, 0.0)), 0.3);
        near(bar.distance(DVec3::new(0.0, 0.5, 0.5)), 0.4);
        let board = SdfShape::Board {
            centre: DVec3::ZERO,
            half: DVec3::new(1.0, 0.1, 0.2),
            radius: 0.0,
            bow: 0.3,
            crown: 0.0,
            lean: 0.0,
        };
        near(board.distance(DVec3::new(0.0, 0.5, 0.0)), 0.1);
        near(board.distance(DVec3::new(1.0, 0.5, 0.0)), 0.4);
    }

    #[test]
    fn bounds_hold_the_inside() {
        let lean = SdfShape::bar(DVec3::new(0.1, 0.2, -0.3), DVec3::new(0.2, 0.5, 0.4), 0.05, 0.02, 0.01);
        let board = SdfShape::Board {
            centre: DVec3::new(0.0, 0.1, 0.2),
            half: DVec3::new(0.4, 0.03, 0.1),
            radius: 0.02,
            bow: 0.1,
            crown: 0.05,
            lean: 0.3,
        };
        let rod = SdfShape::Rod { from: DVec3::ZERO, to: DVec3::splat(0.4), radii: [0.05, 0.1] };
        for shape in [lean, board, rod] {
            let bounds = shape.bounds();
            for i in 0..40usize.pow(3) {
                let at = DVec3::new((i % 40) as f64, (i / 40 % 40) as f64, (i / 1600) as f64);
                let p = at / 20.0 - 1.0 + 0.013;
                let inside_bounds = p.cmpge(bounds.min).all() && p.cmple(bounds.max).all();
                assert!(shape.distance(p) > 0.0 || inside_bounds, "{shape:?} at {p}");
            }
        }
    }
}
