//! Clipping of the volume: by a crop box and a plane, each for the eye, for the light or for both, and by shapes.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::clip_effect::ClipEffect;
use super::shape_cuts::{BoxCut, CutAction, CutShape, HalfSpaceCut, ShapeCut, enabled_id};
use chiaroscuro_volume::math::{Aabb, ClipRegion, HalfSpace, SceneSpace};

/// Largest distance of a clip plane from the centre, in scene units: that of a cube's corner, √3, with a margin.
pub const MAX_PLANE_OFFSET: f64 = 2.0;

/// Smallest extent of a crop box along an axis, as a fraction of the volume.
pub const MIN_CROP_EXTENT: f64 = 0.001;

/// Crop box along the axes of the grid; everything outside is cut away.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CropBox {
    /// Enables clipping by the box.
    pub on: bool,
    /// Lower bound along each axis, as a fraction of the grid: 0 … 1.
    pub low: [f64; 3],
    /// Upper bound along each axis, as a fraction of the grid: 0 … 1.
    pub high: [f64; 3],
    /// Effect on the part outside the box.
    pub effect: ClipEffect,
}

impl Default for CropBox {
    fn default() -> Self {
        Self { on: false, low: [0.0; 3], high: [1.0; 3], effect: ClipEffect::Removed }
    }
}

/// Clip plane; everything on the side to which its normal points is cut away.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ClipPlane {
    /// Enables clipping by the plane.
    pub on: bool,
    /// Normal in scene space; its length is ignored.
    pub normal: [f64; 3],
    /// Distance from the centre of the volume along the normal, in scene units.
    pub offset: f64,
    /// Effect on the part in front of the plane.
    pub effect: ClipEffect,
}

impl Default for ClipPlane {
    fn default() -> Self {
        // Cuts away the half that is nearer to the default camera.
        Self { on: false, normal: [0.0, -1.0, 0.0], offset: 0.0, effect: ClipEffect::Removed }
    }
}

impl ClipPlane {
    /// Returns the normal as a unit vector.
    pub fn unit_normal(&self) -> DVec3 {
        DVec3::from(self.normal).normalize_or(DVec3::NEG_Y)
    }

    /// Enables the plane and places it perpendicular to a direction (to the camera, say), through a point of the
    /// scene.
    pub fn place_facing(&mut self, direction: DVec3, through: DVec3) {
        let normal = direction.normalize_or(DVec3::NEG_Y);
        *self = Self { on: true, normal: normal.into(), offset: normal.dot(through), effect: self.effect };
    }
}

/// Clipping settings of an image.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Clipping {
    /// Crop box along the grid's axes.
    pub crop: CropBox,
    /// Clip plane with a free orientation.
    pub plane: ClipPlane,
    /// Cuts by shapes in the order in which they are applied, at most [`super::shape_cuts::MAX_SHAPE_CUTS`].
    pub shapes: Vec<ShapeCut>,
}

/// Part of the volume that is left after clipping, for the eye or for the light.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClippedPart {
    crop: Option<[[f64; 3]; 2]>,
    plane: Option<([f64; 3], f64)>,
}

impl Clipping {
    /// Returns the part of the volume that is visible.
    pub fn visible_part(&self) -> ClippedPart {
        self.part_where(ClipEffect::is_invisible)
    }

    /// Returns the part of the volume that attenuates light.
    pub fn shadowing_part(&self) -> ClippedPart {
        self.part_where(ClipEffect::is_shadowless)
    }

    /// Returns the cuts by shapes that are enabled.
    pub fn enabled_shapes(&self) -> impl Iterator<Item = &ShapeCut> {
        self.shapes.iter().filter(|cut| cut.on)
    }

    /// Returns the same cuts by shapes alone, which hide voxels: the crop box and the plane are the last of them.
    pub(crate) fn by_shapes(&self) -> Self {
        let Self { crop, plane, shapes } = self;
        let mut shapes = shapes.clone();
        if crop.on {
            let shape = CutShape::Box(BoxCut { low: crop.low, high: crop.high });
            shapes.push(ShapeCut { on: true, action: CutAction::Keep, effect: crop.effect, shape });
        }
        if plane.on {
            let shape = CutShape::HalfSpace(HalfSpaceCut { normal: plane.normal, offset: plane.offset });
            shapes.push(ShapeCut { on: true, action: CutAction::Hide, effect: plane.effect, shape });
        }
        Self {
            crop: CropBox { on: false, ..crop.clone() },
            plane: ClipPlane { on: false, ..plane.clone() },
            shapes,
        }
    }

    /// Returns a hash of the cuts by shapes that are enabled; `None` if there are none.
    pub fn shapes_id(&self) -> Option<u64> {
        enabled_id(&self.shapes)
    }

    fn part_where(&self, counts: impl Fn(ClipEffect) -> bool) -> ClippedPart {
        // Shapes hide voxels by a mask.
        let Self { crop, plane, shapes: _ } = self;
        let cuts = crop.low.iter().chain(&crop.high).any(|&at| at > 0.0 && at < 1.0);
        ClippedPart {
            crop: (crop.on && cuts && counts(crop.effect)).then_some([crop.low, crop.high]),
            plane: (plane.on && counts(plane.effect)).then_some((plane.normal, plane.offset)),
        }
    }
}

impl ClippedPart {
    /// Returns true if nothing is cut away.
    pub fn is_unclipped(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the remaining part in index space. Faces at the border of the grid cut nothing, because the kernel
    /// spreads material beyond it.
    pub fn region(&self, scene: &SceneSpace) -> ClipRegion {
        let mut region = ClipRegion::UNBOUNDED;
        if let Some([low, high]) = self.crop {
            let grid = Aabb::of_grid(scene.dims, 0.0);
            for axis in 0..3 {
                let at = |share: f64| grid.min[axis] + share * (grid.max[axis] - grid.min[axis]);
                if low[axis] > 0.0 {
                    region.low[axis] = at(low[axis]);
                }
                if high[axis] < 1.0 {
                    region.high[axis] = at(high[axis]);
                }
            }
        }
        region.plane = self.plane.map(|(normal, offset)| {
            let unit = DVec3::from(normal).normalize_or(DVec3::NEG_Y);
            // n · (A p + t) ≤ d is (Aᵀ n) · p ≤ d − n · t.
            let map = &scene.scene_from_index;
            let in_index = map.matrix3.transpose() * unit;
            let length = in_index.length();
            HalfSpace { normal: in_index / length, offset: (offset - unit.dot(map.translation)) / length }
        });
        region
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    #[test]
    fn effects_say_who_is_concerned() {
        let mut cuts =
            Clipping { plane: ClipPlane { on: true, ..ClipPlane::default() }, ..Clipping::default() };
        for (effect, eye, light) in [
            (ClipEffect::Removed, false, false),
            (ClipEffect::Hidden, false, true),
            (ClipEffect::Shadowless, true, false),
        ] {
            cuts.plane.effect = effect;
            assert_eq!(
                (cuts.visible_part().is_unclipped(), cuts.shadowing_part().is_unclipped()),
                (eye, light),
                "{effect:?}"
            );
        }
        cuts.plane.on = false;
        cuts.crop.on = true;
        assert!(cuts.visible_part().is_unclipped(), "a box around all cuts nothing");
        cuts.crop.low[1] = 0.25;
        assert!(!cuts.visible_part().is_unclipped() && !cuts.shadowing_part().is_unclipped());
    }

    #[test]
    fn regions_lie_where_the_scene_says() {
        let turned = DMat3::from_rotation_z(0.4) * DMat3::from_diagonal(DVec3::new(1.0, 0.5, 2.0));
        let scene = SceneSpace::new([40, 80, 20], DAffine3::from_mat3_translation(turned, DVec3::splat(7.0)));
        let cuts = Clipping {
            crop: CropBox { on: true, low: [0.25, 0.0, 0.0], high: [1.0, 0.5, 1.0], ..CropBox::default() },
            plane: ClipPlane { on: true, normal: [1.0, 2.0, -2.0], offset: 0.1, ..ClipPlane::default() },
            shapes: Vec::new(),
        };
        let region = cuts.visible_part().region(&scene);
        assert_eq!(region.low, DVec3::new(9.5, f64::NEG_INFINITY, f64::NEG_INFINITY));
        assert_eq!(region.high, DVec3::new(f64::INFINITY, 39.5, f64::INFINITY));
        let plane = region.plane.unwrap();
        assert!((plane.normal.length() - 1.0).abs() < 1e-12);
        let normal = cuts.plane.unit_normal();
        for point in [DVec3::new(3.0, 8.0, 1.0), DVec3::new(30.0, 60.0, 19.0), DVec3::new(12.0, 0.0, 5.0)] {
            let within = 0.1 - normal.dot(scene.scene_from_index.transform_point3(point));
            assert_eq!(plane.signed_distance(point) > 0.0, within > 0.0, "{point}");
        }
    }
}
