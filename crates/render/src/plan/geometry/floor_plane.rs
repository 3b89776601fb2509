//! Plane of the floor in the scene, and maps of light on it.

use glam::DVec3;

use crate::plan::BrickSet;
use chiaroscuro_scene::{SceneAxis, Settings};
use chiaroscuro_volume::{BRICK_EDGE, CELL_EDGE, math::SceneSpace};

/// Half the edge of a map around the middle of the floor, in scene units: beyond it, a volume hides next to nothing.
const MAP_HALF_EDGE: f64 = 3.0;

/// Minimum depth below a floor, in voxels, at which a cell counts as below it: kernels of material that stands on the
/// floor reach two voxels further down, and cells are two voxels high.
const MIN_DEPTH_BELOW: f64 = 4.0;

/// Cells along the edge of a brick.
const PER_BRICK: usize = BRICK_EDGE / CELL_EDGE;

/// Plane of a floor that receives light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorPlane {
    /// Height above the middle of the scene, in scene units.
    pub height: f64,
    /// Axis of the scene that points up.
    pub up: SceneAxis,
}

/// Positions of a map's texels in scene space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorTexels {
    /// Centre of the first texel.
    pub origin: DVec3,
    /// Steps from texel to texel along both edges.
    pub along: [DVec3; 2],
}

impl FloorPlane {
    /// Returns the floor of a look; `None` if it is off.
    pub fn from_settings(settings: &Settings) -> Option<Self> {
        let Settings { floor, camera, .. } = settings;
        floor.on.then_some(Self { height: floor.height, up: camera.up })
    }

    /// Returns true if part of the volume is below the floor: any occupied cell, according to `is_occupied`, in these
    /// bricks.
    pub fn has_below(
        self,
        scene: &SceneSpace,
        bricks: &BrickSet,
        is_occupied: impl Fn([usize; 3]) -> bool,
    ) -> bool {
        let up = self.up.direction();
        // Heights are linear in index space.
        let rise_per_voxel = scene.scene_from_index.matrix3.transpose() * up;
        let first_height = scene.scene_from_index.translation.dot(up);
        let corner = 0.5 * rise_per_voxel.abs().element_sum();
        // True if a brick or cell lies completely below the floor, at least `down` voxels deep.
        let is_below = |at: [usize; 3], edge: usize, down: f64| {
            let edge = edge as f64;
            let middle = DVec3::from(at.map(|at| (at as f64 + 0.5) * edge - 0.5));
            first_height + rise_per_voxel.dot(middle) + corner * (edge + 2.0 * down) < self.height
        };
        let cells_of = |brick: [usize; 3]| {
            (0..PER_BRICK.pow(3)).map(move |at| {
                let within = [at % PER_BRICK, at / PER_BRICK % PER_BRICK, at / (PER_BRICK * PER_BRICK)];
                std::array::from_fn(|axis| brick[axis] * PER_BRICK + within[axis])
            })
        };
        // The lowest brick of a row is at one of its ends.
        let ends = [0, bricks.dims[0].saturating_sub(1)];
        let rows =
            bricks.positions_in_rows(|[y, z]| ends.iter().any(|&x| is_below([x, y, z], BRICK_EDGE, 0.0)));
        let mut cells = rows.filter(|brick| is_below(*brick, BRICK_EDGE, 0.0)).flat_map(cells_of);
        cells.any(|cell| is_below(cell, CELL_EDGE, MIN_DEPTH_BELOW) && is_occupied(cell))
    }

    /// Returns two directions along the floor, and up.
    fn axes(self) -> [DVec3; 3] {
        let upright = self.up.scene_from_upright();
        [upright * DVec3::X, upright * DVec3::Y, self.up.direction()]
    }

    /// Returns the number of texels along a map's edge for texels of a length in scene units.
    pub fn texel_count(length: f64) -> u32 {
        (2.0 * MAP_HALF_EDGE / length).ceil() as u32
    }

    /// Returns the texels of a map with `edge` texels along each edge.
    pub fn texels(self, edge: u32) -> FloorTexels {
        let [right, front, up] = self.axes();
        let texel = 2.0 * MAP_HALF_EDGE / f64::from(edge);
        FloorTexels {
            origin: up * self.height - (right + front) * (MAP_HALF_EDGE - 0.5 * texel),
            along: [right * texel, front * texel],
        }
    }

    /// Returns the transform from scene space to texture coordinates of a map: two rows, each a vector and an offset.
    pub fn texture_from_scene(self) -> [[f32; 4]; 2] {
        let map = |axis: DVec3| (axis / (2.0 * MAP_HALF_EDGE)).extend(0.5).as_vec4().into();
        let [right, front, _] = self.axes();
        [map(right), map(front)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    #[test]
    fn texels_of_a_length_cover_a_map() {
        for (length, edge) in [(2.0 * MAP_HALF_EDGE / 300.0, 300), (2.0 * MAP_HALF_EDGE / 300.5, 301)] {
            assert_eq!(FloorPlane::texel_count(length), edge);
        }
    }

    #[test]
    fn what_reaches_a_little_below_a_floor_does_not_lie_under_it() {
        let scene = SceneSpace::new([24; 3], glam::DAffine3::IDENTITY);
        let all = BrickSet::new([3; 3], vec![true; 27]);
        // A floor through the middle of a brick, and one at a brick's lower face: 12 and 8 voxels are below them.
        for voxels in [12, 8] {
            let height = scene.scene_from_index.transform_point3(DVec3::splat(voxels as f64 - 0.4)).z;
            let place = FloorPlane { height, up: SceneAxis::PlusZ };
            let has_below = |is_occupied: &dyn Fn(usize) -> bool| {
                place.has_below(&scene, &all, |[.., z]| is_occupied(z * CELL_EDGE))
            };
            assert!(!has_below(&|z| z >= voxels - 4), "{voxels}: what stands there");
            assert!(has_below(&|z| z == 0), "{voxels}: something at the bottom");
            assert!(!place.has_below(&scene, &BrickSet::new([3; 3], vec![false; 27]), |_| true));
        }
    }

    #[test]
    fn texels_are_looked_up_in_their_middles() {
        for up in [SceneAxis::PlusZ, SceneAxis::MinusY] {
            let place = FloorPlane { height: -0.7, up };
            let FloorTexels { origin, along } = place.texels(10);
            let lookup = place.texture_from_scene();
            for (x, y) in [(0.0, 0.0), (3.0, 9.0)] {
                let at = (origin + along[0] * x + along[1] * y).as_vec3().extend(1.0);
                let found = lookup.map(|row| f64::from(Vec4::from(row).dot(at)));
                assert!((found[0] - (x + 0.5) / 10.0).abs() < 1e-6, "{found:?}");
                assert!((found[1] - (y + 0.5) / 10.0).abs() < 1e-6, "{found:?}");
                assert!((at.truncate().as_dvec3().dot(up.direction()) + 0.7).abs() < 1e-6);
            }
        }
    }
}
