//! Built-in volume `wax`: a sitting rabbit of wax, whose ears are thin enough for light to come through.

use glam::{DMat3, DVec3};

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;
use super::solids::{ellipsoid, rod, soft_cut, soft_density, soft_union};

/// Voxel value of wax.
const WAX: f64 = 200.0;

/// Height of the plane on which the rabbit sits.
const SEAT: f64 = -0.80;

/// Computes the voxels of the rabbit, 0 … 200.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    grid.fill_points(context, control, |p| (WAX * soft_density(rabbit(p))).round() as u8)
}

/// Returns the distance from the rabbit, which looks to −x and is the same on both sides of y = 0.
fn rabbit(p: DVec3) -> f64 {
    // Half of the cube is empty: above the back, and beside the flanks.
    if p.z < SEAT || p.y.abs() > 0.5 || p.x > -0.1 && p.z > 1.05 - p.x {
        return 1.0;
    }
    let q = DVec3::new(p.x, p.y.abs(), p.z);
    let trunk = soft_union(trunk(q), head(q), 0.14);
    let limbs = soft_union(trunk, limbs(q), 0.07);
    let whole = soft_union(limbs, ear(q), 0.05);
    let eye = ellipsoid(q, [-0.545, 0.175, 0.245], [0.045, 0.04, 0.05]);
    soft_cut(whole, eye, 0.02).max(SEAT - p.z)
}

fn trunk(q: DVec3) -> f64 {
    let rump = ellipsoid(q, [0.20, 0.0, -0.36], [0.48, 0.37, 0.40]);
    let chest = ellipsoid(q, [-0.22, 0.0, -0.30], [0.30, 0.27, 0.40]);
    let tail = ellipsoid(q, [0.70, 0.0, -0.50], [0.13, 0.13, 0.13]);
    soft_union(soft_union(rump, chest, 0.25), tail, 0.05)
}

fn head(q: DVec3) -> f64 {
    let skull = ellipsoid(q, [-0.40, 0.0, 0.22], [0.26, 0.21, 0.23]);
    let muzzle = ellipsoid(q, [-0.58, 0.0, 0.13], [0.17, 0.13, 0.13]);
    let cheek = ellipsoid(q, [-0.48, 0.11, 0.12], [0.14, 0.11, 0.12]);
    soft_union(soft_union(skull, muzzle, 0.12), cheek, 0.08)
}

fn limbs(q: DVec3) -> f64 {
    let haunch = ellipsoid(q, [0.22, 0.26, -0.48], [0.31, 0.17, 0.29]);
    let hind_foot = ellipsoid(q, [-0.02, 0.30, -0.74], [0.28, 0.10, 0.09]);
    let foreleg = rod(q, [-0.36, 0.15, -0.38], [-0.42, 0.14, -0.72], [0.12, 0.085]);
    let forefoot = ellipsoid(q, [-0.48, 0.14, -0.745], [0.15, 0.085, 0.075]);
    soft_union(soft_union(haunch, hind_foot, 0.06), soft_union(foreleg, forefoot, 0.06), 0.05)
}

/// Returns the distance from an ear: a leaf of five voxels of the default size, hollow in front.
fn ear(q: DVec3) -> f64 {
    let axes = DMat3::from_rotation_y(0.42) * DMat3::from_rotation_z(-0.75) * DMat3::from_rotation_x(-0.12);
    let local = axes.transpose() * (q - DVec3::new(-0.21, 0.13, 0.62));
    let leaf = ellipsoid(local, [0.0; 3], [0.085, 0.14, 0.36]);
    let hollow = ellipsoid(local, [-0.10, 0.0, 0.03], [0.09, 0.105, 0.28]);
    soft_cut(leaf, hollow, 0.03)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_are_alike() {
        for i in 0..30i32.pow(3) {
            let p = DVec3::new(f64::from(i % 30), f64::from(i / 30 % 30), f64::from(i / 900)) / 15.0 - 1.0;
            assert_eq!(rabbit(p), rabbit(p * DVec3::new(1.0, -1.0, 1.0)), "{p}");
        }
    }

    #[test]
    fn ears_are_thin_and_the_trunk_is_thick() {
        /// Length of the material along x at a position, in units of p.
        fn thickness(y: f64, z: f64) -> f64 {
            let inside = (0..2000).filter(|&i| rabbit(DVec3::new(f64::from(i) / 1000.0 - 1.0, y, z)) < 0.0);
            inside.count() as f64 / 1000.0
        }
        let (ear, trunk) = (thickness(0.13, 0.75), thickness(0.0, -0.35));
        assert!(ear > 0.02 && ear < 0.15, "{ear}");
        assert!(trunk > 6.0 * ear, "{trunk} {ear}");
    }

    #[test]
    fn what_is_left_out_is_empty() {
        // Beyond the bounds of `rabbit` its parts are farther than a soft surface reaches.
        for i in 0..60i32.pow(3) {
            let p = DVec3::new(f64::from(i % 60), f64::from(i / 60 % 60), f64::from(i / 3600)) / 30.0 - 1.0;
            if rabbit(p) == 1.0 && p.z >= SEAT {
                let q = DVec3::new(p.x, p.y.abs(), p.z);
                let nearest = trunk(q).min(head(q)).min(limbs(q)).min(ear(q));
                // The widest blend of parts adds a quarter of its reach.
                assert!(nearest > 0.25 / 4.0, "{p}: {nearest}");
            }
        }
    }
}
