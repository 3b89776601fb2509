//! Built-in volume `sphere`: a sphere over a plate, the simplest scene with a shadow.

use glam::DVec3;

use super::shapes::SdfShape;
use super::voxelise::ScenePart;

/// Returns a sphere (value 200, radius ⅓) that floats above a plate (value 90, its top at z = −0.62).
pub(super) fn parts() -> Vec<ScenePart> {
    let sphere = SdfShape::Sphere { centre: DVec3::new(0.0, 0.0, 0.25), radius: 1.0 / 3.0 };
    let plate = SdfShape::upright_box([0.0, 0.0, -0.67], [0.9, 0.9, 0.05], 0.0);
    vec![ScenePart { value: 200, shape: sphere }, ScenePart { value: 90, shape: plate }]
}

#[cfg(test)]
mod tests {
    use crate::synthetic::builtin;

    #[test]
    fn the_sphere_has_its_volume() {
        let volume = builtin("sphere", Some(64)).unwrap();
        let above_plate = |z: usize| (z as f64 + 0.5) / 32.0 - 1.0 > -0.5;
        let sum: f64 = (0..64usize.pow(3))
            .filter(|voxel| above_plate(voxel / 4096))
            .map(|voxel| volume.samples().value(voxel))
            .sum();
        let expected = 4.0 / 3.0 * std::f64::consts::PI / 27.0;
        let found = sum / 200.0 * (2.0 / 64.0f64).powi(3);
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
        assert_eq!(volume.value_range(), (0.0, 200.0).into());
        assert_eq!(volume.value(32, 32, 11), 90.0);
    }
}
