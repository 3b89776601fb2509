//! Cuts by shapes: outlines drawn in the picture, spheres, boxes and connected components, each of which hides a part of
//! the volume, keeps it alone, or restores it. They are stored as they were made, and no voxel is changed.

use std::hash::{DefaultHasher, Hash, Hasher as _};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::clip_effect::ClipEffect;
use crate::{Camera, Projection};
use chiaroscuro_volume::ValueRange;
use chiaroscuro_volume::math::{Aabb, SceneSpace};

/// Largest number of cuts by shapes. One takes a tenth of a second for 256³ voxels on two cores.
pub const MAX_SHAPE_CUTS: usize = 32;

/// Largest number of corners of an outline: with more, a hand-drawn line gets no smoother.
pub const MAX_OUTLINE_POINTS: usize = 256;

/// Cut by a shape. Cuts are applied in the order of their list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ShapeCut {
    /// Enables the cut.
    pub on: bool,
    /// Action on the part inside the shape.
    pub action: CutAction,
    /// Effect on the part that is hidden; without one where a part is shown again.
    pub effect: ClipEffect,
    /// Shape of the part.
    pub shape: CutShape,
}

impl Default for ShapeCut {
    fn default() -> Self {
        Self { on: true, action: CutAction::Hide, effect: ClipEffect::Removed, shape: CutShape::default() }
    }
}

/// Action of a cut on the part inside its shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CutAction {
    /// Hides the part inside.
    #[default]
    Hide,
    /// Hides everything but the part inside.
    Keep,
    /// Shows again what earlier cuts hide inside.
    Restore,
}

impl CutAction {
    /// All actions, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Hide, Self::Keep, Self::Restore];

    /// Returns true if the action hides a part, from the eye, from light or from both.
    pub fn hides(self) -> bool {
        self != Self::Restore
    }
}

/// Kind of shape, for menus and names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CutShapeKind {
    /// Outline drawn in the picture.
    #[default]
    Outline,
    /// Sphere in the scene.
    Sphere,
    /// Box along the axes of the grid.
    Box,
    /// Half-space in front of a plane.
    HalfSpace,
    /// Connected component of voxels.
    Component,
}

impl CutShapeKind {
    /// All kinds, in the order of menus.
    pub const ALL: [Self; 5] = [Self::Outline, Self::Sphere, Self::Component, Self::Box, Self::HalfSpace];
}

/// Shape of a cut.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CutShape {
    /// Everything behind an outline drawn in the picture.
    Outline(OutlineCut),
    /// Sphere in the scene.
    Sphere(SphereCut),
    /// Box along the axes of the grid.
    Box(BoxCut),
    /// Everything in front of a plane.
    HalfSpace(HalfSpaceCut),
    /// Connected voxels around one of them.
    Component(ComponentCut),
}

impl Default for CutShape {
    fn default() -> Self {
        Self::Sphere(SphereCut::default())
    }
}

/// Closed outline drawn in a picture, with the camera of that picture.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct OutlineCut {
    /// Camera through which the outline was drawn.
    pub camera: Camera,
    /// Width of the picture divided by its height.
    pub aspect: f64,
    /// Corners, as fractions of the picture's width and height from its top left corner.
    pub points: Vec<[f64; 2]>,
    /// Depth to which the outline cuts.
    pub depth: CutDepth,
    /// Values of the surface that was seen inside the outline, in data units; `None` if none was.
    pub surface: Option<ValueRange>,
}

/// Depth to which an outline cuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CutDepth {
    /// Through the whole volume.
    #[default]
    Through,
    /// Through the first surface alone: along each ray, the values of the surface up to the first gap.
    Front,
}

/// Sphere in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SphereCut {
    /// Centre in scene space.
    pub center: [f64; 3],
    /// Radius in scene units.
    pub radius: f64,
}

impl Default for SphereCut {
    fn default() -> Self {
        Self { center: [0.0; 3], radius: 0.25 }
    }
}

/// Box along the axes of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BoxCut {
    /// Lower bound along each axis, as a fraction of the grid: 0 … 1.
    pub low: [f64; 3],
    /// Upper bound along each axis, as a fraction of the grid: 0 … 1.
    pub high: [f64; 3],
}

impl Default for BoxCut {
    fn default() -> Self {
        Self { low: [0.5; 3], high: [1.0; 3] }
    }
}

impl BoxCut {
    /// Creates the eighth of a grid that lies on a point's side of its middle along each axis; `eye` is a position in
    /// scene space.
    pub fn corner_towards(eye: DVec3, scene: &SceneSpace) -> Self {
        let grid = Aabb::of_grid(scene.dims, 0.0);
        let side = scene.index_from_scene.transform_point3(eye) - 0.5 * (grid.min + grid.max);
        let is_high = [0, 1, 2].map(|axis| side[axis] >= 0.0);
        Self {
            low: is_high.map(|is_high| if is_high { 0.5 } else { 0.0 }),
            high: is_high.map(|is_high| if is_high { 1.0 } else { 0.5 }),
        }
    }
}

/// Half-space in front of a plane in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HalfSpaceCut {
    /// Direction that the plane faces, in scene space; its length is ignored.
    pub normal: [f64; 3],
    /// Distance of the plane from the centre of the volume along the normal, in scene units.
    pub offset: f64,
}

impl Default for HalfSpaceCut {
    fn default() -> Self {
        Self { normal: [0.0, -1.0, 0.0], offset: 0.0 }
    }
}

impl HalfSpaceCut {
    /// Returns the normal as a unit vector.
    pub fn unit_normal(&self) -> DVec3 {
        DVec3::from(self.normal).normalize_or(DVec3::NEG_Y)
    }
}

/// Voxels with values in a range that are connected through their faces with the one nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ComponentCut {
    /// Point in scene space from which the voxels are looked for.
    pub seed: [f64; 3],
    /// Values of the connected voxels, in data units.
    pub values: ValueRange,
}

impl Default for ComponentCut {
    fn default() -> Self {
        Self { seed: [0.0; 3], values: ValueRange::new(0.0, 0.0) }
    }
}

/// Returns a hash of the enabled ones of a list of cuts; `None` if there are none.
pub(super) fn enabled_id(cuts: &[ShapeCut]) -> Option<u64> {
    let mut hasher = DefaultHasher::new();
    let mut count = 0;
    for ShapeCut { on: _, action, effect, shape } in cuts.iter().filter(|cut| cut.on) {
        action.hash(&mut hasher);
        action.hides().then_some(effect).hash(&mut hasher);
        shape.numbers().for_each(|number| number.to_bits().hash(&mut hasher));
        count += 1;
    }
    (count > 0).then(|| hasher.finish())
}

impl CutShape {
    /// Returns the kind of the shape.
    pub fn kind(&self) -> CutShapeKind {
        match self {
            Self::Outline(_) => CutShapeKind::Outline,
            Self::Sphere(_) => CutShapeKind::Sphere,
            Self::Box(_) => CutShapeKind::Box,
            Self::HalfSpace(_) => CutShapeKind::HalfSpace,
            Self::Component(_) => CutShapeKind::Component,
        }
    }

    /// Returns all numbers of the shape, after one that tells its kind.
    fn numbers(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Outline(OutlineCut { camera, aspect, points, depth, surface }) => {
                let front = surface.filter(|_| *depth == CutDepth::Front);
                let front = front.into_iter().flat_map(|values| [values.low, values.high]);
                let view = camera.scene_from_view().to_cols_array();
                let place = camera.position().to_array();
                let scale = camera.half_height_at_target(*aspect);
                let perspective = f64::from(u8::from(camera.projection == Projection::Perspective));
                let camera = view.into_iter().chain(place).chain([scale, camera.distance, perspective]);
                Box::new(
                    [0.0, *aspect]
                        .into_iter()
                        .chain(camera)
                        .chain(front)
                        .chain(points.iter().flatten().copied()),
                )
            }
            Self::Sphere(SphereCut { center, radius }) => Box::new([1.0, *radius].into_iter().chain(*center)),
            Self::Box(BoxCut { low, high }) => Box::new([3.0].into_iter().chain(*low).chain(*high)),
            Self::HalfSpace(HalfSpaceCut { normal, offset }) => {
                Box::new([4.0, *offset].into_iter().chain(*normal))
            }
            Self::Component(ComponentCut { seed, values }) => {
                Box::new([2.0, values.low, values.high].into_iter().chain(*seed))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    #[test]
    fn enabled_shapes_decide_the_id() {
        let sphere = |radius| ShapeCut {
            shape: CutShape::Sphere(SphereCut { radius, ..SphereCut::default() }),
            ..ShapeCut::default()
        };
        let id = enabled_id;
        let off = ShapeCut { on: false, ..sphere(0.1) };
        assert_eq!((id(&[]), id(std::slice::from_ref(&off))), (None, None));
        assert_eq!(id(&[off, sphere(0.2)]), id(&[sphere(0.2)]));
        assert_ne!(id(&[sphere(0.2)]), id(&[sphere(0.1)]));
        assert_ne!(id(&[sphere(0.2), sphere(0.1)]), id(&[sphere(0.1), sphere(0.2)]));
        let keep = ShapeCut { action: CutAction::Keep, ..sphere(0.2) };
        assert_ne!(id(&[keep]), id(&[sphere(0.2)]));
        let casting = ShapeCut { effect: ClipEffect::Hidden, ..sphere(0.2) };
        assert_ne!(id(std::slice::from_ref(&casting)), id(&[sphere(0.2)]));
        // Restored parts are visible to eye and light, whatever the effect.
        let restored = |effect| ShapeCut { action: CutAction::Restore, effect, ..sphere(0.2) };
        assert_eq!(id(&[restored(ClipEffect::Hidden)]), id(&[restored(ClipEffect::Removed)]));
        let outline = |azimuth_deg| ShapeCut {
            shape: CutShape::Outline(OutlineCut {
                camera: Camera { azimuth_deg, ..Camera::default() },
                aspect: 1.0,
                points: vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]],
                ..OutlineCut::default()
            }),
            ..ShapeCut::default()
        };
        assert_ne!(id(&[outline(1.0)]), id(&[outline(2.0)]));
        let boxed = |high| ShapeCut {
            shape: CutShape::Box(BoxCut { high: [high; 3], ..BoxCut::default() }),
            ..ShapeCut::default()
        };
        assert_ne!(id(&[boxed(0.8)]), id(&[boxed(0.9)]));
    }

    #[test]
    fn a_corner_lies_on_the_side_of_the_eye() {
        // Index axes that run the other way along x in the scene.
        let mirrored = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        let scene = SceneSpace::new([8, 16, 8], DAffine3::from_mat3_translation(mirrored, DVec3::ZERO));
        let eye = scene.scene_from_index.transform_point3(DVec3::new(-20.0, 30.0, 1.0));
        let corner = BoxCut::corner_towards(eye, &scene);
        assert_eq!((corner.low, corner.high), ([0.0, 0.5, 0.0], [0.5, 1.0, 0.5]));
    }
}
