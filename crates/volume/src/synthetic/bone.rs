//! Built-in volume `bone`: a carved form with a dense wall and a spongy inside, which its openings expose.

use glam::DVec3;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;
use super::noise::fractal;
use super::solids::{ellipsoid, rod, soft_cut, soft_density, soft_union};

/// Voxel value of the spongy inside.
const SPONGE: f64 = 150.0;

/// Mean voxel value of the wall, and by how much growth makes it vary: it stays above [`SPONGE`].
const WALL: [f64; 2] = [215.0, 50.0];

/// Thickness of the wall: five voxels of the default size.
const WALL_THICKNESS: f64 = 0.08;

/// Period of the struts inside: fifteen voxels of the default size, half of them struts.
const STRUT_PERIOD: f64 = 0.23;

/// Computes the voxels of the form, 0 … 255.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    grid.fill_points(context, control, |p| value(p).round() as u8)
}

/// Returns the value at `p`.
fn value(p: DVec3) -> f64 {
    let body = body(p);
    // The density of what is left is 0 where that of the whole is.
    if soft_density(body) == 0.0 {
        return 0.0;
    }
    let carved = openings(p).into_iter().fold(body, |solid, tool| soft_cut(solid, tool, 0.07));
    let shown = soft_density(carved);
    if shown == 0.0 {
        return 0.0;
    }
    // The wall follows the form as it grew; what was carved later cuts through it.
    let wall = soft_density(-WALL_THICKNESS - body);
    let [mean, growth] = WALL;
    let dense = if wall > 0.0 { mean + growth * fractal(p * DVec3::new(5.0, 5.0, 1.6), 3) } else { 0.0 };
    let sponge = if wall < 1.0 { SPONGE * soft_density(struts(p)) } else { 0.0 };
    shown * (dense * wall + sponge * (1.0 - wall))
}

/// Returns the distance from the outside of the form: two swellings on a broad foot, joined by a waist.
fn body(p: DVec3) -> f64 {
    let foot = ellipsoid(p, [-0.10, 0.02, -0.52], [0.60, 0.46, 0.34]);
    let middle = ellipsoid(p, [-0.26, 0.0, -0.08], [0.40, 0.34, 0.46]);
    let head = ellipsoid(p, [0.16, -0.02, 0.46], [0.50, 0.36, 0.36]);
    let limb = rod(p, [0.42, 0.0, -0.45], [0.50, -0.02, 0.40], [0.20, 0.17]);
    let joined = soft_union(soft_union(foot, middle, 0.3), soft_union(head, limb, 0.25), 0.3);
    // Flat below, where it stands.
    soft_cut(joined, p.z + 0.78, 0.06)
}

/// Returns the distances from the tools that carve it: tunnels from front to back, a bowl, and a plane across the head.
fn openings(p: DVec3) -> [f64; 5] {
    [
        rod(p, [0.14, -1.0, -0.05], [0.12, 1.0, 0.02], [0.24, 0.20]),
        rod(p, [0.24, -1.0, 0.46], [0.26, 1.0, 0.56], [0.17, 0.15]),
        rod(p, [-0.30, -1.0, -0.28], [-0.22, 1.0, -0.20], [0.15, 0.13]),
        ellipsoid(p, [-0.34, -0.36, -0.62], [0.22, 0.30, 0.14]),
        0.44 - p.dot(DVec3::new(-0.35, -0.56, 0.75)),
    ]
}

/// Returns the distance from the struts of the inside: a gyroid, which is as sponges are in one piece with its holes.
fn struts(p: DVec3) -> f64 {
    let scale = std::f64::consts::TAU / STRUT_PERIOD;
    let q = (p + 0.05 * fractal(p * 2.0, 2)) * scale;
    let (s, c) = (DVec3::new(q.x.sin(), q.y.sin(), q.z.sin()), DVec3::new(q.x.cos(), q.y.cos(), q.z.cos()));
    // The gradient of the sum is about 1.5 per unit of q where it is 0.
    (s.x * c.y + s.y * c.z + s.z * c.x) / (1.5 * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wall_is_denser_than_what_it_encloses() {
        // Inwards from the right, below all openings.
        let along = |depth: f64| value(DVec3::new(0.75 - depth, 0.0, -0.55));
        let samples: Vec<f64> = (0..400).map(|i| along(f64::from(i) / 400.0)).collect();
        let first = samples.iter().position(|&value| value > 0.0).unwrap();
        let wall = samples[first..].iter().copied().take(60).fold(0.0, f64::max);
        assert!(wall > SPONGE + 20.0 && wall <= 255.0, "{wall}");
        let inside = &samples[first + 60..];
        assert!(inside.iter().all(|&value| value <= SPONGE + 1e-9), "no wall inside");
        assert!(
            inside.contains(&0.0) && inside.iter().any(|&value| value > SPONGE - 1.0),
            "struts and holes"
        );
    }

    #[test]
    fn tunnels_go_through() {
        for (x, z) in [(0.13, -0.015), (0.25, 0.51), (-0.26, -0.24)] {
            assert!((-40..=40).all(|i| value(DVec3::new(x, f64::from(i) / 40.0, z)) == 0.0), "{x} {z}");
        }
    }
}
