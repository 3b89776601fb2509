//! From which side a volume is seen first: from the front where the file says which that is, else from where most can
//! be told about the object.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::object::Object;
use crate::data::Volume;
use crate::model::Camera;

/// In front of a patient, to the right of the face and a little above: three-quarter, as portraits are. World space is
/// right-anterior-superior.
const FRONT: (f64, f64) = (60.0, 13.0);

/// Azimuths that are tried, this far apart, at each of these elevations.
const AZIMUTH_STEP_DEG: f64 = 45.0;
const ELEVATIONS_DEG: [f64; 2] = [20.0, 40.0];

/// How much better than the usual view another must be: opening similar volumes should not jump from side to side. Views
/// that people prefer have 1.11 and more (a stent in front of the spine, a face, a skull); below 1.10 nothing is gained,
/// and a chair is looked down upon (1.02).
const CLEARLY_BETTER: f64 = 1.105;

/// What directions of normals count for, beside the visible share of the surface: a flat wall that hides what lies behind
/// it has much surface, and says little.
const NORMALS: f64 = 2.0;

/// Directions of normals are counted in so many classes along each axis of the picture.
const NORMAL_CLASSES: usize = 8;

/// Edge of a pixel of the small pictures that are compared, in cells: no gaps between cells that are neighbours.
const PIXEL: f64 = 1.5;

/// Points the camera at a volume's object from a good side; its distance is not changed.
pub(super) fn choose(camera: &mut Camera, volume: &Volume, object: &Object) {
    if volume.is_anatomical() {
        (camera.azimuth_deg, camera.elevation_deg) = FRONT;
        return;
    }
    let surface = Surface::of(volume, object);
    if surface.cells.is_empty() {
        return;
    }
    let usual = (camera.azimuth_deg, camera.elevation_deg);
    let steps = (360.0 / AZIMUTH_STEP_DEG) as usize;
    let others = ELEVATIONS_DEG.into_iter().flat_map(|elevation| {
        (0..steps).map(move |step| (usual.0 + AZIMUTH_STEP_DEG * step as f64, elevation))
    });
    let views: Vec<(f64, f64)> = std::iter::once(usual).chain(others).collect();
    let seen: Vec<Seen> = views
        .par_iter()
        .map(|&(azimuth_deg, elevation_deg)| {
            let view =
                Camera { azimuth_deg, elevation_deg, roll_deg: 0.0, ..camera.clone() }.scene_from_view();
            surface.seen_from(view)
        })
        .collect();
    let most = seen.iter().fold(Seen::default(), Seen::max);
    let scores: Vec<f64> = seen.iter().map(|one| one.score(&most)).collect();
    let best = (0..views.len()).max_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0);
    if scores[best] > CLEARLY_BETTER * scores[0] {
        let azimuth = (views[best].0 + 180.0).rem_euclid(360.0) - 180.0;
        (camera.azimuth_deg, camera.elevation_deg) = (azimuth, views[best].1);
    }
}

/// A cell of the object's surface.
struct SurfaceCell {
    /// In scene space.
    place: DVec3,
    /// Outwards, in scene space.
    normal: DVec3,
    /// It lies at a face of the volume: what is seen there is where the data end, not the object.
    is_at_face: bool,
}

/// Where the object ends.
struct Surface {
    cells: Vec<SurfaceCell>,
    /// Edge of a pixel, in scene units.
    pixel: f64,
}

/// What can be told from a view.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// Share of the surface that is visible.
    surface: f64,
    /// Entropy of the directions of its normals, in bits.
    normals: f64,
    /// Pixels that the object covers.
    area: f64,
}

impl Seen {
    fn max(self, other: &Self) -> Self {
        Self {
            surface: self.surface.max(other.surface),
            normals: self.normals.max(other.normals),
            area: self.area.max(other.area),
        }
    }

    fn score(&self, most: &Self) -> f64 {
        let share = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
        share(self.surface, most.surface)
            + NORMALS * share(self.normals, most.normals)
            + 0.5 * share(self.area, most.area)
    }
}

impl Surface {
    fn of(volume: &Volume, object: &Object) -> Self {
        let scene = volume.scene();
        // Normals are perpendicular to what is stretched.
        let normal_from_index = scene.scene_from_index.matrix3.inverse().transpose();
        let last = object.cells.map(|n| n - 1);
        let cells = object
            .all_cells()
            .filter_map(|cell| {
                let at = cell.map(|n| n as i64);
                let near = |[x, y, z]: [i64; 3]| object.is_at([at[0] + x, at[1] + y, at[2] + z]);
                let sides = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
                if sides.into_iter().all(near) {
                    return None;
                }
                let mut outwards = DVec3::ZERO;
                for (x, y, z) in
                    (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| (x, y, z))))
                {
                    if !near([x, y, z]) {
                        outwards += DVec3::new(x as f64, y as f64, z as f64);
                    }
                }
                Some(SurfaceCell {
                    place: scene.scene_from_index.transform_point3(object.middle(cell)),
                    normal: (normal_from_index * outwards).normalize_or_zero(),
                    is_at_face: (0..3).any(|axis| cell[axis] == 0 || cell[axis] == last[axis]),
                })
            })
            .collect();
        let step = |axis: usize| {
            let (one, other) = ([0; 3], [0, 1, 2].map(|n| usize::from(n == axis && object.cells[axis] > 1)));
            let place = |cell| scene.scene_from_index.transform_point3(object.middle(cell));
            place(one).distance(place(other))
        };
        let pixel = PIXEL * step(0).max(step(1)).max(step(2)).max(1e-6);
        Self { cells, pixel }
    }

    /// What is visible in a parallel projection.
    fn seen_from(&self, scene_from_view: DMat3) -> Seen {
        let view_from_scene = scene_from_view.transpose();
        let local: Vec<DVec3> = self.cells.iter().map(|cell| view_from_scene * cell.place).collect();
        let low = local.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let high = local.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
        let columns = ((high.x - low.x) / self.pixel) as usize + 1;
        let rows = ((high.y - low.y) / self.pixel) as usize + 1;
        let pixel_of = |p: &DVec3| {
            ((p.y - low.y) / self.pixel) as usize * columns + ((p.x - low.x) / self.pixel) as usize
        };
        // Nearest to the eye, which is where z grows; and whether that is the object rather than where data end.
        let mut nearest = vec![(f64::NEG_INFINITY, false); columns * rows];
        for (p, cell) in local.iter().zip(&self.cells) {
            let pixel = &mut nearest[pixel_of(p)];
            if p.z > pixel.0 {
                *pixel = (p.z, !cell.is_at_face);
            }
        }
        let mut classes = [0.0; NORMAL_CLASSES * NORMAL_CLASSES];
        let mut visible = 0.0;
        for (p, cell) in local.iter().zip(&self.cells) {
            if cell.is_at_face || p.z < nearest[pixel_of(p)].0 - self.pixel {
                continue;
            }
            visible += 1.0;
            let normal = view_from_scene * cell.normal;
            let class = |n: f64| ((n.midpoint(1.0) * NORMAL_CLASSES as f64) as usize).min(NORMAL_CLASSES - 1);
            classes[class(normal.y) * NORMAL_CLASSES + class(normal.x)] += 1.0;
        }
        let entropy =
            |count: &f64| if *count > 0.0 { -count / visible * (count / visible).log2() } else { 0.0 };
        Seen {
            surface: visible / self.cells.len() as f64,
            normals: classes.iter().map(entropy).sum(),
            area: nearest.iter().filter(|(_, is_object)| *is_object).count() as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Samples;
    use crate::model::auto::tests::shows_what_is_bright;

    /// A plate with knobs on its side of high y.
    fn plate() -> Volume {
        let dims = [48usize, 48, 48];
        let value = |at: usize| {
            let [x, y, z] = [at % dims[0], at / dims[0] % dims[1], at / dims[0] / dims[1]];
            let is_plate = (20..24).contains(&y) && (6..42).contains(&x) && (6..42).contains(&z);
            let is_knob = (24..32).contains(&y)
                && x % 12 > 5
                && z % 12 > 5
                && (6..42).contains(&x)
                && (6..42).contains(&z);
            if is_plate || is_knob { 255 } else { 0 }
        };
        let voxels = (0..dims.iter().product()).map(value).collect();
        Volume::with_spacing("plate", dims, DVec3::ONE, Samples::U8(voxels)).unwrap()
    }

    #[test]
    fn the_side_with_something_on_it_is_seen() {
        let volume = plate();
        let object = Object::shown_by(&shows_what_is_bright(), &volume);
        let mut camera = Camera::default();
        choose(&mut camera, &volume, &object);
        // The usual view is from low y.
        assert!(camera.scene_from_view().z_axis.y > 0.3, "{camera:?}");
    }

    #[test]
    fn what_stands_behind_a_wall_is_seen_from_its_side() {
        let dims = [48usize; 3];
        let value = |at: usize| {
            let [x, y, z] = [at % 48, at / 48 % 48, at / 48 / 48];
            let is_wall = (6..9).contains(&y) && (4..44).contains(&x) && (4..44).contains(&z);
            let from_middle = DVec3::new(x as f64, y as f64, z as f64).distance(DVec3::new(24.0, 24.0, 24.0));
            if is_wall || from_middle < 12.0 { 255 } else { 0 }
        };
        let voxels = (0..48 * 48 * 48).map(value).collect();
        let volume = Volume::with_spacing("wall", dims, DVec3::ONE, Samples::U8(voxels)).unwrap();
        let object = Object::shown_by(&shows_what_is_bright(), &volume);
        let mut camera = Camera::default();
        choose(&mut camera, &volume, &object);
        assert!(camera.scene_from_view().z_axis.y > 0.3, "{camera:?}");
    }

    #[test]
    fn people_are_seen_from_the_front() {
        let volume = plate().with_anatomy(true);
        let object = Object::shown_by(&shows_what_is_bright(), &volume);
        let mut camera = Camera::default();
        choose(&mut camera, &volume, &object);
        let towards_eye = camera.scene_from_view().z_axis;
        // Anterior, to the right of the face, a little from above.
        assert!(towards_eye.y > 0.7 && towards_eye.x > 0.3 && (0.15..0.3).contains(&towards_eye.z));
    }

    #[test]
    fn nothing_is_seen_from_the_usual_side() {
        let empty = Volume::with_spacing("empty", [8; 3], DVec3::ONE, Samples::U8(vec![0; 512])).unwrap();
        let object = Object::shown_by(&shows_what_is_bright(), &empty);
        let mut camera = Camera::default();
        choose(&mut camera, &empty, &object);
        assert_eq!(camera, Camera::default());
    }
}
