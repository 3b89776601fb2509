//! Shadow edges of the paper's three algorithms (P §3.2): they differ in how often a shadow is blurred.

use crate::common::{Dataset, full_precision_renderer, render};
use crate::scenes::{
    self, axis_camera, linear_extinction, make_isotropic, use_earlier_first_look, use_hard_light,
    use_paper_shadows,
};
use crate::thresholds::{
    DIRECT_BEER_LAMBERT, EDGE_CENTRE, EDGE_WIDTH, EDGE_WIDTHS, MIN_COMPARED_LIGHT, SELF_SHADOW,
    SELF_SHADOW_GROWS,
};
use chiaroscuro_render::{Renderer, mean_luminance};
use chiaroscuro_scene::{
    Camera, ControlPoint, LightGeometry, LightingTransfer, OpacityInterpolation, OpacityLength, Projection,
    RenderEngine, Settings, ShadowAlgorithm, TransferFunction, first_look,
};
use chiaroscuro_volume::{Histogram, Samples, Volume};
use glam::DVec3;

fn renderer() -> Renderer {
    full_precision_renderer()
}

/// No. 2 for rays from every sample: an eye inside opaque, homogeneous material looks across the light and sees
/// e^(−μ·depth) and nothing else.
#[test]
fn beer_lambert_by_rays_from_samples() {
    let n = 48;
    let face = 8;
    let loaded =
        Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    let mut renderer = renderer();
    for per_voxel in [0.1, 0.3, 0.7] {
        for z in [12, 20, 31] {
            // The middle of the grid is the origin, and half the grid one unit.
            let height = (f64::from(z) + 0.5) / (n as f64 / 2.0) - 1.0;
            let mut settings = Settings {
                lights: vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 1.0])],
                camera: Camera {
                    target: [0.0, 0.2, height],
                    distance: 0.3,
                    fov_y_deg: 10.0,
                    ..axis_camera(-90.0, 0.0)
                },
                ..Settings::default()
            }
            .with_transfer(linear_extinction(4.0))
            .with_lighting(LightingTransfer {
                linked: false,
                scale: 1.0,
                curve: linear_extinction(per_voxel),
            })
            .with_opacity_unit(OpacityLength::Voxels(1.0));
            settings.camera.projection = Projection::Perspective;
            make_isotropic(&mut settings);
            settings.shadows.algorithm = ShadowAlgorithm::Direct;
            settings.shadows.slab = 0.5;
            let picture = render(&mut renderer, &loaded, &settings, [9, 9]);
            let depth = (n - face) as f64 - 0.5 - f64::from(z);
            let expected = (-per_voxel * depth).exp();
            let found = f64::from(picture.linear[9 * 4 + 4][0]);
            if expected > MIN_COMPARED_LIGHT {
                let error = (found / expected - 1.0).abs();
                assert!(
                    error <= DIRECT_BEER_LAMBERT,
                    "μ {per_voxel}: {found} not {expected} at depth {depth}"
                );
            }
        }
    }
}

/// No. 2 for rays from every sample with a light inside the material, at distances that are no whole number of steps.
#[test]
fn beer_lambert_by_rays_from_samples_to_a_light_inside() {
    let n = 48;
    let loaded = Dataset::new(scenes::block(n, |v| v.iter().all(|c| (4..n - 4).contains(c))));
    let mut renderer = renderer();
    for (per_voxel, distance) in [(0.1, 3.3), (0.3, 3.3), (0.1, 7.8), (0.3, 7.8)] {
        let height = 2.0 * distance / n as f64;
        let mut settings = Settings {
            lights: vec![scenes::light(LightGeometry::Perspective, [0.0, 0.0, height])],
            camera: Camera { distance: 0.3, fov_y_deg: 4.0, ..axis_camera(-90.0, 0.0) },
            ..Settings::default()
        }
        .with_transfer(linear_extinction(40.0))
        .with_lighting(LightingTransfer { linked: false, scale: 1.0, curve: linear_extinction(per_voxel) })
        .with_opacity_unit(OpacityLength::Voxels(1.0));
        settings.camera.projection = Projection::Perspective;
        // The eye sees the material right before it.
        settings.camera.target = [0.0, 0.3, 0.0];
        make_isotropic(&mut settings);
        settings.shadows.algorithm = ShadowAlgorithm::Direct;
        settings.sampling.slab = 0.25;
        let picture = render(&mut renderer, &loaded, &settings, [9, 9]);
        let expected = (-per_voxel * distance).exp();
        let found = f64::from(picture.linear[9 * 4 + 4][0]);
        let error = (found / expected - 1.0).abs();
        assert!(
            error <= DIRECT_BEER_LAMBERT,
            "μ {per_voxel}: {found} not {expected} at {distance} voxels: {error}"
        );
    }
}

/// Profile across a shadow's edge, as optical depth. A half-plane one voxel thick hangs over a receiver that the eye
/// sees from above, through the half-plane, which only light meets.
fn shadow_profile(algorithm: ShadowAlgorithm, engine: RenderEngine) -> Vec<f64> {
    let n = 24;
    let values = (0..n * n * n)
        .map(|at| match (at % n, at / n / n) {
            (_, z) if z < 8 => 255,
            (x, z) if z == 17 && x < n / 2 => 60,
            _ => 0,
        })
        .collect();
    let volume = Volume::with_spacing("edge", [n; 3], DVec3::ONE, Samples::U8(values)).expect("a volume");
    let loaded = Dataset::new(volume);
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let mut settings = Settings {
        lights: vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 1.0])],
        camera: axis_camera(-90.0, 90.0),
        ..Settings::default()
    }
    .with_transfer(TransferFunction {
        points: vec![point(0.0, 0.0), point(120.0, 0.0), point(255.0, 0.9)],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    })
    // Thin: exp is straight enough that interpolating light or optical depth is the same.
    .with_lighting(LightingTransfer { linked: false, scale: 1.0, curve: linear_extinction(0.1) })
    .with_opacity_unit(OpacityLength::Voxels(1.0));
    make_isotropic(&mut settings);
    use_paper_shadows(&mut settings);
    let mut renderer = renderer();
    let size = [480, 8];
    // The picture is as wide as the volume.
    settings.camera.distance = 1.0;
    settings.camera.fov_y_deg = 2.0 * (f64::from(size[1]) / f64::from(size[0])).atan().to_degrees();
    settings.shadows.algorithm = algorithm;
    settings.sampling.engine = engine;
    let picture = render(&mut renderer, &loaded, &settings, size);
    let row = &picture.linear[4 * 480..5 * 480];
    let light = |at: usize| f64::from(row[at][0]);
    // Between four voxels from either end, where the shadow is even: from 1 in it to 0 beside it.
    let (dark, bright) = (light(80), light(400));
    (80..=400).map(|at| (light(at).ln() - bright.ln()) / (dark.ln() - bright.ln())).collect()
}

/// Position at which a falling profile crosses a value, in voxels from the geometric edge; 20 pixels per voxel.
fn crossing_position(profile: &[f64], value: f64) -> f64 {
    let after = profile.iter().position(|&v| v < value).expect("the profile falls below the value");
    let (high, low) = (profile[after - 1], profile[after]);
    let pixel = 80.0 + after as f64 - 1.0 + (high - value) / (high - low);
    // Pixel centres are half a pixel from the picture's edge; the edge is in its middle.
    (pixel + 0.5 - 240.0) / 20.0
}

/// No. 6: Each reconstruction widens the edge of a shadow; the 10–90 % widths are those of one, two and three blurs
/// of a step, and its centre stays in place.
#[test]
fn edges_of_shadows_are_as_wide_as_the_blurs() {
    let gathered = EDGE_WIDTHS.map(|(algorithm, width)| (algorithm, RenderEngine::Gather, width));
    let [.., splatted] = EDGE_WIDTHS;
    for (algorithm, engine, width) in
        gathered.into_iter().chain([(splatted.0, RenderEngine::Scatter, splatted.1)])
    {
        let profile = shadow_profile(algorithm, engine);
        let found = crossing_position(&profile, 0.1) - crossing_position(&profile, 0.9);
        let middle = crossing_position(&profile, 0.5);
        println!(
            "edge by {algorithm:?}, {engine:?}: {found:.3} voxels wide (calculated {width}), middle at {middle:+.3}"
        );
        assert!((found / width - 1.0).abs() <= EDGE_WIDTH, "{algorithm:?}: {found} not {width}");
        assert!(middle.abs() <= EDGE_CENTRE, "{algorithm:?}: the edge moved by {middle}");
    }
}

/// No. 9: On an object with thin and thick parts, splatting is slightly darker than rays from every sample; every
/// remedy for darkness brightens, and the more the stronger it is.
#[test]
fn cures_brighten_and_splatting_is_slightly_darker() {
    let volume = chiaroscuro_volume::synthetic::builtin("chair", Some(48)).expect("the chair");
    let histogram = Histogram::from_volume(&volume);
    let mut settings = first_look::first_settings(&volume, &histogram);
    use_hard_light(&mut settings, &volume);
    use_earlier_first_look(&mut settings);
    use_paper_shadows(&mut settings);
    let loaded = Dataset::new(volume);
    let mut renderer = renderer();
    let mut brightness =
        |settings: &Settings| mean_luminance(&render(&mut renderer, &loaded, settings, [96, 96]).linear);
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    let direct = brightness(&settings);
    settings.shadows.algorithm = ShadowAlgorithm::Splat;
    let splat = brightness(&settings);
    let mut scattered = settings.clone();
    scattered.sampling.engine = RenderEngine::Scatter;
    let scattered = brightness(&scattered);
    let mut touched = settings.clone();
    touched.shadows.first_touch = true;
    let first_touch = brightness(&touched);
    println!(
        "luminance over that by rays: {:.4} splatted, {:.4} first touch",
        splat / direct,
        first_touch / direct
    );
    for splat in [splat, scattered] {
        assert!((SELF_SHADOW.0..=SELF_SHADOW.1).contains(&(splat / direct)), "{splat} {direct}");
    }
    assert!(first_touch / direct >= 1.0, "{first_touch} {direct}");
    type Remedy = fn(&mut Settings, f64);
    let cures: [(&str, Remedy); 3] = [
        ("gain", |settings, amount| settings.shadows.gain = 1.0 + amount),
        ("ambient offset", |settings, amount| settings.shadows.ambient_offset = 0.3 * amount),
        ("bias", |settings, amount| settings.shadows.bias_voxels = 2.0 * amount),
    ];
    for (name, cure) in cures {
        let steps = [0.0, 0.5, 1.0].map(|amount| {
            let mut cured = settings.clone();
            cure(&mut cured, amount);
            brightness(&cured)
        });
        println!("{name}: {steps:.4?}");
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0] * SELF_SHADOW_GROWS), "{name}: {steps:?}");
    }
}
