//! Built-in volume `cells`: a cluster of cells pressed together, with membranes, clear insides, and nuclei.

use glam::DVec3;

use super::super::load_context::{LoadContext, LoadControl, LoadError};
use super::UnitGrid;
use super::noise::fractal;
use super::solids::{ellipsoid, smooth_step, soft_density, soft_intersection};

/// Voxel values, far enough apart for a transfer function to give each its own colour.
const PLASM: f64 = 50.0;
const MEMBRANE: f64 = 105.0;
const NUCLEUS: f64 = 195.0;
const NUCLEOLUS: f64 = 245.0;

/// Thickness of membranes, and half the gap between cells: three and a half voxels of the default size, and one.
const MEMBRANE_THICKNESS: f64 = 0.055;
const HALF_GAP: f64 = 0.016;

/// Cell of the cluster, before its neighbours press on it.
struct ClusterCell {
    centre: DVec3,
    radius: f64,
    nucleus: [f64; 3],
    nucleus_radii: [f64; 3],
}

/// Computes the voxels of the cluster, 0 … 250.
pub(super) fn voxels(
    grid: UnitGrid,
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let cells = cluster();
    grid.fill_points(context, control, |p| value(&cells, p).round() as u8)
}

/// Returns the cells: one in the middle, twelve around it as close as spheres pack, and more in front of the gaps.
fn cluster() -> Vec<ClusterCell> {
    let mut cells = Vec::new();
    // Face-centred cubic packing: sites with an even sum of coordinates.
    for site in -2..=2 {
        for row in -2..=2 {
            for column in -2i32..=2 {
                let at = DVec3::new(f64::from(column), f64::from(row), f64::from(site));
                // The first three shells of sites: distances of 0, √2 and 2.
                if (site + row + column) % 2 != 0 || at.length() > 2.01 {
                    continue;
                }
                // Irregular as what grows, from noise at places of its own for each number.
                let shift = |number: f64| fractal(at * 1.37 + number, 2);
                let centre = (at + DVec3::new(shift(0.3), shift(7.1), shift(13.7)) * 1.2) * 0.30;
                let radius = 0.275 + 0.10 * shift(21.9);
                let offset = DVec3::new(shift(31.0), shift(37.7), shift(43.3)) * 0.16;
                let size = 0.115 + 0.05 * shift(51.2);
                cells.push(ClusterCell {
                    centre,
                    radius,
                    nucleus: (centre + offset).into(),
                    nucleus_radii: [size * 1.12, size, size * 0.92],
                });
            }
        }
    }
    cells
}

/// Returns the value at `p`.
fn value(cells: &[ClusterCell], p: DVec3) -> f64 {
    let (mut nearest, mut first, mut second) = (0, f64::MAX, f64::MAX);
    for (at, cell) in cells.iter().enumerate() {
        let distance = p.distance(cell.centre) - cell.radius;
        if distance < first {
            (nearest, first, second) = (at, distance, first);
        } else {
            second = second.min(distance);
        }
    }
    // Neighbours flatten each other midway.
    let outside = soft_intersection(first, (first - second) / 2.0 + HALF_GAP, 0.08);
    let (shown, cell) = (soft_density(outside), &cells[nearest]);
    if shown == 0.0 {
        return 0.0;
    }
    let membrane = soft_density(-MEMBRANE_THICKNESS - outside);
    let grain = fractal(p * 9.0, 2);
    let plasm = PLASM * (1.0 + 0.5 * grain);
    let nucleus = ellipsoid(p, cell.nucleus, cell.nucleus_radii) + 0.02 * grain;
    let core = NUCLEUS + (NUCLEOLUS - NUCLEUS) * smooth_step(0.02, 0.05, -nucleus - 0.03);
    let inside = plasm + (core - plasm) * soft_density(nucleus);
    shown * (MEMBRANE * membrane + inside * (1.0 - membrane))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_nucleus_of_its_own() {
        let cells = cluster();
        assert_eq!(cells.len(), 19, "one, twelve around it, and six");
        for (at, cell) in cells.iter().enumerate() {
            let centre = DVec3::from(cell.nucleus);
            assert!(value(&cells, centre) >= NUCLEUS, "cell {at}");
            for other in &cells[..at] {
                assert!(centre.distance(other.nucleus.into()) > 0.2, "cell {at}");
            }
        }
    }

    #[test]
    fn membranes_part_cells_from_each_other_and_from_the_outside() {
        // Between the centres of neighbours there is a gap, and a membrane on either side of it.
        let cells = cluster();
        for (at, cell) in cells.iter().enumerate() {
            let others = cells.iter().enumerate().filter(|(other, _)| *other != at);
            let near = others
                .map(|(_, other)| other.centre)
                .min_by(|a, b| a.distance(cell.centre).total_cmp(&b.distance(cell.centre)));
            let to = near.unwrap();
            let line: Vec<f64> =
                (0..200).map(|i| value(&cells, cell.centre.lerp(to, f64::from(i) / 200.0))).collect();
            let gap = line.iter().copied().fold(f64::MAX, f64::min);
            assert!(gap < PLASM / 2.0, "cell {at}: {gap}");
        }
    }
}
