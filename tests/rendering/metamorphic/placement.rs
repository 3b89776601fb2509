//! Placement of the same voxels in larger and smaller grids: empty space is not seen.

use chiaroscuro_scene::{LightGeometry, LightShape, Settings};
use glam::DVec3;

use super::random_scenes::EMPTY_MARGIN;
use super::{FEW_SEEDS, MANY_SEEDS, SceneVariant, TestScene, check_prepared, check_relation};
use crate::thresholds::{CROPPED, PADDED, SHIFTED};

impl TestScene {
    /// Adds empty voxels before and behind the others, or removes them where the numbers are negative; everything
    /// else stays where it was.
    pub(super) fn padded(&self, before: [i32; 3], behind: [i32; 3]) -> Self {
        let dims: [usize; 3] =
            std::array::from_fn(|axis| (self.dims[axis] as i32 + before[axis] + behind[axis]) as usize);
        let [nx, ny, nz] = dims;
        let value = |at: [usize; 3]| {
            let old: [i32; 3] = std::array::from_fn(|axis| at[axis] as i32 - before[axis]);
            let is_inside = (0..3).all(|axis| (0..self.dims[axis] as i32).contains(&old[axis]));
            let index = || {
                let [x, y, z] = old.map(|c| c as usize);
                x + self.dims[0] * (y + self.dims[1] * z)
            };
            if is_inside { self.values[index()] } else { 0 }
        };
        let places = (0..nx * ny * nz).map(|at| [at % nx, at / nx % ny, at / (nx * ny)]);
        let mut changed = Self { values: places.map(value).collect(), dims, ..self.clone() };
        let scale = self.mm_per_unit() / changed.mm_per_unit();
        // The old middle in the new scene.
        let middle: [f64; 3] = std::array::from_fn(|axis| {
            let in_voxels = (f64::from(before[axis]) - f64::from(behind[axis])) / 2.0;
            in_voxels * self.spacing[axis] / changed.mm_per_unit()
        });
        let middle = DVec3::from(middle);
        let moved = |place: [f64; 3]| (DVec3::from(place) * scale + middle).into();
        let settings = &mut changed.settings;
        settings.camera.target = moved(settings.camera.target);
        settings.camera.distance *= scale;
        for light in &mut settings.lights {
            if light.kind == LightGeometry::Perspective {
                light.position = moved(light.position);
                light.size *= scale;
            }
        }
        let crop = &mut settings.cuts.crop;
        for axis in 0..3 {
            let place =
                |bound: f64| (bound * self.dims[axis] as f64 + f64::from(before[axis])) / dims[axis] as f64;
            (crop.low[axis], crop.high[axis]) = (place(crop.low[axis]), place(crop.high[axis]));
        }
        changed
    }
}

fn padded_scenes(scene: &TestScene) -> Vec<SceneVariant> {
    vec![SceneVariant::same("five voxels around", scene.padded([5; 3], [5; 3]))]
}

/// Removes four voxels on each side: whole blocks at every resolution.
fn cropped_scenes(scene: &TestScene) -> Vec<SceneVariant> {
    let all = -(EMPTY_MARGIN as i32);
    vec![SceneVariant::same("without the empty margin", scene.padded([all; 3], [all; 3]))]
}

/// Adds voxels before x and y, and behind z: half a block at most resolutions, and parts of slabs.
fn shifted_scenes(scene: &TestScene) -> Vec<SceneVariant> {
    let shifted =
        |name, voxels: i32| SceneVariant::same(name, scene.padded([voxels, voxels, 0], [0, 0, voxels]));
    vec![shifted("one voxel aside", 1), shifted("two voxels aside", 2), shifted("three voxels aside", 3)]
}

/// Makes points of perspective lights with a size: they face the middle of the volume, and turn when that moves.
fn use_points(settings: &mut Settings) {
    for light in settings.lights.iter_mut().filter(|light| light.kind == LightGeometry::Perspective) {
        light.shape = LightShape::Point;
    }
}

#[test]
fn empty_space_around_is_not_seen() {
    check_relation(FEW_SEEDS, PADDED, padded_scenes);
}

#[test]
fn empty_space_can_be_cropped() {
    check_relation(FEW_SEEDS, CROPPED, cropped_scenes);
}

#[test]
fn scenes_can_be_shifted_against_slabs_and_blocks() {
    check_prepared(FEW_SEEDS, SHIFTED, use_points, shifted_scenes);
}

#[test]
#[ignore = "long: twenty scenes more; script/test --all runs it"]
fn many_scenes_can_be_padded_cropped_and_shifted() {
    check_relation(MANY_SEEDS, PADDED, padded_scenes);
    check_relation(MANY_SEEDS, CROPPED, cropped_scenes);
    check_prepared(MANY_SEEDS, SHIFTED, use_points, shifted_scenes);
}
