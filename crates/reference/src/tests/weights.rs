//! Tests of gather against footprints, and of both against faulty versions of themselves.

use super::*;

/// Returns the red channel of a picture.
fn render(volume: &Volume, settings: &Settings, options: ReferenceOptions) -> Vec<f64> {
    let reference = Reference::new(volume, settings, options);
    let picture = reference.picture([20, 20], &reference.attenuations());
    picture.into_iter().map(|rgba| rgba[0]).collect()
}

/// Returns the differences of light and picture between gathering and footprints. Both pictures are lit by the same
/// light.
fn gap(volume: &Volume, settings: &Settings) -> [f64; 2] {
    let footprint =
        Reference::new(volume, settings, options(ReferenceWeights::Footprint, ReferenceFault::None));
    let gather = Reference::new(volume, settings, ReferenceOptions::default());
    let lights = [footprint.attenuation(0), gather.attenuation(0)];
    let light = difference(&lights[0].values, &lights[1].values);
    let lights = lights.map(Some);
    let red = |reference: &Reference<'_>| {
        reference.picture([20, 20], &lights[..1]).into_iter().map(|rgba| rgba[0]).collect::<Vec<_>>()
    };
    [light, difference(&red(&footprint), &red(&gather))]
}

fn with_two_points(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.quadrature = SlabQuadrature::Two;
    settings
}

#[test]
fn gather_and_footprints_are_the_same_sums_but_for_the_quadrature() {
    for (kind, position, projection) in [
        (LightGeometry::Parallel, [1.0, 0.5, 2.0], Projection::Orthographic),
        (LightGeometry::Perspective, [2.0, -3.0, 2.5], Projection::Perspective),
    ] {
        for kernel in KERNELS {
            let mut settings = scene(kind, position, projection);
            // Pixels narrower than voxels: no stretch.
            settings.camera.fov_y_deg = 20.0;
            settings.sampling.kernel = kernel;
            settings.shadows.kernel = kernel;
            let volume = ball([14; 3], DVec3::ONE);
            let [light, picture] = gap(&volume, &settings);
            let [_, closer] = gap(&volume, &with_two_points(&settings));
            assert!(light < 6e-3, "{kind:?} {kernel:?}: light {light}");
            assert!(
                picture < 2e-3 && closer < 0.7 * picture,
                "{kind:?} {kernel:?}: {picture}, two points {closer}"
            );
        }
    }
}

#[test]
fn footprints_are_sheared_where_voxels_are_not_cubes() {
    let mut settings = scene(LightGeometry::Parallel, [1.0, 0.5, 2.0], Projection::Perspective);
    settings.camera.fov_y_deg = 20.0;
    let volume = ball([14, 14, 9], DVec3::new(1.0, 1.0, 1.6));
    let [light, picture] = gap(&volume, &settings);
    let [_, closer] = gap(&volume, &with_two_points(&settings));
    assert!(picture < 2e-3 && closer < 0.7 * picture, "{picture}, two points {closer}");
    // The gathered reverse kernel is round in scene space, the paper's in index space.
    assert!(light < 0.01, "{light}");
}

#[test]
fn stretched_kernels_and_coarse_light_are_nearly_the_same() {
    let volume = ball([14; 3], DVec3::ONE);
    let mut settings = scene(LightGeometry::Parallel, [1.0, 0.5, 2.0], Projection::Perspective);
    settings.camera.fov_y_deg = 75.0;
    settings.shadows.resolution = LightVolumeResolution::Half;
    let reference = Reference::new(&volume, &settings, ReferenceOptions::default());
    assert!(reference.eye_frame([20, 20]).max_stretch_level() > 1.0);
    // The pyramid's kernel is trilinear, and between levels a blend of two.
    let [light, picture] = gap(&volume, &settings);
    assert!(light < 6e-3 && picture < 4e-3, "light {light}, picture {picture}");
}

#[test]
fn every_fault_shows_in_the_picture() {
    let volume = ball([14; 3], DVec3::ONE);
    let mut settings = scene(LightGeometry::Perspective, [1.5, -2.5, 2.5], Projection::Perspective);
    settings.camera.distance = 3.0;
    settings.shadows.slab = 0.5;
    for weights in [ReferenceWeights::Gather, ReferenceWeights::Footprint] {
        let right = render(&volume, &settings, options(weights, ReferenceFault::None));
        let again = render(&volume, &settings, options(weights, ReferenceFault::None));
        assert_eq!(right, again, "the same input gives the same bits");
        for fault in [
            ReferenceFault::WiderKernel,
            ReferenceFault::DepositAfter,
            ReferenceFault::NoDivision,
            ReferenceFault::NoObliquity,
            ReferenceFault::FlippedNormal,
            ReferenceFault::ShiftedKernel,
        ] {
            let wrong = render(&volume, &settings, options(weights, fault));
            let difference = difference(&wrong, &right);
            // The GPU may differ by 0.25/255.
            assert!(difference > 0.3 / 255.0, "{weights:?} {fault:?}: {difference}");
        }
    }
}
