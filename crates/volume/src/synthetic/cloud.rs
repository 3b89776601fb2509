//! Built-in volume `cloud`: a cumulus of soft puffs over a flat base, roughened by fractal noise.
//!
//! After the hypertexture of K. Perlin and E. Hoffert (SIGGRAPH 1989): the density of a soft shape is modulated
//! before it is thresholded, so that the outline frays and the middle stays dense.

use glam::DVec3;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;
use super::noise::fractal;
use super::solids::smooth_step;

/// Maximum voxel value, where the cloud is densest.
const DENSEST: f64 = 220.0;

/// Centres and radii of the puffs, in units of p.
const PUFFS: [([f64; 3], [f64; 3]); 7] = [
    ([0.0, 0.0, -0.16], [0.80, 0.64, 0.42]),
    ([-0.40, -0.06, -0.04], [0.42, 0.42, 0.38]),
    ([0.40, 0.08, -0.08], [0.46, 0.44, 0.36]),
    ([-0.10, 0.05, 0.24], [0.46, 0.44, 0.46]),
    ([0.20, -0.12, 0.16], [0.40, 0.40, 0.40]),
    ([0.04, -0.32, -0.10], [0.40, 0.36, 0.32]),
    ([-0.14, 0.30, -0.06], [0.42, 0.36, 0.36]),
];

/// Computes the voxels of the cloud, 0 … 220.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    grid.fill_points(context, control, |p| (DENSEST * density(p)).round() as u8)
}

/// Returns the density at `p`, in [0, 1]; 0 outside the puffs.
fn density(p: DVec3) -> f64 {
    let body = body(p);
    if body <= 0.0 {
        return 0.0;
    }
    // Noise fades out with the body, so that the cloud ends softly inside its puffs.
    let roughness = 1.5 * (body / 0.3).min(1.0);
    smooth_step(0.15, 1.25, body + roughness * fractal(p * 2.3 + 5.1, 4))
}

/// Returns the soft union of the puffs at `p`, in [0, 1], thinned towards the flat base.
fn body(p: DVec3) -> f64 {
    let clear = PUFFS.iter().fold(1.0, |clear, (centre, radii)| {
        let offset = (p - DVec3::from_array(*centre)) / DVec3::from_array(*radii);
        clear * (1.0 - (1.0 - offset.length_squared()).max(0.0))
    });
    (1.0 - clear) * smooth_step(-0.46, -0.26, p.z)
}

#[cfg(test)]
mod tests {
    use crate::ValueRange;
    use crate::synthetic::builtin;

    #[test]
    fn the_cloud_is_soft_and_dense_inside() {
        let n = 128;
        let volume = builtin("cloud", Some(n)).unwrap();
        let ValueRange { low, high } = volume.value_range();
        assert!(low == 0.0 && high > 200.0 && high <= 220.0, "{high}");
        let mut steepest: f64 = 0.0;
        for z in 0..n {
            for y in 0..n {
                for x in 1..n {
                    steepest = steepest.max((volume.value(x, y, z) - volume.value(x - 1, y, z)).abs());
                }
            }
        }
        assert!(steepest < 80.0, "no hard edge between neighbours: {steepest}");
        let filled = (0..n.pow(3)).filter(|&voxel| volume.samples().value(voxel) > 20.0).count();
        let share = filled as f64 / n.pow(3) as f64;
        assert!(share > 0.05 && share < 0.4, "{share}");
    }
}
