//! Geometry of the crop box and of the clip plane in scene space.

use glam::DVec3;

use chiaroscuro_scene::{ClipPlane, CropBox};
use chiaroscuro_volume::math::SceneSpace;

/// Converts normalised grid coordinates (0 to 1 along each axis) to a scene point.
fn scene_from_share(scene: &SceneSpace, share: DVec3) -> DVec3 {
    let dims = DVec3::from(scene.dims.map(|n| n as f64));
    scene.scene_from_index.transform_point3(share * dims - 0.5)
}

/// Iterates over the twelve edges of a box as pairs of corner numbers, whose bits are the axes.
fn box_edges() -> impl Iterator<Item = [usize; 2]> {
    (0..8_usize).flat_map(|from| {
        (0..3).filter(move |axis| from >> axis & 1 == 0).map(move |axis| [from, from | 1 << axis])
    })
}

fn corner(low: DVec3, high: DVec3, at: usize) -> DVec3 {
    DVec3::from([0, 1, 2].map(|axis| if at >> axis & 1 == 0 { low[axis] } else { high[axis] }))
}

/// Returns the twelve edges of a crop box, in scene space.
pub(crate) fn crop_edges(crop: &CropBox, scene: &SceneSpace) -> Vec<[DVec3; 2]> {
    let (low, high) = (crop.low.into(), crop.high.into());
    box_edges().map(|pair| pair.map(|at| scene_from_share(scene, corner(low, high, at)))).collect()
}

/// Returns the centre of a face of a crop box, and the full extent of the grid along that axis, in scene space.
pub(crate) fn crop_face(crop: &CropBox, scene: &SceneSpace, axis: usize, is_high: bool) -> (DVec3, DVec3) {
    let (low, high) = (DVec3::from(crop.low), DVec3::from(crop.high));
    let mut share = (low + high) / 2.0;
    share[axis] = if is_high { high[axis] } else { low[axis] };
    let along = scene.scene_from_index.transform_vector3(DVec3::AXES[axis] * scene.dims[axis] as f64);
    (scene_from_share(scene, share), along)
}

/// Intersects a clip plane with the grid's box: the corners of a convex polygon, in order; empty if the plane lies
/// outside.
pub(crate) fn plane_section(plane: &ClipPlane, scene: &SceneSpace) -> Vec<DVec3> {
    let normal = plane.unit_normal();
    let above = |point: DVec3| normal.dot(point) - plane.offset;
    let met = box_edges().filter_map(|pair| {
        let [a, b] = pair.map(|at| scene_from_share(scene, corner(DVec3::ZERO, DVec3::ONE, at)));
        let (from, to) = (above(a), above(b));
        ((from < 0.0) != (to < 0.0)).then(|| a.lerp(b, from / (from - to)))
    });
    let mut corners: Vec<DVec3> = met.collect();
    if corners.len() < 3 {
        return Vec::new();
    }
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let across = normal.any_orthonormal_vector();
    let up = normal.cross(across);
    let turn = |corner: &DVec3| (*corner - middle).dot(up).atan2((*corner - middle).dot(across));
    corners.sort_by(|a, b| turn(a).total_cmp(&turn(b)));
    corners
}

/// Returns the position of the clip plane's handle: the centroid of its section, or without one the point of the
/// plane nearest to the volume's centre.
pub(crate) fn plane_handle_position(section: &[DVec3], plane: &ClipPlane) -> DVec3 {
    if section.is_empty() {
        return plane.unit_normal() * plane.offset;
    }
    section.iter().sum::<DVec3>() / section.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    fn scene() -> SceneSpace {
        SceneSpace::new([20, 10, 20], DAffine3::IDENTITY)
    }

    #[test]
    fn sides_move_along_their_axes() {
        let crop = CropBox { low: [0.25, 0.0, 0.5], ..CropBox::default() };
        let (at, along) = crop_face(&crop, &scene(), 0, false);
        assert!((at - DVec3::new(-0.5, 0.0, 0.5)).length() < 1e-9, "{at}");
        assert!((along - DVec3::X * 2.0).length() < 1e-9, "{along}");
        let moved = CropBox { low: [0.35, 0.0, 0.5], ..crop };
        assert!((crop_face(&moved, &scene(), 0, false).0 - at - along * 0.1).length() < 1e-9);
        assert_eq!(crop_edges(&moved, &scene()).len(), 12);
    }

    #[test]
    fn sections_are_convex_polygons() {
        let plane = |normal: [f64; 3], offset| ClipPlane { on: true, normal, offset, ..ClipPlane::default() };
        for (normal, corners) in
            [([0.0, 1.0, 0.0], 4), ([1.0, 10.0, 1.0], 4), ([1.0, 1.0, 1.0], 6), ([1.0, 2.0, 1.0], 6)]
        {
            let plane = plane(normal, 0.0);
            let section = plane_section(&plane, &scene());
            assert_eq!(section.len(), corners, "{normal:?}");
            for at in 0..section.len() {
                let [a, b, c] = [0, 1, 2].map(|step| section[(at + step) % section.len()]);
                assert!((b - a).cross(c - b).dot(plane.unit_normal()) > -1e-12, "{normal:?}: {section:?}");
            }
            assert!(plane_handle_position(&section, &plane).length() < 1e-9);
        }
        let beyond = plane([0.0, 1.0, 0.0], 0.6);
        assert!(plane_section(&beyond, &scene()).is_empty());
        assert_eq!(plane_handle_position(&[], &beyond), DVec3::Y * 0.6);
    }
}
