//! View pyramid of a picture, by which the pages in view are found.

use glam::DVec3;

use crate::plan::{MAX_STRETCH_LEVEL, SheetFrame};
use chiaroscuro_scene::{Projection, Settings};
use chiaroscuro_volume::math::SceneSpace;

/// View pyramid of a picture: the part of the scene that it shows, with the stretch of kernels in it.
pub(super) struct ViewPyramid<'a> {
    frame: &'a SheetFrame,
    /// Planes at the sides, with normals inwards and their offsets.
    sides: Vec<(DVec3, f64)>,
    eye: DVec3,
    forward: DVec3,
    is_perspective: bool,
}

impl<'a> ViewPyramid<'a> {
    pub(super) fn new(frame: &'a SheetFrame, settings: &Settings, scene: &SceneSpace) -> Self {
        let [width, height] = frame.size.map(|n| f64::from(n) - 0.5);
        let depths = [frame.first_depth, frame.first_depth + f64::from(frame.slab_count.max(1)) * frame.slab];
        let point =
            |[i, j]: [f64; 2], depth: f64| scene.scene_from_index.transform_point3(frame.point(i, j, depth));
        let corners = [[-0.5, -0.5], [width, -0.5], [width, height], [-0.5, height]];
        let middle = point([0.5 * width, 0.5 * height], depths[1]);
        let sides = (0..4).map(|at| {
            let (a, b) = (corners[at], corners[(at + 1) % 4]);
            let (near, far, next) = (point(a, depths[0]), point(a, depths[1]), point(b, depths[1]));
            let normal = (far - near).cross(next - far).normalize_or_zero();
            let normal = if normal.dot(middle - far) < 0.0 { -normal } else { normal };
            (normal, normal.dot(far))
        });
        let camera = &settings.camera;
        Self {
            sides: sides.collect(),
            eye: camera.position(),
            forward: -camera.scene_from_view().z_axis,
            is_perspective: camera.projection == Projection::Perspective,
            frame,
        }
    }

    /// Returns the distance of the nearest corner of a box and the range of stretch levels in it; `None` if the box lies
    /// outside.
    pub(super) fn stretch_range(&self, corners: &[DVec3; 8]) -> Option<(f64, [f64; 2])> {
        let is_beyond = |(normal, offset): &(DVec3, f64)| corners.iter().all(|c| normal.dot(*c) < *offset);
        let depths = corners.map(|corner| (corner - self.eye).dot(self.forward));
        let [near, far] = [
            depths.iter().copied().fold(f64::INFINITY, f64::min),
            depths.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        if self.sides.iter().any(is_beyond) || (self.is_perspective && far <= 0.0) {
            return None;
        }
        let level = |distance: f64| {
            let wider =
                if self.is_perspective { self.frame.inverse_distance * distance.max(0.0) } else { 1.0 };
            (self.frame.pitch * wider / self.frame.voxel_edge).max(1e-9).log2().clamp(0.0, MAX_STRETCH_LEVEL)
        };
        Some((near, [level(near), level(far)]))
    }
}
