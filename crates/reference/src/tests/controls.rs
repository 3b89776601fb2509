//! Tests of the settings of shadows.

use super::*;
use chiaroscuro_scene::ShadowAlgorithm;

#[test]
fn first_touch_is_brighter_and_live_controls_are_monotone() {
    let volume = ball([16; 3], DVec3::ONE);
    let mut settings = scene(LightGeometry::Parallel, [1.0, 0.5, 2.0], Projection::Orthographic);
    let mean = |settings: &Settings| {
        let reference = Reference::new(&volume, settings, ReferenceOptions::default());
        let picture = reference.picture([16, 16], &reference.attenuations());
        picture.iter().map(|rgba| rgba[0]).sum::<f64>() / 256.0
    };
    let plain = mean(&settings);
    settings.shadows.first_touch = true;
    assert!(mean(&settings) > plain, "first touch");
    settings.shadows.first_touch = false;
    settings.shadows.bias_voxels = 1.0;
    assert!(mean(&settings) > plain, "bias");
    settings.shadows.bias_voxels = 0.0;
    settings.shadows.strength = 0.5;
    let weak = mean(&settings);
    settings.shadows.strength = 0.0;
    let unshadowed = mean(&settings);
    assert!(plain < weak && weak < unshadowed, "{plain} {weak} {unshadowed}");
    settings.shadows.algorithm = ShadowAlgorithm::Off;
    assert!((mean(&settings) - unshadowed).abs() < 1e-12);
}

#[test]
fn coarse_light_volumes_are_blurred_ones() {
    let volume = ball([16; 3], DVec3::ONE);
    let mut settings = scene(LightGeometry::Parallel, [1.0, 0.5, 2.0], Projection::Orthographic);
    let fine = Reference::new(&volume, &settings, ReferenceOptions::default()).attenuation(0);
    settings.shadows.resolution = LightVolumeResolution::Half;
    let coarse = Reference::new(&volume, &settings, ReferenceOptions::default()).attenuation(0);
    assert_eq!(coarse.dims, [8; 3]);
    let mean = |light: &AttenuationVolume| light.values.iter().sum::<f64>() / light.values.len() as f64;
    assert!((mean(&fine) - mean(&coarse)).abs() < 0.02, "{} {}", mean(&fine), mean(&coarse));
    let corner = DVec3::new(12.0, 10.0, 14.0);
    assert!((fine.at(corner) - coarse.at(corner)).abs() < 0.02, "{} {}", fine.at(corner), coarse.at(corner));
}
