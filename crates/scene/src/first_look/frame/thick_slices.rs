//! Thick slices: grids with few of them, far apart, are seen from their faces.

use crate::Camera;
use chiaroscuro_volume::Volume;

/// Grids of thick slices: fewer than this number, and distances of at least this many pixels. Hearts and prostates in
/// magnetic resonance have 10 to 15 slices of 4 to 7 pixels.
const MAX_THICK_SLICES: usize = 20;
const MIN_THICKNESS_RATIO: f64 = 4.0;

/// Largest share that the sides of a stack of thick slices have of the width of its faces in a picture (tan 35°): on
/// the sides only steps are seen.
const MAX_SIDE_SHARE: f64 = 0.7;

/// Returns the axis along which slices are few and thick; `None` for other grids.
pub(super) fn thick_slice_axis(volume: &Volume) -> Option<usize> {
    let spacing = volume.file_spacing_mm().to_array();
    (0..3).find(|&axis| {
        let in_slice = spacing[(axis + 1) % 3].max(spacing[(axis + 2) % 3]);
        volume.file_dims()[axis] < MAX_THICK_SLICES && spacing[axis] >= MIN_THICKNESS_RATIO * in_slice
    })
}

/// Turns a camera by as little as possible so that it faces thick slices: from their side only steps are seen. Slices
/// that are shifted against each other are seen along their stack, where they cover each other.
pub(crate) fn face_thick_slices(camera: &mut Camera, volume: &Volume) {
    let Some(axis) = thick_slice_axis(volume) else { return };
    let scene_from_index = volume.scene().scene_from_index.matrix3;
    let length = |axis: usize| scene_from_index.col(axis).length() * volume.dims()[axis] as f64;
    let width = length((axis + 1) % 3).min(length((axis + 2) % 3));
    let most = (MAX_SIDE_SHARE * (width / length(axis)).min(1.0)).atan();
    let along = scene_from_index.col(axis).normalize();
    let backward = camera.scene_from_view().z_axis;
    let along = if backward.dot(along) < 0.0 { -along } else { along };
    if backward.angle_between(along) <= most {
        return;
    }
    let aside = backward.reject_from(along).normalize_or(along.any_orthonormal_vector());
    let turned = camera.up.scene_from_upright().transpose() * (along * most.cos() + aside * most.sin());
    camera.elevation_deg = turned.z.clamp(-1.0, 1.0).asin().to_degrees();
    camera.azimuth_deg = turned.y.atan2(turned.x).to_degrees();
    camera.roll_deg = 0.0;
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DVec3};

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
                let least = MAX_SIDE_SHARE.atan().cos() - 1e-9;
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

    #[test]
    fn slices_that_are_shifted_are_seen_along_their_stack() {
        let dims = [40, 40, 10];
        let stack = DVec3::new(8.0, 8.0, 15.0);
        let geometry = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Y, stack));
        let samples = Samples::U8(vec![200; dims.iter().product()]);
        let volume = Volume::new("shifted", dims, geometry, samples).unwrap();
        let camera = first_settings(&volume, &Histogram::from_volume(&volume)).camera;
        let along = camera.scene_from_view().z_axis.dot(stack.normalize()).abs();
        assert!(along >= MAX_SIDE_SHARE.atan().cos(), "{along}");
        for at in 0..8 {
            let corner = [0, 1, 2].map(|axis| f64::from(at >> axis & 1) * (dims[axis] - 1) as f64);
            let place = volume.scene().scene_from_index.transform_point3(corner.into());
            let (x, y, _) = camera.pixel_from_scene(place, 400.0, 300.0).unwrap();
            assert!((0.0..400.0).contains(&x) && (0.0..300.0).contains(&y), "{corner:?}: {x} {y}");
        }
    }
}
