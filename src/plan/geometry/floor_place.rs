//! Where a floor lies, and maps of it.

use glam::DVec3;

use crate::data::{BRICK_EDGE, CELL_EDGE};
use crate::math::SceneSpace;
use crate::model::{SceneAxis, Settings};
use crate::plan::BrickSet;

/// How far a map reaches from the middle of the floor, in scene units: beyond, a volume hides next to nothing.
const REACH: f64 = 3.0;

/// So many voxels below a floor at least does something lie under it: of what stands there, kernels reach two further down, and
/// cells are two high.
const HARDLY_BELOW: f64 = 4.0;

/// Cells along the edge of a brick.
const PER_BRICK: usize = BRICK_EDGE / CELL_EDGE;

/// Where a floor lies that takes light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorPlace {
    /// From the middle of the scene upwards.
    pub height: f64,
    /// The axis of the scene that points up.
    pub up: SceneAxis,
}

/// Texels of a map in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorTexels {
    /// Middle of the first.
    pub origin: DVec3,
    /// From one to the next along both edges.
    pub along: [DVec3; 2],
}

impl FloorPlace {
    /// That of a look; `None` where there is no floor.
    pub fn of(settings: &Settings) -> Option<Self> {
        let Settings { floor, camera, .. } = settings;
        floor.on.then_some(Self { height: floor.height, up: camera.up })
    }

    /// Whether something of a volume lies under it: one of the cells in these bricks, of which `is_occupied` knows.
    pub fn has_below(
        self,
        scene: &SceneSpace,
        bricks: &BrickSet,
        is_occupied: impl Fn([usize; 3]) -> bool,
    ) -> bool {
        let up = self.up.direction();
        let axes = scene.scene_from_index.matrix3.to_cols_array_2d().map(DVec3::from);
        // How far the highest corner of a cube of so many voxels is above its middle.
        let rise = |edge: f64| axes.iter().map(|axis| 0.5 * edge * axis.dot(up).abs()).sum::<f64>();
        // Whether a brick or a cell is, so many voxels down.
        let is_below = |at: [usize; 3], edge: usize, down: f64| {
            let edge = edge as f64;
            let middle = DVec3::from(at.map(|at| (at as f64 + 0.5) * edge - 0.5));
            let height = scene.scene_from_index.transform_point3(middle).dot(up);
            height + rise(edge + 2.0 * down) < self.height
        };
        let cells_of = |brick: [usize; 3]| {
            (0..PER_BRICK.pow(3)).map(move |at| {
                let within = [at % PER_BRICK, at / PER_BRICK % PER_BRICK, at / (PER_BRICK * PER_BRICK)];
                std::array::from_fn(|axis| brick[axis] * PER_BRICK + within[axis])
            })
        };
        let mut cells =
            bricks.positions().filter(|brick| is_below(*brick, BRICK_EDGE, 0.0)).flat_map(cells_of);
        cells.any(|cell| is_below(cell, CELL_EDGE, HARDLY_BELOW) && is_occupied(cell))
    }

    /// Two directions along it, and up.
    fn axes(self) -> [DVec3; 3] {
        let upright = self.up.scene_from_upright();
        [upright * DVec3::X, upright * DVec3::Y, self.up.direction()]
    }

    /// As many texels along an edge of a map as are so long in scene units.
    pub fn texels_of(length: f64) -> u32 {
        (2.0 * REACH / length).ceil() as u32
    }

    /// The texels of a map with `edge` of them along each edge.
    pub fn texels(self, edge: u32) -> FloorTexels {
        let [right, front, up] = self.axes();
        let texel = 2.0 * REACH / f64::from(edge);
        FloorTexels {
            origin: up * self.height - (right + front) * (REACH - 0.5 * texel),
            along: [right * texel, front * texel],
        }
    }

    /// From scene space to texture coordinates of a map: vectors, and what is added.
    pub fn lookup(self) -> [[f32; 4]; 2] {
        let map = |axis: DVec3| (axis / (2.0 * REACH)).extend(0.5).as_vec4().into();
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
        for (length, edge) in [(2.0 * REACH / 300.0, 300), (2.0 * REACH / 300.5, 301)] {
            assert_eq!(FloorPlace::texels_of(length), edge);
        }
    }

    #[test]
    fn what_reaches_a_little_below_a_floor_does_not_lie_under_it() {
        let scene = SceneSpace::new([24; 3], glam::DAffine3::IDENTITY);
        let all = BrickSet::new([3; 3], vec![true; 27]);
        // Through the middle of a brick, and above the brick at the bottom: under it lie 12 and 8 voxels.
        for voxels in [12, 8] {
            let height = scene.scene_from_index.transform_point3(DVec3::splat(voxels as f64 - 0.4)).z;
            let place = FloorPlace { height, up: SceneAxis::PlusZ };
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
            let place = FloorPlace { height: -0.7, up };
            let FloorTexels { origin, along } = place.texels(10);
            let lookup = place.lookup();
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
