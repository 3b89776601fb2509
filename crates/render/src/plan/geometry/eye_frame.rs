//! Sheet frame of the eye: rays and slabs of a camera.

use glam::{DMat3, DVec2};

use super::sheet_frame::{ProjectionPlacement, SheetFrame};
use crate::plan::PixelWindow;
use chiaroscuro_scene::{Camera, MAX_SLAB_PARTS, PREINTEGRATED_STEPS, Projection, Settings};
use chiaroscuro_volume::math::SceneSpace;

/// Maximum number of slabs at a thickness of 1: more than the diagonal of a volume of 2048³ voxels, and few enough
/// that very flat voxels do not make rays endless.
const MAX_SLABS: f64 = 4096.0;

/// Near plane of a perspective eye, as a share of the distance to the target.
const NEAR_PLANE_SHARE: f64 = 1e-3;

/// Maximum thickness of a preview's slabs, in edges of the smallest voxel: the kernel's radius.
const MAX_PREVIEW_SLAB: f64 = 2.0;

/// Thickness of a preview's slabs in widths of its pixels. At 1 they show stripes on flat faces that are seen at
/// steep angles: with 1.4 voxels an engine block differs by 0.7 % (root mean square) from thin slabs, with one voxel
/// by 0.3 %.
const PREVIEW_SLAB_PER_PIXEL: f64 = 0.7;

/// Returns the slab thickness for a preview, in edges of the smallest voxel, where full pictures have `slab`.
///
/// It is 0.7 times the width of the preview's pixels where they are narrowest: shapes along rays cannot be finer than
/// across them. `size`: pixels of the preview.
pub fn preview_slab(camera: &Camera, scene: &SceneSpace, size: [u32; 2], slab: f64) -> f64 {
    let frame = eye_frame(camera, scene, size, slab);
    let width = frame.pitch_at(frame.first_depth) / (frame.slab / slab);
    // At least one voxel, however large the preview: slight wood grain is acceptable.
    slab.max((PREVIEW_SLAB_PER_PIXEL * width).clamp(1.0, MAX_PREVIEW_SLAB))
}

/// Returns the sheet frame of a picture: with the thinnest slabs for slabs by need, and with the steps for
/// pre-integrated slabs.
pub fn picture_frame(settings: &Settings, scene: &SceneSpace, window: impl Into<PixelWindow>) -> SheetFrame {
    let frame = eye_frame(&settings.camera, scene, window, settings.thickest_slab());
    let parts = slab_parts(settings);
    if parts > 1 { frame.with_divided_slabs(parts) } else { frame }
}

/// Returns the number of a picture's slabs in the thickest one.
pub(crate) fn slab_parts(settings: &Settings) -> u32 {
    if settings.has_adaptive_slabs() {
        MAX_SLAB_PARTS
    } else if settings.has_preintegrated_slabs() {
        PREINTEGRATED_STEPS
    } else {
        1
    }
}

/// Returns the sheet frame of a camera, with slabs `slab` smallest voxel edges thick.
///
/// The anchor plane passes through the middle of the volume if that is well in front of the eye, else through the
/// target (both are arbitrary; the first keeps slabs in phase while panning). For a part of a picture, the sheets are
/// the corresponding part of the whole picture's.
pub fn eye_frame(
    camera: &Camera,
    scene: &SceneSpace,
    window: impl Into<PixelWindow>,
    slab: f64,
) -> SheetFrame {
    let PixelWindow { whole, first, size } = window.into();
    let view = camera.scene_from_view();
    let axes = DMat3::from_cols(view.x_axis, -view.y_axis, -view.z_axis);
    let eye = camera.position();
    let to_middle = -eye.dot(axes.z_axis);
    let distance = match camera.projection {
        Projection::Orthographic => to_middle,
        Projection::Perspective if to_middle > 0.05 * camera.distance => to_middle,
        Projection::Perspective => camera.distance,
    };
    let [width, height] = whole.map(|pixels| f64::from(pixels.max(1)));
    let pitch_at_target = camera.pixel_at_target(width, height);
    let (pitch, inverse_distance, near) = match camera.projection {
        Projection::Orthographic => (pitch_at_target, 0.0, f64::NEG_INFINITY),
        Projection::Perspective => (
            pitch_at_target * distance / camera.distance,
            1.0 / distance,
            NEAR_PLANE_SHARE * camera.distance - distance,
        ),
    };
    let pixels = |[i, j]: [u32; 2]| DVec2::new(f64::from(i), f64::from(j));
    SheetFrame::new(
        scene,
        &ProjectionPlacement {
            axes,
            anchor: eye + axes.z_axis * distance,
            inverse_distance,
            pitch,
            // Pixel centres lie half a pixel from the picture's edge.
            first_pixel: DVec2::splat(0.5) + pixels(first) - pixels(whole) / 2.0,
            size,
            slab: slab * scene.smallest_edge().max(2.0 * scene.support_radius() / MAX_SLABS),
            near,
        },
    )
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::*;
    use chiaroscuro_scene::FovReference;

    fn scene() -> SceneSpace {
        SceneSpace::new([40, 30, 20], DAffine3::from_scale(DVec3::new(1.0, 1.2, 2.0)))
    }

    #[test]
    fn rays_are_the_cameras_rays() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (distance, fit, size) in [
                (0.4, FovReference::Height, [64, 48]),
                (3.0, FovReference::Height, [20, 48]),
                (3.0, FovReference::Frame, [20, 48]),
            ] {
                let target = [0.1, -0.2, 0.05];
                let camera = Camera { projection, target, distance, fit, ..Camera::default() };
                let frame = eye_frame(&camera, &scene(), size, 1.0);
                let [width, height] = size.map(f64::from);
                let (origin, direction) = camera.ray_through(10.5, 7.5, width, height);
                for depth in [-0.2, 0.3] {
                    let point = scene().scene_from_index.transform_point3(frame.point(10.0, 7.0, depth));
                    let miss = (point - origin).reject_from(direction).length();
                    assert!(miss < 1e-12, "{projection:?}: {miss}");
                }
                let a = scene().scene_from_index.transform_point3(frame.point(10.0, 7.0, 0.0));
                let b = scene().scene_from_index.transform_point3(frame.point(10.0, 7.0, 0.1));
                assert!(((b - a).length() - 0.1 * frame.obliquity(10.0, 7.0)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn parts_of_a_picture_see_what_the_whole_sees() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            // Wide parts of a narrow picture.
            let camera = Camera { projection, fit: FovReference::Frame, ..Camera::default() };
            let whole = eye_frame(&camera, &scene(), [48, 64], 1.0);
            let part = PixelWindow { whole: [48, 64], first: [20, 30], size: [16, 9] };
            let part = eye_frame(&camera, &scene(), part, 1.0);
            assert_eq!((part.first_depth, part.slab_count), (whole.first_depth, whole.slab_count));
            for depth in [-0.3, 0.2] {
                let miss = part.point(3.0, 5.0, depth) - whole.point(23.0, 35.0, depth);
                assert!(miss.length() < 1e-9, "{projection:?}: {miss}");
                assert!((part.obliquity(3.0, 5.0) - whole.obliquity(23.0, 35.0)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn previews_have_slabs_nearly_as_thick_as_their_pixels_are_wide() {
        let slab = |size, slab| preview_slab(&Camera::default(), &scene(), size, slab);
        // Pixels that are finer than voxels, as wide as two, and wider than the kernel.
        assert_eq!(slab([6400, 4800], 0.5), 1.0);
        assert_eq!(slab([16, 12], 0.5), 2.0);
        assert_eq!(slab([16, 12], 3.0), 3.0);
        let width = slab([28, 21], 0.5);
        let frame = eye_frame(&Camera::default(), &scene(), [28, 21], width);
        let narrowest = frame.pitch_at(frame.first_depth) / scene().smallest_edge();
        assert!(
            (1.0..2.0).contains(&width) && (width / narrowest / PREVIEW_SLAB_PER_PIXEL - 1.0).abs() < 0.05,
            "{width}"
        );
    }

    #[test]
    fn slabs_cover_the_material_and_nothing_behind_the_eye() {
        let far = eye_frame(&Camera::default(), &scene(), [64, 48], 1.0);
        let last = far.first_depth + f64::from(far.slab_count) * far.slab;
        for corner in scene().support_corners() {
            let depth = (corner - Camera::default().position())
                .dot(-Camera::default().scene_from_view().z_axis)
                - 1.0 / far.inverse_distance;
            assert!(far.first_depth <= depth + 1e-9 && depth - 1e-9 <= last);
        }
        let inside = Camera { distance: 0.1, ..Camera::default() };
        let frame = eye_frame(&inside, &scene(), [64, 48], 1.0);
        assert!(frame.depth_of(0.0) + 1.0 / frame.inverse_distance > 0.0, "slab 0 is in front of the eye");
    }
}
