//! Cells of a light volume that samples look up at the end of their near-field rays.
//!
//! All near-field rays have the same length, so the part of a light volume that they need is the part visible through
//! the transfer functions, moved towards the light: no more cells than without a near field.

use glam::DVec3;

use crate::plan::{CellSet, lookup_reach};
use chiaroscuro_scene::{LightGeometry, SceneLight};
use chiaroscuro_volume::math::SceneSpace;

/// Edge of a cell, in voxels.
const CELL_EDGE: f64 = 2.0;

/// Offset in cells of 2³ voxels from samples to their lookups: a range along each axis, both ends included.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NearFieldOffset {
    /// Smallest offset along each axis.
    pub min: [i8; 3],
    /// Largest offset along each axis.
    pub max: [i8; 3],
}

impl NearFieldOffset {
    /// Computes the offsets of lookups at a distance of `way` (in scene units) from their samples, towards a light or
    /// at it.
    ///
    /// A cell that moves by s cells comes to lie across two: the offset is that of the one it overlaps more, and
    /// [`Self::lookup_margin`] covers the other.
    pub fn towards_light(light: &SceneLight, scene: &SceneSpace, distance: f64) -> Self {
        let radius = scene.support_radius();
        let place = DVec3::from(light.position);
        let (axis, spread_rad, stays) = match light.kind {
            LightGeometry::Parallel => (light.direction(), 0.0, false),
            // From anywhere in the bounding sphere, the direction to the light differs at most by this angle from
            // that at its centre.
            LightGeometry::Perspective if place.length() > radius + distance => {
                (place.normalize(), (radius / place.length()).asin(), false)
            }
            LightGeometry::Perspective => (DVec3::Z, std::f64::consts::PI, true),
        };
        // Displacement along each axis of the grid, in cells.
        let to_index = scene.index_from_scene.matrix3.transpose() * (distance / CELL_EDGE);
        let [x, y, z] = [to_index.x_axis, to_index.y_axis, to_index.z_axis].map(|row| {
            let angle_rad = row.angle_between(axis);
            let nearest = (angle_rad - spread_rad).max(0.0).cos() * row.length();
            let farthest = (angle_rad + spread_rad).min(std::f64::consts::PI).cos() * row.length();
            let (low, high) = if stays { (farthest.min(0.0), nearest.max(0.0)) } else { (farthest, nearest) };
            ((low - 0.5).ceil() as i8, (high - 0.5).ceil() as i8)
        });
        Self { min: [x.0, y.0, z.0], max: [x.1, y.1, z.1] }
    }

    /// Returns how many cells around the samples' cells lookups may need in addition to the offset, for a light
    /// volume with voxels of `divisor` data voxels: the texels of a fetch; if texels are data voxels, half a cell of
    /// them is left over for displacements by fractions of a cell.
    pub fn lookup_margin(divisor: usize) -> u8 {
        lookup_reach(divisor) + u8::from(divisor > 1)
    }

    /// Returns the largest offset in cells, along any axis and direction.
    pub fn max_distance(&self) -> u8 {
        self.min.iter().chain(&self.max).map(|cells| cells.unsigned_abs()).max().unwrap_or(0)
    }

    /// Returns the cells that lookups from the cells of `set` may need, in a volume whose last cell along each axis
    /// is `last`: beyond it, fetches are clamped to the border.
    #[must_use]
    pub fn shifted_cells(&self, set: CellSet, last: [usize; 3]) -> CellSet {
        let mut moved = set;
        for (axis, &last) in last.iter().enumerate() {
            let (least, most) = (self.min[axis], self.max[axis]);
            for _ in 0..least.unsigned_abs() {
                moved = moved.shifted(axis, least > 0, last);
            }
            for _ in least..most {
                let next = moved.shifted(axis, true, last);
                moved = moved.union(&next);
            }
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::CellDistances;
    use glam::DAffine3;

    fn scene() -> SceneSpace {
        SceneSpace::new([40, 30, 20], DAffine3::from_scale(DVec3::new(1.0, 1.2, 2.0)))
    }

    fn light(kind: LightGeometry, position: [f64; 3]) -> SceneLight {
        SceneLight { kind, position, ..SceneLight::default() }
    }

    /// Returns the cells that lookups of samples all over a cell read, in light volumes with voxels of `divisor` data
    /// voxels: cells of the light volume's grid.
    fn cells_looked_up(
        light: &SceneLight,
        way: f64,
        sample_cell: [usize; 3],
        divisor: usize,
    ) -> Vec<[usize; 3]> {
        let scene = scene();
        let mut cells = Vec::new();
        for at in 0..125 {
            let fraction = DVec3::new(f64::from(at % 5), f64::from(at / 5 % 5), f64::from(at / 25)) / 4.0;
            let sample = (DVec3::from(sample_cell.map(|c| c as f64)) + fraction * (1.0 - 1e-9)) * CELL_EDGE;
            let place = scene.scene_from_index.transform_point3(sample);
            let away = match light.kind {
                LightGeometry::Parallel => light.direction() * way,
                LightGeometry::Perspective => (DVec3::from(light.position) - place).clamp_length_max(way),
            };
            let lookup = sample + scene.index_from_scene.transform_vector3(away);
            let texel = (lookup + 0.5) / divisor as f64 - 0.5;
            for corner in 0..8 {
                let voxel: [usize; 3] = std::array::from_fn(|axis| {
                    let last = scene.dims[axis].div_ceil(divisor) as f64 - 1.0;
                    (texel[axis].floor() + f64::from(corner >> axis & 1)).clamp(0.0, last) as usize
                });
                cells.push(voxel.map(|v| v / 2));
            }
        }
        cells
    }

    #[test]
    fn no_lookup_is_missed() {
        let scene = scene();
        let dims = scene.dims.map(|n| n.div_ceil(8));
        let last = scene.dims.map(|n| (n - 1) / 2);
        for (kind, position) in [
            (LightGeometry::Parallel, [1.0, 0.0, 0.0]),
            (LightGeometry::Parallel, [-1.0, 2.0, 0.3]),
            (LightGeometry::Parallel, [0.3, -0.7, -2.0]),
            (LightGeometry::Perspective, [2.5, 2.0, -1.0]),
            (LightGeometry::Perspective, [-30.0, 2.0, 1.0]),
            (LightGeometry::Perspective, [0.2, 0.1, 0.3]),
        ] {
            let light = light(kind, position);
            for (divisor, sample_cell) in [1, 2, 4]
                .into_iter()
                .flat_map(|d| [[0, 0, 0], [7, 5, 4], [19, 14, 9], [0, 14, 3]].map(|c| (d, c)))
            {
                let way = (3.0 + 0.5 * divisor as f64) * scene.smallest_edge();
                let ahead = NearFieldOffset::towards_light(&light, &scene, way);
                let mut set = CellSet { dims, masks: vec![0; dims.iter().product()] };
                set.insert(sample_cell);
                let around = CellDistances::from_set(&set).cells_within(
                    NearFieldOffset::lookup_margin(divisor),
                    1,
                    dims,
                );
                let coarse = scene.dims.map(|n| n.div_ceil(8 * divisor));
                let needed = ahead.shifted_cells(around, last).coarsened(divisor, coarse);
                for cell in cells_looked_up(&light, way, sample_cell, divisor) {
                    assert!(
                        needed.contains(cell),
                        "{position:?} 1/{divisor}: {sample_cell:?} looks into {cell:?}"
                    );
                }
            }
        }
    }

    /// Compares with dilation: near-field rays 3½ voxels long would need all cells up to two cells further around.
    #[test]
    fn a_parallel_light_needs_no_more_cells() {
        let (scene, dims) = (scene(), [5, 4, 3]);
        let ahead = NearFieldOffset::towards_light(
            &light(LightGeometry::Parallel, [1.0, 2.0, 3.0]),
            &scene,
            3.5 * scene.smallest_edge(),
        );
        let mut set = CellSet { dims, masks: vec![0; dims.iter().product()] };
        set.insert([9, 7, 5]);
        let around = CellDistances::from_set(&set).cells_within(NearFieldOffset::lookup_margin(1), 1, dims);
        assert_eq!((around.count(), ahead.shifted_cells(around, [19, 14, 9]).count()), (27, 27));
        assert_ne!(ahead, NearFieldOffset::default());
    }
}
