//! Mask of the voxels that cuts by shapes hide: one shape after another, each with an edge as wide as a voxel.

mod component;
mod front_depth;
mod hidden_shares;
mod outline;
mod silhouette;

use self::component::component_with_skin;
use self::front_depth::FrontDepth;
use self::hidden_shares::{Distance, HiddenShares, RowChanges};
use self::outline::OutlineDistance;
pub use self::silhouette::ComponentSilhouette;
use crate::{BoxCut, CutDepth, CutShape, ShapeCut, SphereCut};
use chiaroscuro_volume::{Volume, VoxelMask, math::SceneSpace};
use glam::DVec3;

/// Share above which a voxel counts as hidden already.
const HALF_HIDDEN: u8 = 127;

/// Returns the mask of the voxels that cuts hide, applied in their order; `None` if all of the volume is visible.
/// Takes a tenth of a second per cut for 256³ voxels on two cores.
pub fn mask_from_shapes<'a>(
    volume: &Volume,
    cuts: impl IntoIterator<Item = &'a ShapeCut>,
) -> Option<VoxelMask> {
    let mut cuts = cuts.into_iter().peekable();
    cuts.peek()?;
    let mut hidden = HiddenShares::new(volume.voxel_count());
    for cut in cuts {
        apply_shape(volume, &mut hidden, cut);
    }
    let HiddenShares { from_eye, from_light } = hidden;
    match from_light {
        None => VoxelMask::from_hidden_shares(volume.dims(), from_eye),
        Some(from_light) => VoxelMask::from_shares_by_observer(volume.dims(), from_eye, from_light),
    }
}

/// Hides or shows voxels inside or outside a shape. Surfaces and components are those that the eye sees so far.
fn apply_shape(volume: &Volume, hidden: &mut HiddenShares, cut: &ShapeCut) {
    let scene = volume.scene();
    let edge = voxel_edge(&scene);
    // A voxel's step along x, in edges of a cube of its size. Seen in perspective, distances change a little faster.
    let change = 2.0 * scene.scene_from_index.matrix3.x_axis.length() / edge;
    let rows = |max_change| RowChanges { dims: scene.dims, max_change };
    match &cut.shape {
        CutShape::Outline(outline) => {
            let distance = OutlineDistance::new(outline, &scene);
            let front = match (outline.depth, outline.surface) {
                (CutDepth::Front, Some(values)) => {
                    Some(FrontDepth::new(&distance, volume, &hidden.from_eye, values))
                }
                _ => None,
            };
            let limit = front.as_ref().map(|front| {
                |index: DVec3| {
                    let (place, depth) = distance.place_and_depth(index);
                    front.distance_before_end(place, depth) / edge
                }
            });
            let limit = limit.as_ref().map(|limit| limit as &Distance<'_>);
            hidden.apply_distance(cut, rows(change), &|index| distance.voxels_inside(index), limit);
        }
        CutShape::Sphere(SphereCut { center, radius }) => {
            let center = DVec3::from(*center);
            let inside =
                |index| (radius - scene.scene_from_index.transform_point3(index).distance(center)) / edge;
            hidden.apply_distance(cut, rows(change), &inside, None);
        }
        CutShape::Box(BoxCut { low, high }) => {
            // From the first to the last face of the grid.
            let dims = DVec3::from(scene.dims.map(|n| n as f64));
            let [low, high] = [low, high].map(|bound| DVec3::from(*bound) * dims - 0.5);
            let inside = |index: DVec3| (index - low).min(high - index).min_element();
            hidden.apply_distance(cut, rows(1.0), &inside, None);
        }
        CutShape::HalfSpace(plane) => {
            let normal = plane.unit_normal();
            // Voxels per scene unit across the plane.
            let per_unit = 1.0 / (scene.scene_from_index.matrix3.transpose() * normal).length();
            let inside = |index| {
                (normal.dot(scene.scene_from_index.transform_point3(index)) - plane.offset) * per_unit
            };
            hidden.apply_distance(cut, rows(1.0), &inside, None);
        }
        CutShape::Component(component) => {
            if let Some(inside) = component_with_skin(volume, &hidden.from_eye, component) {
                hidden.apply_voxels(cut, &inside);
            }
        }
    }
}

/// Returns true if a voxel is neither missing nor hidden so far by more than half.
fn is_visible(volume: &Volume, hidden: &[u8], voxel: usize) -> bool {
    hidden[voxel] <= HALF_HIDDEN && !volume.missing().is_some_and(|missing| missing.contains(voxel))
}

/// Returns the edge of a cube of a voxel's size, in scene units.
fn voxel_edge(scene: &SceneSpace) -> f64 {
    scene.scene_from_index.matrix3.determinant().abs().cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, ClipEffect, ComponentCut, CutAction, HalfSpaceCut, OutlineCut, Projection};
    use chiaroscuro_volume::{Observer, Samples, ValueRange};

    const EDGE: usize = 16;

    fn volume(value: impl Fn([usize; 3]) -> u8) -> Volume {
        let values = (0..EDGE * EDGE * EDGE)
            .map(|at| value([at % EDGE, at / EDGE % EDGE, at / EDGE / EDGE]))
            .collect();
        Volume::with_spacing("t", [EDGE; 3], DVec3::ONE, Samples::U8(values)).unwrap()
    }

    fn cut(action: CutAction, shape: CutShape) -> ShapeCut {
        ShapeCut { action, shape, ..ShapeCut::default() }
    }

    fn hidden_at(mask: &VoxelMask, [x, y, z]: [usize; 3]) -> u8 {
        mask.hidden_from(Observer::Eye)[x + EDGE * (y + EDGE * z)]
    }

    fn is_inverse(a: &VoxelMask, b: &VoxelMask) -> bool {
        let [a, b] = [a, b].map(|mask| mask.hidden_from(Observer::Eye));
        a.iter().zip(b).all(|(a, b)| *a == 255 - b)
    }

    /// Square outline of half of the picture's height, as seen through a camera.
    fn square(camera: Camera) -> CutShape {
        let points = vec![[0.375, 0.25], [0.625, 0.25], [0.625, 0.75], [0.375, 0.75]];
        CutShape::Outline(OutlineCut { camera, aspect: 2.0, points, ..OutlineCut::default() })
    }

    #[test]
    fn spheres_have_an_edge_of_a_voxel() {
        let volume = volume(|[x, ..]| x as u8);
        let scene = volume.scene();
        let center = scene.scene_from_index.transform_point3(DVec3::splat(8.0));
        let radius = 4.25 * voxel_edge(&scene);
        let sphere = CutShape::Sphere(SphereCut { center: center.into(), radius });
        let mask = mask_from_shapes(&volume, &[cut(CutAction::Hide, sphere.clone())]).unwrap();
        let along_x = [3, 4, 5, 8, 12, 13].map(|x| hidden_at(&mask, [x, 8, 8]));
        assert_eq!(along_x, [0, 191, 255, 255, 191, 0]);
        let kept = mask_from_shapes(&volume, &[cut(CutAction::Keep, sphere.clone())]).unwrap();
        assert!(is_inverse(&kept, &mask));
        // Restored, everything is visible again; in the other order the sphere is hidden.
        let [hide, restore] = [CutAction::Hide, CutAction::Restore].map(|action| cut(action, sphere.clone()));
        assert_eq!(
            mask_from_shapes(&volume, [&hide, &restore]).map(|mask| hidden_at(&mask, [8, 8, 8])),
            None
        );
        assert_eq!(mask_from_shapes(&volume, [&restore, &hide]), Some(mask));
    }

    #[test]
    fn effects_hide_from_the_eye_or_from_light() {
        let volume = volume(|[x, ..]| x as u8);
        let half =
            |low: f64, high: f64| CutShape::Box(BoxCut { low: [low, 0.0, 0.0], high: [high, 1.0, 1.0] });
        let with_effect = |effect, shape| ShapeCut { effect, ..cut(CutAction::Hide, shape) };
        let hidden = |cuts: &[ShapeCut], observer| {
            let mask = mask_from_shapes(&volume, cuts).unwrap();
            [1, 5, 9, 13].map(|x| mask.hidden_from(observer)[x + EDGE * 8])
        };
        let casting = with_effect(ClipEffect::Hidden, half(0.0, 0.5));
        let shadowless = with_effect(ClipEffect::Shadowless, half(0.25, 0.75));
        let removed = with_effect(ClipEffect::Removed, half(0.75, 1.0));
        let cuts = [casting.clone(), shadowless.clone(), removed.clone()];
        assert_eq!(hidden(&cuts, Observer::Eye), [255, 255, 0, 255]);
        assert_eq!(hidden(&cuts, Observer::Light), [0, 255, 255, 255]);
        // A later cut shows nothing to light that an earlier one removed, and a restored part is visible to both.
        let cuts = [removed.clone(), casting.clone()];
        assert_eq!(hidden(&cuts, Observer::Light), [0, 0, 0, 255]);
        let again = ShapeCut { effect: ClipEffect::Hidden, ..cut(CutAction::Restore, half(0.0, 1.0)) };
        assert_eq!(mask_from_shapes(&volume, &[casting, shadowless, removed, again]), None);
        // A part that is kept alone, with shadows that stay: light sees everything.
        let kept = ShapeCut { effect: ClipEffect::Hidden, ..cut(CutAction::Keep, half(0.25, 0.5)) };
        let kept = std::slice::from_ref(&kept);
        assert_eq!(hidden(kept, Observer::Eye), [255, 0, 255, 255]);
        assert_eq!(hidden(kept, Observer::Light), [0; 4]);
    }

    #[test]
    fn half_spaces_end_at_their_plane() {
        let volume = volume(|[x, ..]| x as u8);
        let scene = volume.scene();
        let at = scene.scene_from_index.transform_point3(DVec3::new(7.25, 0.0, 0.0));
        let plane = HalfSpaceCut { normal: [2.0, 0.0, 0.0], offset: at.x };
        let mask = mask_from_shapes(&volume, &[cut(CutAction::Hide, CutShape::HalfSpace(plane))]).unwrap();
        let along_x = [0, 6, 7, 8, 15].map(|x| hidden_at(&mask, [x, 3, 12]));
        assert_eq!(along_x, [0, 0, 64, 255, 255]);
    }

    #[test]
    fn boxes_end_where_their_fractions_say() {
        let volume = volume(|[x, ..]| x as u8);
        // Faces at indices 3.5, 7.75 and at the end of the grid.
        let bounds = BoxCut { low: [0.25, 0.0, 0.5], high: [8.25 / 16.0, 1.0, 1.0] };
        let mask = mask_from_shapes(&volume, &[cut(CutAction::Hide, CutShape::Box(bounds))]).unwrap();
        let along_x = [2, 3, 4, 7, 8, 9].map(|x| hidden_at(&mask, [x, 5, 12]));
        assert_eq!(along_x, [0, 0, 255, 255, 64, 0]);
        let along_z = [7, 8, 15].map(|z| hidden_at(&mask, [5, 0, z]));
        assert_eq!(along_z, [0, 255, 255], "the outermost voxels are hidden as a whole");
        let kept = mask_from_shapes(&volume, &[cut(CutAction::Keep, CutShape::Box(bounds))]).unwrap();
        assert!(is_inverse(&kept, &mask));
    }

    #[test]
    fn outlines_hide_the_voxels_that_project_into_them() {
        let volume = volume(|[x, ..]| x as u8);
        let scene = volume.scene();
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera { projection, azimuth_deg: 23.0, elevation_deg: 31.0, ..Camera::default() };
            let mask = mask_from_shapes(&volume, &[cut(CutAction::Hide, square(camera.clone()))]).unwrap();
            let mut counts = [0; 3];
            for z in 0..EDGE {
                for y in 0..EDGE {
                    for x in 0..EDGE {
                        let index = DVec3::new(x as f64, y as f64, z as f64);
                        let point = scene.scene_from_index.transform_point3(index);
                        let (px, py, _) = camera.pixel_from_scene(point, 800.0, 400.0).unwrap();
                        let inside = (px - 400.0).abs().max((py - 200.0).abs()) < 100.0;
                        let share = hidden_at(&mask, [x, y, z]);
                        // An edge as wide as a voxel lies between both.
                        assert!(if inside { share >= 127 } else { share <= 128 }, "{index}: {share}");
                        counts[match share {
                            0 => 0,
                            255 => 2,
                            _ => 1,
                        }] += 1;
                    }
                }
            }
            assert!(counts.iter().all(|&count| count > 100), "{projection:?}: {counts:?}");
        }
    }

    #[test]
    fn an_edge_crossed_twice_is_inside() {
        // Loop that a hand draws where it begins: a corner of the square once more.
        let camera = Camera { projection: Projection::Orthographic, ..Camera::default() };
        let CutShape::Outline(mut outline) = square(camera) else { panic!("an outline") };
        outline.points.extend([[0.45, 0.25], [0.45, 0.5]]);
        let distance = OutlineDistance::new(&outline, &volume(|_| 0).scene());
        assert!(distance.voxels_inside(DVec3::splat(7.5)) > 1.0);
    }

    #[test]
    fn the_front_alone_is_cut() {
        // Two walls across the line of sight, along y.
        let volume = volume(|[_, y, _]| if matches!(y, 3..=5 | 10..=12) { 200 } else { 0 });
        // Parallel rays also see what lies beside the eye or behind it.
        let near = Camera { projection: Projection::Orthographic, distance: 0.1, ..Camera::default() };
        for (camera, azimuth_deg, hidden) in
            [(Camera::default(), -90.0, 4), (Camera::default(), 90.0, 11), (near, 90.0, 11)]
        {
            let fov_y_deg = 2.0 * (1.4 / camera.distance).atan().to_degrees();
            let camera = Camera { azimuth_deg, elevation_deg: 0.0, fov_y_deg, ..camera };
            let CutShape::Outline(outline) = square(camera) else { panic!("an outline") };
            let surface = Some(ValueRange::new(100.0, 255.0));
            let mask_of = |depth| {
                let outline = OutlineCut { depth, surface, ..outline.clone() };
                mask_from_shapes(&volume, &[cut(CutAction::Hide, CutShape::Outline(outline))]).unwrap()
            };
            let walls = |mask: &VoxelMask| [4, 11].map(|y| hidden_at(mask, [8, y, 8]));
            assert_eq!(walls(&mask_of(CutDepth::Through)), [255, 255]);
            let front = mask_of(CutDepth::Front);
            assert_eq!(walls(&front), [4, 11].map(|y| if y == hidden { 255 } else { 0 }), "{azimuth_deg}");
            assert_eq!(hidden_at(&front, [8, hidden, 0]), 0, "beside the outline");
        }
    }

    #[test]
    fn components_end_where_values_do() {
        // Two blocks, one bridge between them below the lowest value, and a skin around each.
        let volume = volume(|[x, y, z]| {
            let is_across = |margin: usize| [y, z].iter().all(|at| (4 - margin..=9 + margin).contains(at));
            match x {
                2..=5 | 10..=13 if is_across(0) => 200,
                6..=9 if (y, z) == (7, 7) => 90,
                1 | 6 if is_across(1) => 50,
                _ => 0,
            }
        });
        let seed = volume.scene().scene_from_index.transform_point3(DVec3::new(1.2, 6.0, 6.0)).into();
        let component = |values| CutShape::Component(ComponentCut { seed, values });
        let hide = |values| mask_from_shapes(&volume, &[cut(CutAction::Hide, component(values))]).unwrap();
        let mask = hide(ValueRange::new(100.0, 255.0));
        let along_x = [0, 2, 5, 6, 8, 10, 13].map(|x| hidden_at(&mask, [x, 6, 6]));
        assert_eq!(along_x, [255, 255, 255, 255, 0, 0, 0]);
        // The bridge counts among lower values.
        assert_eq!(hidden_at(&hide(ValueRange::new(80.0, 255.0)), [13, 6, 6]), 255);
        assert_eq!(
            mask_from_shapes(&volume, &[cut(CutAction::Hide, component(ValueRange::new(240.0, 255.0)))]),
            None,
            "no value in the range"
        );
    }
}
