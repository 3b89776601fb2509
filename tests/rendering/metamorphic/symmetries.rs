//! Symmetries: mirrored and turned scenes have mirrored and the same pictures.

use chiaroscuro_scene::SceneAxis;
use glam::{DMat3, DVec3};

use super::{DisplayPicture, EDGE, FEW_SEEDS, MANY_SEEDS, SceneVariant, TestScene, check_relation};
use crate::thresholds::SYMMETRIC;

impl TestScene {
    /// Permutes and mirrors the voxels: axis `from[i]` becomes axis i, mirrored where `is_mirrored[i]`.
    pub(super) fn rearranged(&self, from: [usize; 3], is_mirrored: [bool; 3]) -> Self {
        let dims = from.map(|axis| self.dims[axis]);
        let [nx, ny, nz] = dims;
        let value = |at: [usize; 3]| {
            let mut old = [0; 3];
            for axis in 0..3 {
                old[from[axis]] = if is_mirrored[axis] { dims[axis] - 1 - at[axis] } else { at[axis] };
            }
            self.values[old[0] + self.dims[0] * (old[1] + self.dims[1] * old[2])]
        };
        let places = (0..nx * ny * nz).map(|at| [at % nx, at / nx % ny, at / (nx * ny)]);
        let mut changed = self.clone();
        changed.values = places.map(value).collect();
        changed.dims = dims;
        changed.spacing = DVec3::from(from.map(|axis| self.spacing[axis]));
        let crop = &mut changed.settings.cuts.crop;
        let (low, high) = (self.settings.cuts.crop.low, self.settings.cuts.crop.high);
        for axis in 0..3 {
            let (first, last) = (low[from[axis]], high[from[axis]]);
            (crop.low[axis], crop.high[axis]) =
                if is_mirrored[axis] { (1.0 - last, 1.0 - first) } else { (first, last) };
        }
        changed
    }

    fn move_lights(&mut self, linear: DMat3) {
        for light in &mut self.settings.lights {
            light.position = (linear * DVec3::from(light.position)).into();
        }
        self.settings.camera.target = (linear * DVec3::from(self.settings.camera.target)).into();
    }

    /// Mirrors the scene along an axis; without a mirror of lights and sky, it is a mistake that has to be noticed.
    pub(super) fn mirrored(&self, axis: usize, with_lights: bool) -> Self {
        let mut changed = self.rearranged([0, 1, 2], std::array::from_fn(|other| other == axis));
        let mut linear = DMat3::IDENTITY;
        linear.col_mut(axis)[axis] = -1.0;
        if with_lights {
            changed.move_lights(linear);
        } else {
            changed.settings.camera.target = (linear * DVec3::from(self.settings.camera.target)).into();
        }
        let (camera, sky) = (&mut changed.settings.camera, &mut changed.settings.sky);
        camera.roll_deg = -camera.roll_deg;
        match axis {
            0 => {
                camera.azimuth_deg = 180.0 - camera.azimuth_deg;
                sky.turn_deg = 180.0 - sky.turn_deg;
            }
            1 => {
                camera.azimuth_deg = -camera.azimuth_deg;
                sky.turn_deg = -sky.turn_deg;
            }
            _ => {
                camera.elevation_deg = -camera.elevation_deg;
                sky.tilt_deg = 180.0 - sky.tilt_deg;
            }
        }
        for light in &mut changed.settings.lights {
            light.turn_deg = -light.turn_deg;
        }
        changed
    }

    /// Turns the scene by 90° about z: x becomes y.
    pub(super) fn turned_about_z(&self) -> Self {
        let mut changed = self.rearranged([1, 0, 2], [true, false, false]);
        changed.move_lights(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z));
        changed.settings.camera.azimuth_deg += 90.0;
        changed.settings.sky.turn_deg += 90.0;
        changed
    }

    /// Exchanges the axes cyclically, by a third of a turn about the diagonal: z, which pointed up, becomes x.
    pub(super) fn turned_about_diagonal(&self) -> Self {
        let mut changed = self.rearranged([2, 0, 1], [false; 3]);
        changed.move_lights(SceneAxis::PlusX.scene_from_upright());
        changed.settings.camera.up = SceneAxis::PlusX;
        changed
    }
}

fn flipped_across(picture: &DisplayPicture) -> DisplayPicture {
    picture.chunks(EDGE as usize).flat_map(|row| row.iter().rev().copied()).collect()
}

fn flipped_over(picture: &DisplayPicture) -> DisplayPicture {
    picture.chunks(EDGE as usize).rev().flatten().copied().collect()
}

fn turned_and_mirrored(scene: &TestScene) -> Vec<SceneVariant> {
    let mirrored = |name, axis| SceneVariant::same(name, scene.mirrored(axis, true));
    vec![
        mirrored("mirrored along x", 0).expecting(flipped_across),
        mirrored("mirrored along y", 1).expecting(flipped_across),
        mirrored("mirrored along z", 2).expecting(flipped_over),
        SceneVariant::same("turned about z", scene.turned_about_z()),
        SceneVariant::same("turned about the diagonal", scene.turned_about_diagonal()),
    ]
}

#[test]
fn turned_and_mirrored_scenes_look_turned_and_mirrored() {
    check_relation(FEW_SEEDS, SYMMETRIC, turned_and_mirrored);
}

#[test]
#[ignore = "long: twenty scenes more; script/test --all runs it"]
fn many_turned_and_mirrored_scenes_look_turned_and_mirrored() {
    check_relation(MANY_SEEDS, SYMMETRIC, turned_and_mirrored);
}
