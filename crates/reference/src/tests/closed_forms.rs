//! Tests against exact results: partition of unity, light through boxes, oblique slabs, thick material.

use super::*;

#[test]
fn gather_weights_are_a_partition_of_unity() {
    let settings = settings(0.1);
    let reference = Reference::new(&box_of([24; 3]), &settings, ReferenceOptions::default());
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / (1u64 << 24) as f64
    };
    for _ in 0..1000 {
        let point = DVec3::new(random(), random(), random()) * 7.0 + 9.0;
        for kernel in KERNELS {
            for level in [0.0, 0.4, 1.0] {
                let density = reference.density(kernel, point, level);
                assert!((density - 1.0).abs() < 1e-9, "{kernel:?} at {point}, level {level}: {density}");
            }
        }
    }
}

#[test]
fn footprints_sum_to_one_even_where_they_are_stretched() {
    for (fov_y_deg, stretched) in [(4.0, false), (60.0, true)] {
        let mut settings = settings(0.1);
        settings.camera = Camera { distance: 8.0, fov_y_deg, ..settings.camera };
        let reference = Reference::new(
            &box_of([20; 3]),
            &settings,
            options(ReferenceWeights::Footprint, ReferenceFault::None),
        );
        let frame = reference.eye_frame([40, 40]);
        let k = frame.slab_count / 2;
        let stretch = frame.stretch_level(frame.depth_of(f64::from(k)));
        assert_eq!(stretch > 1.0, stretched, "stretch level {stretch}");
        let sheet = reference.eye_sheet([40, 40], k);
        let middle = sheet[20 + 40 * 20];
        assert!((middle - 1.0).abs() < 2e-4, "{middle} at stretch {stretch}");
    }
}

/// Tests that behind the lit face z₀ of a box, back-projected light is exp(−μ(z₀ − z)) · exp(μ²σ²/2) ·
/// sinhc(μΔs/2)^p, with p = 1 for points and 2 for integrated slabs.
#[test]
fn light_in_a_box_follows_beer_and_lambert() {
    for (weights, dims, power) in
        [(ReferenceWeights::Gather, [48; 3], 1), (ReferenceWeights::Footprint, [14, 14, 26], 2)]
    {
        for (mu, tolerance) in [(0.1, 0.005), (0.3, 0.005), (0.7, 0.02)] {
            let settings = settings(mu);
            let reference = Reference::new(&box_of(dims), &settings, options(weights, ReferenceFault::None));
            let light = reference.attenuation(0);
            let face = dims[2] as f64 - 0.5;
            let sinhc = (mu / 2.0).sinh() / (mu / 2.0);
            for z in [4, dims[2] / 2, dims[2] - 6] {
                let found = light.values[dims[0] / 2 + dims[0] * (dims[1] / 2 + dims[1] * z)];
                let right = (-mu * (face - z as f64)).exp() * (mu * mu / 6.0).exp() * sinhc.powi(power);
                assert!(
                    (found / right - 1.0).abs() < tolerance,
                    "{weights:?} μ = {mu}, z = {z}: {found} {right}"
                );
            }
        }
    }
}

/// Tests that attenuation follows the chord for oblique rays, whose slabs are longer.
#[test]
fn oblique_light_follows_its_chord() {
    let n = 24;
    let mut settings = settings(0.05);
    settings.lights[0].kind = LightGeometry::Perspective;
    let reference = Reference::new(&box_of([n; 3]), &settings, ReferenceOptions::default());
    let light = reference.attenuation(0);
    let scene = box_of([n; 3]).scene();
    for [x, y, z] in [[12, 12, 6], [4, 5, 6], [19, 4, 8]] {
        let place = scene.scene_from_index.transform_point3(DVec3::new(x as f64, y as f64, z as f64));
        let to_light = DVec3::new(0.0, 0.0, 4.0) - place;
        // The box ends at z = 1 in scene space.
        let chord = (1.0 - place.z) / to_light.z * to_light.length() / scene.smallest_edge();
        let (found, right) = (light.values[x + n * (y + n * z)], (-0.05 * chord).exp());
        assert!((found / right - 1.0).abs() < 0.01, "at {x} {y} {z}: {found} {right}");
    }
}

/// Renders thick material seen along the light, which shows ½.
fn headlight(slab: f64, deposit: DepositMode, fault: ReferenceFault) -> f64 {
    let mut settings = settings(0.7);
    settings.camera = Camera {
        projection: Projection::Orthographic,
        elevation_deg: 90.0,
        fov_y_deg: 0.5,
        ..settings.camera
    };
    settings.sampling.slab = slab;
    settings.shadows.slab = slab;
    settings.shadows.deposit = deposit;
    settings.shading.ambient = 0.0;
    settings.shading.diffuse = 1.0;
    settings.shading.surface_gradient = 1e9;
    // Air in front of the face, as the light volume ends with the grid.
    let thick = volume([12, 12, 32], |p| if p.z < 28.0 { 1.0 } else { 0.0 });
    let reference = Reference::new(&thick, &settings, options(ReferenceWeights::Gather, fault));
    reference.picture([1, 1], &reference.attenuations())[0][0]
}

#[test]
fn a_headlight_shows_one_half_between_front_and_after() {
    let mean = |slab| headlight(slab, DepositMode::SlabMean, ReferenceFault::None);
    let front = |slab| headlight(slab, DepositMode::Front, ReferenceFault::None);
    let after = |slab| headlight(slab, DepositMode::Front, ReferenceFault::DepositAfter);
    assert!((mean(1.0) - 0.5).abs() < 0.05, "{}", mean(1.0));
    assert!((mean(0.25) - 0.5).abs() < 0.01, "{}", mean(0.25));
    for slab in [1.0, 0.25] {
        assert!(after(slab) < mean(slab) && mean(slab) < front(slab), "at Δs = {slab}");
    }
    assert!(front(1.0) > 0.55 && after(1.0) < 0.45, "{} {}", front(1.0), after(1.0));
}

#[test]
fn a_light_inside_lights_everything_around_it() {
    let mut settings = settings(0.2);
    settings.lights[0] = LightSettings {
        kind: LightGeometry::Perspective,
        position: [0.1, 0.05, 0.0],
        ..LightSettings::default()
    };
    let reference = Reference::new(&box_of([16; 3]), &settings, ReferenceOptions::default());
    assert_eq!(reference.light_sheets(0).len(), 6);
    let light = reference.attenuation(0);
    let scene = box_of([16; 3]).scene();
    for (at, value) in [[13, 8, 8], [8, 3, 8], [8, 8, 12], [3, 4, 11]]
        .map(|at: [usize; 3]| (at, light.values[at[0] + 16 * (at[1] + 16 * at[2])]))
    {
        let place = scene.scene_from_index.transform_point3(DVec3::from(at.map(|c| c as f64)));
        let right = (-0.2 * place.distance(DVec3::new(0.1, 0.05, 0.0)) / scene.smallest_edge()).exp();
        assert!((value / right - 1.0).abs() < 0.04, "{at:?}: {value} {right}");
    }
}
