//! Combinations of signed distances: soft unions and cuts of ellipsoids, and the share of a voxel inside a surface.
//!
//! After I. Quilez, "Smooth minimum", <https://iquilezles.org/articles/smin/>.

use glam::DVec3;

/// Returns the approximate signed distance of `p` from an ellipsoid: exact for spheres, and near the surface of others
/// within the ratio of their radii.
pub(super) fn ellipsoid(p: DVec3, centre: [f64; 3], radii: [f64; 3]) -> f64 {
    let (offset, radii) = (p - DVec3::from(centre), DVec3::from(radii));
    let (near, slope) = ((offset / radii).length(), (offset / (radii * radii)).length());
    // In the centre the slope is 0, and the distance that of the nearest pole.
    if slope > 0.0 { near * (near - 1.0) / slope } else { -radii.min_element() }
}

/// Returns the signed distance of `p` from a tapered rod with round ends, with a radius at each end.
pub(super) fn rod(p: DVec3, from: [f64; 3], to: [f64; 3], radii: [f64; 2]) -> f64 {
    let (from, to) = (DVec3::from(from), DVec3::from(to));
    let axis = to - from;
    let t = ((p - from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    p.distance(from + axis * t) - (radii[0] + (radii[1] - radii[0]) * t)
}

/// Returns the smaller of two distances, blended where they differ by less than `reach`: the union of two solids with
/// a fillet.
pub(super) fn soft_union(a: f64, b: f64, reach: f64) -> f64 {
    let blend = (reach - (a - b).abs()).max(0.0) / reach;
    // A quarter makes the blend as smooth as the distances where it begins.
    a.min(b) - blend * blend * reach / 4.0
}

/// Returns the larger of two distances, blended where they differ by less than `reach`: what two solids have in
/// common, with rounded edges.
pub(super) fn soft_intersection(a: f64, b: f64, reach: f64) -> f64 {
    -soft_union(-a, -b, reach)
}

/// Returns the distance from a solid after another one was cut out of it, with a rounded rim.
pub(super) fn soft_cut(solid: f64, tool: f64, reach: f64) -> f64 {
    soft_intersection(solid, -tool, reach)
}

/// Width of soft surfaces: three voxels of the default size. Where it is fewer, the grid shows as rings on broad curves.
const SURFACE_WIDTH: f64 = 3.0 / 64.0;

/// Returns the density of a soft surface at `distance` from it, 0 … 1.
pub(super) fn soft_density(distance: f64) -> f64 {
    1.0 - smooth_step(-SURFACE_WIDTH / 2.0, SURFACE_WIDTH / 2.0, distance)
}

/// Returns 0 below `low` and 1 above `high`, and 3t² − 2t³ between.
pub(super) fn smooth_step(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_spheres_are_exact_and_of_ellipsoids_right_on_their_surface() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        near(ellipsoid(DVec3::X, [0.0; 3], [0.25; 3]), 0.75);
        near(ellipsoid(DVec3::ZERO, [0.0; 3], [0.5, 0.25, 0.75]), -0.25);
        for pole in [[0.5, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, -0.75]] {
            near(ellipsoid(pole.into(), [0.0; 3], [0.5, 0.25, 0.75]), 0.0);
        }
        near(rod(DVec3::new(0.5, 0.0, 0.5), [0.0; 3], [0.0, 0.0, 1.0], [0.1, 0.3]), 0.3);
    }

    #[test]
    fn blends_are_fillets_and_end_where_they_should() {
        for i in -20..=20 {
            let (a, b) = (f64::from(i) / 40.0, 0.1);
            let (union, cut) = (soft_union(a, b, 0.2), soft_cut(a, b, 0.2));
            assert!(union <= a.min(b) && union >= a.min(b) - 0.05 - 1e-12, "{a}: {union}");
            assert!(cut >= a.max(-b) && cut <= a.max(-b) + 0.05 + 1e-12, "{a}: {cut}");
            if (a - b).abs() >= 0.2 {
                assert_eq!(union, a.min(b));
            }
            assert_eq!(union, soft_union(b, a, 0.2));
        }
    }

    #[test]
    fn densities_fall_from_one_to_nothing_around_the_surface() {
        assert_eq!([-0.1, 0.0, 0.1].map(soft_density), [1.0, 0.5, 0.0]);
        let ramp: Vec<f64> = (-50..=50).map(|i| soft_density(f64::from(i) / 1000.0)).collect();
        assert!(ramp.windows(2).all(|pair| pair[0] >= pair[1]));
    }
}
