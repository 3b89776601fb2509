//! Sheet frames of a light: one view for a light outside the volume, six (the faces of a cube map) for a perspective
//! light inside or close by.

use glam::{DMat3, DVec2, DVec3};

use super::sheet_frame::{ProjectionPlacement, SheetFrame};
use chiaroscuro_scene::{LightGeometry, SceneLight, ShadowSettings, cube_axes};
use chiaroscuro_volume::math::SceneSpace;

/// Distance in radii of the volume below which a perspective light is split into six views: beyond it, the volume
/// fits a cone of ± asin(1/1.5) = 42°, no wider than one face of a cube.
const SPLIT_RADII: f64 = 1.5;

/// Maximum number of pixels across a sheet: very flat voxels would need more than a texture can hold, and get pixels
/// wider than their smallest edge instead.
const MAX_PIXELS: f64 = 2000.0;

/// Minimum width of the reverse kernel across the sheets, in light voxels.
///
/// Sheets are drawn with kernels no narrower than a voxel and hold nothing finer, however many pixels they have per
/// voxel: so the kernel of one pixel, with 4² fetches, suffices. This holds for all lights that are not split into
/// six views: the nearest point to a light 1.5 radii away is at a third of its distance, with pixels a third of a
/// voxel wide.
pub const MIN_KERNEL_VOXELS: f64 = 0.3125;

/// Maximum width of the reverse kernel in pixels: close to a light inside the volume, pixels become arbitrarily
/// small, and the kernel is narrowed there rather than taking ever more fetches.
pub const MAX_KERNEL_PIXELS: f64 = 4.0;

/// View of a light: a stack of sheets, and the projection of points onto them.
#[derive(Debug, Clone, PartialEq)]
pub struct LightView {
    /// Rays and slabs of the view.
    pub frame: SheetFrame,
    /// Columns: the sheets' x and y axes and the direction away from the light, in scene space.
    pub axes: DMat3,
    /// Intersection of the axis with the anchor plane, in scene space.
    pub anchor: DVec3,
    /// Position of pixel (0, 0) on the anchor plane, in pixels from the axis.
    pub first_pixel: DVec2,
    /// Width of the reverse kernel along the axis, in scene units: one voxel of the light volume (its smallest edge).
    pub kernel_edge: f64,
    /// True for a face of a cube map, which covers only the quarter-space where its axis dominates.
    pub cube_face: bool,
}

/// Position of a point on a view's sheets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetPosition {
    /// Pixel coordinates; pixel centres are at integers.
    pub pixel: DVec2,
    /// Slab coordinate; the middles of slabs are at integers.
    pub slab: f64,
    /// Width of the reverse kernel at this position, in pixels.
    pub kernel_pixels: f64,
    /// Length of the reverse kernel at this position, in slabs.
    pub kernel_slabs: f64,
}

impl LightView {
    /// Projects a point in scene space; `None` if another view covers it or it lies in the plane of the light.
    pub fn project(&self, point: DVec3) -> Option<SheetPosition> {
        let local = self.axes.transpose() * (point - self.anchor);
        let spread = 1.0 + local.z * self.frame.inverse_distance;
        if self.cube_face {
            let depth = spread / self.frame.inverse_distance;
            // A tolerance of 1e-5, so that rounding leaves no voxel between two faces.
            let limit = depth * 1.000_01;
            if !(depth > 0.0 && local.x.abs() <= limit && local.y.abs() <= limit) {
                return None;
            }
        }
        // A thousandth of the anchor's distance: nothing visible is that close to the light.
        if spread.is_nan() || spread <= 1e-3 {
            return None;
        }
        let pitch = self.frame.pitch * spread;
        Some(SheetPosition {
            pixel: DVec2::new(local.x, local.y) / pitch - self.first_pixel,
            slab: (local.z - self.frame.first_depth) / self.frame.slab - 0.5,
            kernel_pixels: self.kernel_pixels(pitch),
            kernel_slabs: self.kernel_slabs(),
        })
    }

    /// Returns the width of the reverse kernel in pixels of width `pitch`.
    fn kernel_pixels(&self, pitch: f64) -> f64 {
        (MIN_KERNEL_VOXELS * self.kernel_edge / pitch).clamp(1.0, MAX_KERNEL_PIXELS)
    }

    /// Returns the length of the reverse kernel in slabs, which is constant over depth.
    pub fn kernel_slabs(&self) -> f64 {
        self.kernel_edge / self.frame.slab
    }

    /// Returns true if the reverse kernel is one pixel wide at every depth, and one slab long; always false for a
    /// cube face, whose pixels become arbitrarily small at the light.
    pub fn kernel_is_narrow(&self) -> bool {
        !self.cube_face
            && self.kernel_pixels(self.frame.pitch_at(self.frame.first_depth)) < 1.0 + 1e-9
            && (self.kernel_slabs() - 1.0).abs() < 1e-9
    }
}

/// Returns the views of a light over a scene, with the pitch, slabs and resolution that `shadows` specifies.
pub fn light_views(light: &SceneLight, shadows: &ShadowSettings, scene: &SceneSpace) -> Vec<LightView> {
    let radius = scene.support_radius();
    let edge = (scene.smallest_edge() * shadows.resolution.divisor() as f64).max(2.0 * radius / MAX_PIXELS);
    let position = DVec3::from(light.position);
    match light.kind {
        LightGeometry::Parallel => {
            vec![outside_view(scene, -light.direction(), 0.0, edge, shadows)]
        }
        LightGeometry::Perspective if position.length() >= SPLIT_RADII * radius => {
            vec![outside_view(scene, -position / position.length(), 1.0 / position.length(), edge, shadows)]
        }
        LightGeometry::Perspective => cube_views(scene, position, edge, shadows.slab),
    }
}

/// Creates the view of a light that looks along `forward` at the origin, from a distance of `1 / inverse_distance`.
fn outside_view(
    scene: &SceneSpace,
    forward: DVec3,
    inverse_distance: f64,
    edge: f64,
    shadows: &ShadowSettings,
) -> LightView {
    let axes = axes_along(forward);
    let pixel_of = |point: DVec3| {
        let local = axes.transpose() * point;
        DVec2::new(local.x, local.y) / (edge * (1.0 + local.z * inverse_distance))
    };
    let pixels = scene.support_corners().map(pixel_of);
    // Pixels are aligned with voxels: for light along rows of voxels, each row has a pixel of its own, and none
    // receives light of its neighbours.
    let row = pixel_of(middle_voxel(scene, shadows.resolution.divisor(), forward, edge));
    let low = (pixels.iter().fold(DVec2::INFINITY, |low, &pixel| low.min(pixel)) - row).floor() + row;
    let high = (pixels.iter().fold(DVec2::NEG_INFINITY, |high, &pixel| high.max(pixel)) - row).ceil() + row;
    let size = (high - low).round() + 1.0;
    let place = ProjectionPlacement {
        axes,
        anchor: DVec3::ZERO,
        inverse_distance,
        pitch: edge,
        first_pixel: low,
        size: [size.x as u32, size.y as u32],
        slab: shadows.slab * edge,
        near: f64::NEG_INFINITY,
    };
    make_view(scene, &place, false)
}

/// Returns the centre of the light volume's voxel next to the middle, in scene space.
///
/// If the number of voxels is even it is the one towards the light, so that the mirrored scene has the mirrored pixels;
/// if light comes from neither side, a pixel's face lies in the middle: half a pixel of width `edge` off, which is
/// half a voxel if they are that wide.
fn middle_voxel(scene: &SceneSpace, divisor: usize, forward: DVec3, edge: f64) -> DVec3 {
    let towards = -scene.index_from_scene.transform_vector3(forward);
    let index: [f64; 3] = std::array::from_fn(|axis| {
        let count = scene.dims[axis].div_ceil(divisor);
        let middle = count as f64 * divisor as f64 / 2.0 - 0.5;
        if count % 2 == 1 {
            return middle;
        }
        let half = 0.5 * divisor as f64;
        if towards[axis].abs() < 1e-9 * towards.abs().max_element() {
            middle + half.min(0.5 * edge / scene.scene_from_index.matrix3.col(axis).length())
        } else {
            middle + half * towards[axis].signum()
        }
    });
    scene.scene_from_index.transform_point3(DVec3::from(index))
}

/// Creates the six views around a light at `position`.
fn cube_views(scene: &SceneSpace, position: DVec3, edge: f64, slab: f64) -> Vec<LightView> {
    let farthest = scene.support_corners().iter().map(|corner| corner.distance(position)).fold(0.0, f64::max);
    // Pixels are a voxel wide halfway to the farthest corner, so that the stretch behind it is at most 2. The
    // distance is a whole number of slabs, so that slab faces pass through the light.
    let thickness = slab * edge;
    let anchor_distance = (farthest / 2.0 / thickness).ceil().max(1.0) * thickness;
    // Half the face, and the widest kernel beyond its edges.
    let half = (anchor_distance / edge + 2.0 * MAX_KERNEL_PIXELS).ceil() + 1.0;
    let faces = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    faces
        .into_iter()
        .map(|forward| {
            let place = ProjectionPlacement {
                axes: axes_along(forward),
                anchor: position + forward * anchor_distance,
                inverse_distance: 1.0 / anchor_distance,
                pitch: edge,
                first_pixel: DVec2::splat(-half),
                size: [(2.0 * half) as u32 + 1; 2],
                slab: thickness,
                // Nothing behind the light is sampled.
                near: -anchor_distance,
            };
            make_view(scene, &place, true)
        })
        .filter(|view| view.frame.slab_count > 0)
        .collect()
}

fn make_view(scene: &SceneSpace, place: &ProjectionPlacement, cube_face: bool) -> LightView {
    LightView {
        frame: SheetFrame::new(scene, place),
        axes: place.axes,
        anchor: place.anchor,
        first_pixel: place.first_pixel,
        kernel_edge: place.pitch,
        cube_face,
    }
}

/// Returns axes with z along `forward` that turn with the scene, so that turned and mirrored scenes have the same
/// pixels.
fn axes_along(forward: DVec3) -> DMat3 {
    let [right, down] = cube_axes(forward);
    DMat3::from_cols(right, down, forward)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    fn scene() -> SceneSpace {
        SceneSpace::new([40, 30, 20], DAffine3::from_scale(DVec3::new(1.0, 1.2, 2.0)))
    }

    fn views(kind: LightGeometry, position: [f64; 3]) -> Vec<LightView> {
        light_views(
            &SceneLight { kind, position, ..SceneLight::default() },
            &ShadowSettings::default(),
            &scene(),
        )
    }

    #[test]
    fn positions_invert_rays() {
        for (kind, position) in [
            (LightGeometry::Parallel, [1.0, 2.0, 3.0]),
            (LightGeometry::Perspective, [1.0, 2.0, 3.0]),
            (LightGeometry::Perspective, [0.1, 0.2, 0.0]),
        ] {
            for view in views(kind, position) {
                let (i, j, k) =
                    (view.frame.size[0] as f64 / 2.0 + 1.0, view.frame.size[1] as f64 / 2.0 - 2.0, 7.0);
                let point = view.frame.point(i, j, view.frame.depth_of(k));
                let found = view.project(scene().scene_from_index.transform_point3(point)).unwrap();
                assert!((found.pixel - DVec2::new(i, j)).length() < 1e-9, "{found:?}");
                assert!((found.slab - k).abs() < 1e-9, "{found:?}");
            }
        }
    }

    #[test]
    fn every_voxel_has_room_for_its_kernel() {
        for (kind, position) in [
            (LightGeometry::Parallel, [0.3, -2.0, 1.0]),
            (LightGeometry::Perspective, [2.0, 2.0, 1.0]),
            (LightGeometry::Perspective, [0.2, 0.1, 0.3]),
        ] {
            let views = views(kind, position);
            let [nx, ny, nz] = scene().dims;
            for z in 0..nz {
                for y in 0..ny {
                    for x in 0..nx {
                        let voxel = DVec3::new(x as f64, y as f64, z as f64);
                        let point = scene().scene_from_index.transform_point3(voxel);
                        let owners: Vec<_> =
                            views.iter().filter_map(|v| Some((v, v.project(point)?))).collect();
                        assert!(!owners.is_empty(), "nobody lights {voxel}");
                        for (view, at) in owners {
                            let reach = 2.0 * at.kernel_pixels;
                            let size =
                                DVec2::new(f64::from(view.frame.size[0]), f64::from(view.frame.size[1]));
                            assert!((at.pixel - reach).min_element() > -1.0, "{at:?}");
                            assert!((size - at.pixel - reach).min_element() > 0.0, "{at:?} of {size}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_pixels_kernel_does_for_all_lights_outside() {
        let nearest = SPLIT_RADII * scene().support_radius();
        for direction in [DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 1.0), DVec3::new(-1.0, 2.0, 0.3)] {
            let position = (direction.normalize() * nearest * 1.000_001).to_array();
            for view in views(LightGeometry::Perspective, position) {
                assert!(view.kernel_is_narrow(), "{position:?}");
            }
        }
        assert!(!views(LightGeometry::Perspective, [0.1, 0.2, 0.0])[0].kernel_is_narrow());
    }

    #[test]
    fn flat_voxels_do_not_need_endless_sheets() {
        let flat = SceneSpace::new([10, 10, 400], DAffine3::from_scale(DVec3::new(0.01, 0.01, 5.0)));
        let light = SceneLight { position: [1.0, 1.0, 1.0], ..SceneLight::default() };
        for view in light_views(&light, &ShadowSettings::default(), &flat) {
            assert!(view.frame.size.iter().all(|&n| n <= 2048), "{:?}", view.frame.size);
            assert!(view.frame.slab_count <= 2048);
        }
    }

    #[test]
    fn axes_turn_without_jumps() {
        let mut previous: Option<DMat3> = None;
        for step in 0..=360 {
            let angle = f64::from(step).to_radians();
            let forward = DVec3::new(angle.cos() * 0.8, angle.sin() * 0.8, -0.6);
            let axes = axes_along(forward);
            assert!((axes.determinant() - 1.0).abs() < 1e-9 || (axes.determinant() + 1.0).abs() < 1e-9);
            if let Some(previous) = previous {
                // Up to quarter turns, which leave the pixels where they are.
                let aligned = [axes.x_axis, axes.y_axis].map(|axis| axis.dot(previous.x_axis).abs());
                assert!(aligned[0].max(aligned[1]) > 0.99, "at {step} degrees");
            }
            previous = Some(axes);
        }
    }
}
