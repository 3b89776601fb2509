//! View selection for the first look: slices face-on, bodies from the front if the file says where that is, and other
//! objects from the most informative direction.

mod cross_section;
mod up_axis;
#[cfg(test)]
mod up_axis_tests;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::frame::face_thick_slices;
use super::object::VisibleObject;
use super::transfer::axis_across_picture;
use crate::Camera;
use chiaroscuro_volume::Volume;
pub(super) use up_axis::find_up_axis;

/// Azimuth and elevation in degrees in front of a patient, to the right of the face and a little above: a
/// three-quarter view, as in portraits. World space is right-anterior-superior.
const PATIENT_VIEW_DEG: (f64, f64) = (60.0, 13.0);

/// Ratio of a grid's shortest edge to the next below which it is flat: from the side nothing of it would be visible.
const MAX_FLATNESS_RATIO: f64 = 0.125;

/// Elevation in degrees for several slices, which shows how they are stacked; a single slice is viewed face-on.
const SLICE_ELEVATION_DEG: f64 = 25.0;

/// Candidate views: azimuths at this interval, at each of these elevations.
const AZIMUTH_STEP_DEG: f64 = 45.0;
const ELEVATIONS_DEG: [f64; 2] = [20.0, 40.0];

/// Smallest ratio of scores at which another view replaces the default one: opening similar volumes should not jump
/// from side to side. Views that people prefer have 1.11 and more (a stent in front of the spine, a face, a skull);
/// below 1.10 nothing is gained, and a chair is seen from above (1.02).
const MIN_SCORE_RATIO: f64 = 1.105;

/// Weight of the entropy of normals relative to the visible share of the surface: a flat wall that hides the rest has
/// a large surface, and little information.
const NORMALS_WEIGHT: f64 = 2.0;

/// Number of classes of normal directions along each axis of the image.
const NORMAL_CLASSES: usize = 8;

/// Edge of a pixel of the compared views, in cells: leaves no gaps between neighbouring cells.
const PIXEL_CELLS: f64 = 1.5;

/// Rotates the camera to a good view of a volume's object; its distance is not changed.
pub(super) fn choose_view(camera: &mut Camera, volume: &Volume, object: &VisibleObject) {
    if let Some(view) = slice_view(volume) {
        set_view_axes(camera, view);
        return;
    }
    if volume.is_anatomical() {
        (camera.azimuth_deg, camera.elevation_deg) = PATIENT_VIEW_DEG;
        face_thick_slices(camera, volume);
        return;
    }
    let surface = ObjectSurface::extract(volume, object);
    if surface.cells.is_empty() {
        return;
    }
    let usual = (camera.azimuth_deg, camera.elevation_deg);
    let steps = (360.0 / AZIMUTH_STEP_DEG) as usize;
    let others = ELEVATIONS_DEG.into_iter().flat_map(|elevation| {
        (0..steps).map(move |step| (usual.0 + AZIMUTH_STEP_DEG * step as f64, elevation))
    });
    let views: Vec<(f64, f64)> = std::iter::once(usual).chain(others).collect();
    let seen: Vec<ViewInformation> = views
        .par_iter()
        .map(|&(azimuth_deg, elevation_deg)| {
            let view =
                Camera { azimuth_deg, elevation_deg, roll_deg: 0.0, ..camera.clone() }.scene_from_view();
            surface.measure_view(view)
        })
        .collect();
    let most = seen.iter().fold(ViewInformation::default(), ViewInformation::componentwise_max);
    let scores: Vec<f64> = seen.iter().map(|one| one.score(&most)).collect();
    let best = (0..views.len()).max_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0);
    if scores[best] > MIN_SCORE_RATIO * scores[0] {
        let azimuth = (views[best].0 + 180.0).rem_euclid(360.0) - 180.0;
        (camera.azimuth_deg, camera.elevation_deg) = (azimuth, views[best].1);
    }
    face_thick_slices(camera, volume);
}

/// Returns the view of a grid with few slices, as right, up and backward axes in scene space: perpendicular to the
/// slices, image rows from the top down, never mirrored. `None` for other grids.
fn slice_view(volume: &Volume) -> Option<DMat3> {
    let axes = volume.scene().scene_from_index.matrix3;
    let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
    let dims = volume.dims();
    let mut by_length = [0, 1, 2].map(|axis: usize| (axes[axis].length() * dims[axis] as f64, axis));
    by_length.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(shortest, thinnest), (next, _), _] = by_length;
    let is_flat = shortest < MAX_FLATNESS_RATIO * next;
    // Few slices are a picture, however far they are apart.
    let across = axis_across_picture(volume).or_else(|| is_flat.then_some(thinnest))?;
    // Slices stacked along z are images, whose second axis runs down; others are upright.
    let (right, up) = match across {
        0 => (axes[1], axes[2]),
        1 => (axes[0], axes[2]),
        _ => (axes[0], -axes[1]),
    };
    let right = right.normalize();
    let up = up.reject_from(right).normalize();
    let backward = right.cross(up);
    let above = if dims[across] > 1 && is_flat { SLICE_ELEVATION_DEG.to_radians() } else { 0.0 };
    let (sine, cosine) = above.sin_cos();
    Some(DMat3::from_cols(right, up * cosine - backward * sine, backward * cosine + up * sine))
}

/// Rotates a camera to the given right, up and backward axes in scene space.
fn set_view_axes(camera: &mut Camera, view: DMat3) {
    let upright_from_scene = camera.up.scene_from_upright().transpose();
    let (up, backward) = (upright_from_scene * view.y_axis, upright_from_scene * view.z_axis);
    let elevation = backward.z.clamp(-1.0, 1.0).asin();
    // Seen from straight above or below, the azimuth is undefined; the up axis determines it.
    let aside = if backward.truncate().length() > 1e-6 { backward } else { -up * backward.z.signum() };
    camera.azimuth_deg = aside.y.atan2(aside.x).to_degrees();
    camera.elevation_deg = elevation.to_degrees();
    camera.roll_deg = 0.0;
    let level = camera.scene_from_view();
    camera.roll_deg = (-view.y_axis.dot(level.x_axis)).atan2(view.y_axis.dot(level.y_axis)).to_degrees();
}

/// Cell on the surface of the object.
struct SurfaceCell {
    /// Centre of the cell in scene space.
    place: DVec3,
    /// Outward normal in scene space.
    normal: DVec3,
    /// True at a face of the volume, where the data end, not the object.
    is_on_boundary: bool,
}

/// Surface cells of the object.
struct ObjectSurface {
    cells: Vec<SurfaceCell>,
    /// Edge of a pixel, in scene units.
    pixel: f64,
}

/// Information in a view of the object.
#[derive(Debug, Clone, Copy, Default)]
struct ViewInformation {
    /// Visible share of the surface.
    surface: f64,
    /// Entropy of the directions of visible normals, in bits.
    normals: f64,
    /// Number of pixels that the object covers.
    area: f64,
}

impl ViewInformation {
    fn componentwise_max(self, other: &Self) -> Self {
        Self {
            surface: self.surface.max(other.surface),
            normals: self.normals.max(other.normals),
            area: self.area.max(other.area),
        }
    }

    fn score(&self, most: &Self) -> f64 {
        let share = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
        share(self.surface, most.surface)
            + NORMALS_WEIGHT * share(self.normals, most.normals)
            + 0.5 * share(self.area, most.area)
    }
}

impl ObjectSurface {
    fn extract(volume: &Volume, object: &VisibleObject) -> Self {
        let scene = volume.scene();
        // Normals transform with the inverse transpose.
        let normal_from_index = scene.scene_from_index.matrix3.inverse().transpose();
        let last = object.cells.map(|n| n - 1);
        let cells = object
            .occupied_cells()
            .filter_map(|cell| {
                let at = cell.map(|n| n as i64);
                let near = |[x, y, z]: [i64; 3]| object.is_occupied([at[0] + x, at[1] + y, at[2] + z]);
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
                    place: scene.scene_from_index.transform_point3(object.cell_centre(cell)),
                    normal: (normal_from_index * outwards).normalize_or_zero(),
                    is_on_boundary: (0..3).any(|axis| cell[axis] == 0 || cell[axis] == last[axis]),
                })
            })
            .collect();
        let step = |axis: usize| {
            let (one, other) = ([0; 3], [0, 1, 2].map(|n| usize::from(n == axis && object.cells[axis] > 1)));
            let place = |cell| scene.scene_from_index.transform_point3(object.cell_centre(cell));
            place(one).distance(place(other))
        };
        let pixel = PIXEL_CELLS * step(0).max(step(1)).max(step(2)).max(1e-6);
        Self { cells, pixel }
    }

    /// Measures a view in orthographic projection.
    fn measure_view(&self, scene_from_view: DMat3) -> ViewInformation {
        let view_from_scene = scene_from_view.transpose();
        let local: Vec<DVec3> = self.cells.iter().map(|cell| view_from_scene * cell.place).collect();
        let low = local.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let high = local.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
        let columns = ((high.x - low.x) / self.pixel) as usize + 1;
        let rows = ((high.y - low.y) / self.pixel) as usize + 1;
        let pixel_of = |p: &DVec3| {
            ((p.y - low.y) / self.pixel) as usize * columns + ((p.x - low.x) / self.pixel) as usize
        };
        // Depth buffer: z of the nearest cell, which grows towards the camera, and true if that is the object's own
        // surface.
        let mut nearest = vec![(f64::NEG_INFINITY, false); columns * rows];
        for (p, cell) in local.iter().zip(&self.cells) {
            let pixel = &mut nearest[pixel_of(p)];
            if p.z > pixel.0 {
                *pixel = (p.z, !cell.is_on_boundary);
            }
        }
        let mut classes = [0.0; NORMAL_CLASSES * NORMAL_CLASSES];
        let mut visible = 0.0;
        for (p, cell) in local.iter().zip(&self.cells) {
            if cell.is_on_boundary || p.z < nearest[pixel_of(p)].0 - self.pixel {
                continue;
            }
            visible += 1.0;
            let normal = view_from_scene * cell.normal;
            let class = |n: f64| ((n.midpoint(1.0) * NORMAL_CLASSES as f64) as usize).min(NORMAL_CLASSES - 1);
            classes[class(normal.y) * NORMAL_CLASSES + class(normal.x)] += 1.0;
        }
        let entropy =
            |count: &f64| if *count > 0.0 { -count / visible * (count / visible).log2() } else { 0.0 };
        ViewInformation {
            surface: visible / self.cells.len() as f64,
            normals: classes.iter().map(entropy).sum(),
            area: nearest.iter().filter(|(_, is_object)| *is_object).count() as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneAxis;
    use crate::first_look::tests::threshold_settings;
    use chiaroscuro_volume::Samples;

    /// Returns a plate with knobs on its side of high y.
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
        let object = VisibleObject::from_settings(&threshold_settings(), &volume);
        let mut camera = Camera::default();
        choose_view(&mut camera, &volume, &object);
        // The default view is from low y.
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
        let object = VisibleObject::from_settings(&threshold_settings(), &volume);
        let mut camera = Camera::default();
        choose_view(&mut camera, &volume, &object);
        assert!(camera.scene_from_view().z_axis.y > 0.3, "{camera:?}");
    }

    #[test]
    fn people_are_seen_from_the_front() {
        let volume = plate().with_anatomical_axes(true);
        let object = VisibleObject::from_settings(&threshold_settings(), &volume);
        let mut camera = Camera::default();
        choose_view(&mut camera, &volume, &object);
        let towards_eye = camera.scene_from_view().z_axis;
        // Anterior, to the right of the face, a little from above.
        assert!(towards_eye.y > 0.7 && towards_eye.x > 0.3 && (0.15..0.3).contains(&towards_eye.z));
    }

    #[test]
    fn slices_are_seen_as_pictures() {
        let aimed = |volume: &Volume, up| {
            let object = VisibleObject::from_settings(&threshold_settings(), volume);
            let mut camera = Camera { up, ..Camera::default() };
            choose_view(&mut camera, volume, &object);
            camera.scene_from_view()
        };
        let is_near = |a: DVec3, b: DVec3| (a - b).length() < 1e-9;
        let slice = |dims: [usize; 3]| {
            let samples = Samples::U8(vec![200; dims.iter().product()]);
            Volume::with_spacing("slice", dims, DVec3::ONE, samples).unwrap()
        };
        for up in SceneAxis::ALL {
            // Columns to the right, rows downwards: the first voxel is at the top left.
            let view = aimed(&slice([40, 30, 1]), up);
            assert!(is_near(view.x_axis, DVec3::X) && is_near(view.y_axis, DVec3::NEG_Y), "{up:?}: {view}");
            let view = aimed(&slice([40, 1, 30]), up);
            assert!(is_near(view.x_axis, DVec3::X) && is_near(view.y_axis, DVec3::Z), "{up:?}: {view}");
            // Several slices are seen a little from their upper border.
            let view = aimed(&slice([40, 30, 3]), up);
            assert!(
                is_near(view.x_axis, DVec3::X)
                    && (view.y_axis.y + SLICE_ELEVATION_DEG.to_radians().cos()).abs() < 1e-9
            );
            assert!(view.z_axis.y < -0.4 && view.z_axis.z < -0.9, "{view}");
        }
        // A single slice of a body is seen from the feet, as radiologists view slices.
        let view = aimed(&slice([40, 30, 1]).with_anatomical_axes(true), SceneAxis::default());
        assert!(is_near(view.z_axis, DVec3::NEG_Z));
    }

    #[test]
    fn nothing_is_seen_from_the_usual_side() {
        let empty = Volume::with_spacing("empty", [8; 3], DVec3::ONE, Samples::U8(vec![0; 512])).unwrap();
        let object = VisibleObject::from_settings(&threshold_settings(), &empty);
        let mut camera = Camera::default();
        choose_view(&mut camera, &empty, &object);
        assert_eq!(camera, Camera::default());
    }
}
