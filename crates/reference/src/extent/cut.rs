//! Crop box and clip plane as half-spaces in scene space: the uncut part of a ray segment, and the normals of faces.

use glam::DVec3;

use crate::kernel::cubic_b_spline;
use crate::{Reference, ReferenceFault};
use chiaroscuro_scene::{ClipEffect, ClipPlane, CropBox};

/// Depth below a face, in voxels, from which material attenuates light fully.
const SOFT_CUT_VOXELS: f64 = 2.0;

/// Intersection of half-spaces that remains uncut: all p with normal · p ≤ offset.
pub(crate) struct UncutRegion {
    bounds: Vec<(DVec3, f64)>,
}

impl Reference<'_> {
    /// Returns the part visible to the eye.
    pub(crate) fn visible_region(&self) -> UncutRegion {
        self.uncut_region(&[ClipEffect::Removed, ClipEffect::Hidden])
    }

    /// Returns the part that attenuates light.
    pub(crate) fn attenuating_region(&self) -> UncutRegion {
        self.uncut_region(&[ClipEffect::Removed, ClipEffect::Shadowless])
    }

    /// Returns the faces at which visible material ends: cuts, and faces of the grid unless presence already accounts
    /// for these.
    pub(crate) fn visible_faces(&self) -> UncutRegion {
        if self.presence.is_some() || self.classified.is_some() {
            return self.visible_region();
        }
        let crop = &self.settings.cuts.crop;
        let is_cropped = crop.on && crop.effect != ClipEffect::Shadowless;
        let mut bounds = self.visible_region().bounds;
        for axis in 0..3 {
            if !(is_cropped && crop.low[axis] > 0.0) {
                bounds.push(self.face(axis, -1.0, -0.5));
            }
            if !(is_cropped && crop.high[axis] < 1.0) {
                bounds.push(self.face(axis, 1.0, self.scene.dims[axis] as f64 - 0.5));
            }
        }
        UncutRegion { bounds }
    }

    /// Returns the half-space inside a face across an axis of index space, at coordinate `at`, that faces along the
    /// axis or against it.
    fn face(&self, axis: usize, outward: f64, at: f64) -> (DVec3, f64) {
        let to_scene = |index: DVec3| self.scene.scene_from_index.transform_point3(index);
        // A face is spanned by the two other axes, and need not be perpendicular to its own.
        let side = |k: usize| to_scene(DVec3::AXES[(axis + k) % 3]) - to_scene(DVec3::ZERO);
        let across = side(1).cross(side(2)).normalize();
        let normal = across * across.dot(side(0)).signum() * outward;
        (normal, normal.dot(to_scene(DVec3::AXES[axis] * at)))
    }

    fn uncut_region(&self, effects: &[ClipEffect]) -> UncutRegion {
        let CropBox { on, low, high, effect } = &self.settings.cuts.crop;
        let mut bounds = Vec::new();
        if *on && effects.contains(effect) {
            for axis in 0..3 {
                let n = self.scene.dims[axis] as f64;
                if low[axis] > 0.0 {
                    bounds.push(self.face(axis, -1.0, low[axis] * n - 0.5));
                }
                if high[axis] < 1.0 {
                    bounds.push(self.face(axis, 1.0, high[axis] * n - 0.5));
                }
            }
        }
        let ClipPlane { on, normal, offset, effect } = &self.settings.cuts.plane;
        if *on && effects.contains(effect) {
            bounds.push((DVec3::from(*normal).normalize(), *offset));
        }
        UncutRegion { bounds }
    }

    /// Returns the gradient in scene space of a solid that ends at cuts: for each face, the kernel's value at the
    /// distance in voxels.
    pub(crate) fn face_gradient(&self, seen: &UncutRegion, index: DVec3, stretch_level: f64) -> DVec3 {
        let place = self.scene.scene_from_index.transform_point3(index);
        let faces = seen.bounds.iter().map(|&(normal, offset)| {
            // Scene units per voxel across the face: |Aᵀ n|, where A takes index space to the scene.
            let per_voxel = (self.scene.scene_from_index.matrix3.transpose() * normal).length();
            let width = stretch_level.exp2() * per_voxel;
            -normal * cubic_b_spline((offset - normal.dot(place)) / width) / width
        });
        faces.sum()
    }

    /// Returns the share of the material at a point of index space that attenuates light: 3t² − 2t³ of its depth
    /// below each face, up to [`SOFT_CUT_VOXELS`] voxels.
    pub(crate) fn attenuating_share(&self, remaining: &UncutRegion, index: DVec3) -> f64 {
        let place = self.scene.scene_from_index.transform_point3(index);
        let shares = remaining.bounds.iter().map(|&(normal, offset)| {
            let per_voxel = (self.scene.scene_from_index.matrix3.transpose() * normal).length();
            let t = ((offset - normal.dot(place)) / (SOFT_CUT_VOXELS * per_voxel)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        });
        shares.product()
    }

    /// Returns the share of the way between two index-space points that is not cut.
    pub(crate) fn uncut_share(&self, remaining: &UncutRegion, from: DVec3, to: DVec3) -> f64 {
        let share = self.uncut_span(remaining, from, to).map_or(0.0, |[begin, end]| end - begin);
        if self.options.fault == ReferenceFault::WholeSlabs { share.ceil() } else { share }
    }

    /// Returns where the part of the way between two index-space points that is not cut begins and ends, as shares of
    /// the way; `None` if all of it is cut.
    pub(crate) fn uncut_span(&self, remaining: &UncutRegion, from: DVec3, to: DVec3) -> Option<[f64; 2]> {
        let [from, to] = [from, to].map(|point| self.scene.scene_from_index.transform_point3(point));
        let (mut begin, mut end) = (0.0_f64, 1.0_f64);
        for &(normal, offset) in &remaining.bounds {
            // Signed distances of both ends outside the half-space.
            let [a, b] = [from, to].map(|point| normal.dot(point) - offset);
            match (a > 0.0, b > 0.0) {
                (true, true) => return None,
                (true, false) => begin = begin.max(a / (a - b)),
                (false, true) => end = end.min(a / (a - b)),
                (false, false) => {}
            }
        }
        (end > begin).then_some([begin, end])
    }
}
