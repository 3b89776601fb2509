//! Camera framing: places the camera so that a volume's object fills the frame, and the floor under the object.

mod outline;
mod thick_slices;

use glam::{DVec2, DVec3};

pub use self::outline::ObjectOutline;
pub(super) use self::thick_slices::face_thick_slices;
use self::thick_slices::thick_slice_axis;
use super::object::VisibleObject;
use crate::{Camera, FRAME_ASPECT, FovReference, Settings};
use chiaroscuro_volume::Volume;

/// Share of the frame's height or width that the object fills, whichever it reaches first.
const FILL_SHARE: f64 = 0.8;

/// Largest share that it fills in orthographic projection, which shows near parts no larger than distant ones.
const FILL_SHARE_ORTHOGRAPHIC: f64 = 0.98;

/// Largest camera distance, in scene units: smaller objects are next to nothing.
const MAX_DISTANCE: f64 = 20.0;

/// Share of outline points that may lie beyond each side of the frame: a few voxels of noise.
const TRIMMED_SHARE: f64 = 0.0005;

/// Share of outline points that may lie below the floor: single voxels of noise.
const SHARE_BELOW_FLOOR: f64 = 0.001;

/// Returns the height along `up` below which only noise of an outline lies.
fn floor_height(outline: &[DVec3], up: DVec3) -> f64 {
    let mut heights: Vec<f64> = outline.iter().map(|point| point.dot(up)).collect();
    let at = (heights.len() as f64 * SHARE_BELOW_FLOOR) as usize;
    *heights.select_nth_unstable_by(at, f64::total_cmp).1
}

/// Returns the range of points along an axis, without a share of [`TRIMMED_SHARE`] at either end.
fn trimmed_range(points: &[DVec2], along: impl Fn(&DVec2) -> f64) -> [f64; 2] {
    let mut values: Vec<f64> = points.iter().map(along).collect();
    let beyond = (values.len() as f64 * TRIMMED_SHARE) as usize;
    let last = values.len().saturating_sub(1);
    [beyond, last - beyond].map(|at| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// Returns the outline of an object in scene space.
fn outline_points(volume: &Volume, object: &VisibleObject) -> Vec<DVec3> {
    let scene_from_index = volume.scene().scene_from_index;
    let centres = object.outline().into_iter();
    let points: Vec<DVec3> = match thick_slice_axis(volume) {
        // Material reaches half a slice beyond the centres of voxels, which is much where slices are thick.
        Some(axis) => {
            centres.flat_map(|point| [-0.5, 0.5].map(|offset| point + offset * DVec3::AXES[axis])).collect()
        }
        None => centres.collect(),
    };
    points.into_iter().map(|point| scene_from_index.transform_point3(point)).collect()
}

/// Puts the floor under the object; without an object it is not moved.
pub(super) fn place_floor(settings: &mut Settings, volume: &Volume, object: &VisibleObject) {
    let corners = outline_points(volume, object);
    if !corners.is_empty() {
        settings.floor.height =
            floor_height(&corners, settings.camera.up.direction()) - volume.scene().smallest_edge() / 2.0;
    }
}

/// Points the camera at the object, close enough that it fills the frame, which lies within images of any aspect
/// ratio, and puts the floor under it.
pub(super) fn frame_object(settings: &mut Settings, volume: &Volume, object: &VisibleObject) {
    frame_points(&mut settings.camera, &outline_points(volume, object));
    place_floor(settings, volume, object);
}

/// Points a camera at scene points without rotating it, close enough that they fill the frame.
fn frame_points(camera: &mut Camera, corners: &[DVec3]) {
    camera.fit = FovReference::Frame;
    // Starts from the default distance, so that the result does not depend on the previous camera.
    camera.distance = Camera::default().distance;
    if corners.is_empty() {
        return;
    }
    let view = camera.scene_from_view();
    let half_angle_tan = camera.half_height_at_target(FRAME_ASPECT) / camera.distance;
    let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    // A target within the object, also in depth, keeps it in the image when orbiting.
    let mut target = (low + high) / 2.0;
    // Three iterations: in perspective the centre depends on the distance, and the distance on the centre.
    for _ in 0..3 {
        let eye = target + view.z_axis * camera.distance;
        let seen: Vec<DVec2> = corners
            .iter()
            .filter_map(|corner| {
                let local = view.transpose() * (*corner - eye);
                (local.z < 0.0).then(|| DVec2::new(local.x, local.y) / -local.z)
            })
            .collect();
        if seen.is_empty() {
            return;
        }
        let (x, y) = (trimmed_range(&seen, |p| p.x), trimmed_range(&seen, |p| p.y));
        let (low, high) = (DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1]));
        let middle = (low + high) / 2.0;
        target += (view.x_axis * middle.x + view.y_axis * middle.y) * camera.distance;
        let half = (high - low) / 2.0;
        let wanted = FILL_SHARE * half_angle_tan;
        // In units of the distance, relative to the new target.
        let parallel = corners.iter().fold(DVec2::ZERO, |most, corner| {
            let local = view.transpose() * (*corner - target);
            most.max(DVec2::new(local.x, local.y).abs() / camera.distance)
        });
        let wanted_parallel = FILL_SHARE_ORTHOGRAPHIC * half_angle_tan;
        let factor = (half.y / wanted)
            .max(half.x / (wanted * FRAME_ASPECT))
            .max(parallel.y / wanted_parallel)
            .max(parallel.x / (wanted_parallel * FRAME_ASPECT));
        camera.distance = (camera.distance * factor).clamp(0.3, MAX_DISTANCE);
    }
    camera.target = target.into();
    // Elongated objects, seen from their end, need more iterations.
    camera.distance = camera.distance.max(outline::least_distance(corners, camera)).min(MAX_DISTANCE);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::first_settings;
    use crate::first_look::tests::ball;
    use chiaroscuro_volume::{Histogram, Samples, synthetic::builtin};

    #[test]
    fn the_object_fills_the_picture() {
        let volume = ball(200.0, 0.0);
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let (_, top, _) = settings.camera.pixel_from_scene(DVec3::ZERO, 400.0, 300.0).unwrap();
        assert!((top - 150.0).abs() < 20.0, "the ball's centre is at row {top}");
        assert!(settings.camera.distance > 1.0 && settings.camera.distance < 8.0);
    }

    /// Tests a ball of six voxels in the corner of a volume that is nearest to the default camera, and in the
    /// farthest one.
    #[test]
    fn the_camera_turns_about_the_object_wherever_it_lies() {
        let n = 48;
        let towards_eye = Camera::default().scene_from_view().z_axis;
        for side in [-1.0, 1.0] {
            let middle = DVec3::splat((n - 1) as f64 / 2.0) + side * 15.0 * towards_eye.signum();
            let value = |at: usize| {
                let place = DVec3::from([at % n, at / n % n, at / n / n].map(|c| c as f64));
                if place.distance(middle) < 6.0 { 200 } else { 0 }
            };
            let voxels = Samples::U8((0..n * n * n).map(value).collect());
            let volume = Volume::with_spacing("corner", [n; 3], DVec3::ONE, voxels).unwrap();
            let mut settings = first_settings(&volume, &Histogram::from_volume(&volume));
            let wanted = volume.scene().scene_from_index.transform_point3(middle);
            let apart = DVec3::from(settings.camera.target).distance(wanted);
            // A voxel is a twenty-fourth of a scene unit.
            assert!(apart < 1.0 / 24.0, "{side}: {apart}");
            let framed = settings.camera.clone();
            settings.camera.distance *= 7.0;
            super::super::frame_object(&mut settings, &volume);
            assert_eq!(settings.camera, framed, "from wherever it is framed");
        }
    }

    /// Returns the bounding box of the visible voxels in an image, in pixels.
    fn seen_box(settings: &Settings, volume: &Volume, size: DVec2) -> [DVec2; 2] {
        let pixels = VisibleObject::from_settings(settings, volume).outline().into_iter().map(|point| {
            let point = volume.scene().scene_from_index.transform_point3(point);
            let seen = settings.camera.pixel_from_scene(point, size.x, size.y);
            let (x, y, _) = seen.expect("a point in front of the eye");
            DVec2::new(x, y)
        });
        pixels.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    }

    #[test]
    fn the_object_is_framed_in_pictures_of_every_shape() {
        for name in ["chair", "cloud", "marschner-lobb"] {
            let volume = builtin(name, Some(48)).unwrap();
            let mut settings = first_settings(&volume, &Histogram::from_volume(&volume));
            let mut parallel = settings.clone();
            parallel.camera.toggle_projection();
            for size in [[1200, 400], [960, 540], [800, 600], [500, 500], [360, 640], [200, 800]] {
                let size = DVec2::from(size.map(f64::from));
                let [low, high] = seen_box(&settings, &volume, size);
                let margin = (low / size).min((size - high) / size).min_element();
                assert!(margin >= 0.05, "{name} in {size}: a margin of {margin}");
                // Largest frame in the image.
                let height = size.y.min(size.x / FRAME_ASPECT);
                let filled = ((high - low) / DVec2::new(height * FRAME_ASPECT, height)).max_element();
                assert!(filled >= 0.6, "{name} in {size}: fills {filled} of the frame");
                // Orthographic projection shows distant parts larger: for a whole cube, a little more than the
                // margin.
                let [low, high] = seen_box(&parallel, &volume, size);
                assert!(low.min_element() > 0.0 && (size - high).min_element() > 0.0, "{name} in {size}");
            }
            // With the field of view of the height, a narrow image cuts it off.
            settings.camera.fit = FovReference::Height;
            let size = DVec2::new(200.0, 800.0);
            let [low, high] = seen_box(&settings, &volume, size);
            assert!(low.x < 0.0 && high.x > size.x, "{name}: {low} to {high}");
        }
    }
}
