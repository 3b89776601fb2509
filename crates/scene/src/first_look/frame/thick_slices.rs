//! Thick slices: grids with few of them, far apart, are seen from their faces.

use crate::Camera;
use chiaroscuro_volume::Volume;

/// Grids of thick slices: fewer than this number, and distances of at least this many pixels. Hearts and prostates in
/// magnetic resonance have 10 to 15 slices of 4 to 7 pixels.
const MAX_THICK_SLICES: usize = 20;
const MIN_THICKNESS_RATIO: f64 = 4.0;

/// Largest angle in degrees between the direction of view and the normal of thick slices: their steps then cover less
/// of the picture (tan 35° = 0.7) than their faces do.
const MAX_SLICE_ANGLE_DEG: f64 = 35.0;

/// Returns the axis along which slices are few and thick; `None` for other grids.
pub(super) fn thick_slice_axis(volume: &Volume) -> Option<usize> {
    let spacing = volume.file_spacing_mm().to_array();
    (0..3).find(|&axis| {
        let in_slice = spacing[(axis + 1) % 3].max(spacing[(axis + 2) % 3]);
        volume.file_dims()[axis] < MAX_THICK_SLICES && spacing[axis] >= MIN_THICKNESS_RATIO * in_slice
    })
}

/// Turns a camera by as little as possible so that it faces thick slices: from their side only steps are seen.
pub(crate) fn face_thick_slices(camera: &mut Camera, volume: &Volume) {
    let Some(axis) = thick_slice_axis(volume) else { return };
    let scene_from_index = volume.scene().scene_from_index.matrix3;
    let normal = scene_from_index.col((axis + 1) % 3).cross(scene_from_index.col((axis + 2) % 3)).normalize();
    let backward = camera.scene_from_view().z_axis;
    let normal = if backward.dot(normal) < 0.0 { -normal } else { normal };
    let most = MAX_SLICE_ANGLE_DEG.to_radians();
    if backward.angle_between(normal) <= most {
        return;
    }
    let aside = backward.reject_from(normal).normalize_or(normal.any_orthonormal_vector());
    let turned = camera.up.scene_from_upright().transpose() * (normal * most.cos() + aside * most.sin());
    camera.elevation_deg = turned.z.clamp(-1.0, 1.0).asin().to_degrees();
    camera.azimuth_deg = turned.y.atan2(turned.x).to_degrees();
    camera.roll_deg = 0.0;
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Histogram, Samples};

    #[test]
    fn thick_slices_are_faced() {
        let block = |dims: [usize; 3], spacing: DVec3, is_anatomical| {
            let samples = Samples::U8(vec![200; dims.iter().product()]);
            let volume = Volume::with_spacing("thick", dims, spacing, samples).unwrap();
            volume.with_anatomical_axes(is_anatomical)
        };
        let aimed = |volume: &Volume| {
            first_settings(volume, &Histogram::from_volume(volume)).camera.scene_from_view().z_axis
        };
        for is_anatomical in [false, true] {
            for axis in 0..3 {
                let (mut dims, mut spacing) = ([30; 3], DVec3::ONE);
                (dims[axis], spacing[axis]) = (8, 5.0);
                let towards_eye = aimed(&block(dims, spacing, is_anatomical)).to_array()[axis].abs();
                let least = MAX_SLICE_ANGLE_DEG.to_radians().cos() - 1e-9;
                assert!(towards_eye >= least, "{axis}: {towards_eye}");
            }
        }
        // Thinner slices, or more of them, are seen as ever: a body from its front.
        let usual = aimed(&block([30; 3], DVec3::ONE, true));
        for (dims, spacing) in [([30, 30, 8], 3.0), ([20, 20, 24], 5.0)] {
            let found = aimed(&block(dims, DVec3::new(1.0, 1.0, spacing), true));
            assert!((found - usual).length() < 1e-9, "{dims:?} {spacing}: {found}");
        }
    }
}
