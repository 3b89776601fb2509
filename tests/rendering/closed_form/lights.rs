//! Lights and shadows in closed form: a headlight, the shadow of a ball, a distant light, and a spotlight.

use chiaroscuro_render::RenderedPicture;
use chiaroscuro_scene::{
    DepositMode, LightGeometry, RenderEngine, ReverseKernel, ShadowAlgorithm, Spotlight,
};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, full_attenuation, render};
use crate::compare::{ErrorLimit, compare, to_f64};
use crate::scenes;
use crate::thresholds::{
    BALL_SHADOW, FAR_LIGHT, HEADLIGHT_COARSE, HEADLIGHT_FINE, HEADLIGHT_ORDER, LIGHT_ALONG_A_FACE,
    SPOTLIGHT_RIM_DEG,
};

with_both_engines! {
    headlight_gives_one_half
    shadow_of_a_ball
    a_far_point_light_is_parallel
    a_spotlight_is_a_cone_with_a_soft_rim
}

fn center_red(picture: &RenderedPicture) -> f64 {
    let [w, h] = picture.size.map(|n| n as usize);
    f64::from(picture.linear[h / 2 * w + w / 2][0])
}

fn headlight_brightness(engine: RenderEngine, deposit: DepositMode, slab: f64) -> f64 {
    let n = 40;
    let loaded = Dataset::new(scenes::block(n, |[x, y, z]| {
        (6..26).contains(&y) && x > 2 && z > 2 && x < 37 && z < 37
    }));
    // From −y, like the eye of `straight(-90, 0)`.
    let mut settings = base(engine, 0.7);
    settings.lights[0].position = [0.0, -1.0, 0.0];
    settings.shadows.deposit = deposit;
    settings.shadows.slab = slab;
    settings.sampling.slab = slab;
    center_red(&render(&mut renderer(), &loaded, &settings, [48, 48]))
}

/// No. 4: Light from the eye's direction, isotropic material, optically thick: C = ∫ T·T dτ = ½, whatever the
/// density.
fn headlight_gives_one_half(engine: RenderEngine) {
    let errors = |deposit| [1.0, 0.5, 0.25].map(|slab| headlight_brightness(engine, deposit, slab) - 0.5);
    let mean = errors(DepositMode::SlabMean);
    let front = errors(DepositMode::Front);
    println!("headlight: slab mean {mean:.4?}, front {front:.4?}");
    assert!(mean[2].abs() <= 0.5 * HEADLIGHT_FINE, "slab mean: {mean:?}");
    assert!(mean[0].abs() <= 0.5 * HEADLIGHT_COARSE, "slab mean: {mean:?}");
    assert!(
        front.iter().all(|&error| error > 0.0),
        "in front of the slab there is always more light: {front:?}"
    );
    assert!(front[0] > mean[0], "the literal deposit is brighter");
    // First order: halving the slab halves the error.
    assert!(
        front[0] / front[1] > HEADLIGHT_ORDER.0 && front[1] / front[2] > HEADLIGHT_ORDER.1,
        "front: {front:?}"
    );
}

/// No. 5: Behind a ball of radius r the light is e^(−2μ√(r² − b²)) at distance b from its axis.
fn shadow_of_a_ball(engine: RenderEngine) {
    let n = 60;
    let radius = 10.0;
    let centre = DVec3::new(29.5, 29.5, 40.0);
    let loaded = Dataset::new(scenes::ball(n, centre, radius));
    let per_voxel = 0.1;
    let settings = base(engine, per_voxel);
    let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
    let plane = 15;
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    for (x, y) in (4..n - 4).flat_map(|x| (4..n - 4).map(move |y| (x, y))) {
        let b = glam::DVec2::new(x as f64 - centre.x, y as f64 - centre.y).length();
        if (b - radius).abs() > 3.0 {
            found.push(f64::from(volume[x + n * (y + n * plane)]));
            expected.push((-2.0 * per_voxel * (radius * radius - b * b).max(0.0).sqrt()).exp());
        }
    }
    let limit = ErrorLimit { max: f64::INFINITY, rmse: BALL_SHADOW };
    compare("shadow of a ball", &found, &expected, limit).unwrap_or_else(|err| panic!("{err}"));
    let middle = f64::from(volume[29 + n * (29 + n * plane)]);
    let b2 = 0.5;
    let exact = (-2.0 * per_voxel * (radius * radius - b2).sqrt()).exp();
    assert!((middle - exact).abs() <= BALL_SHADOW, "{middle} not {exact}");
}

/// No. 15: A point light at a distance of a hundred volumes is a parallel light.
fn a_far_point_light_is_parallel(engine: RenderEngine) {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = scenes::look();
    settings.sampling.engine = engine;
    let direction = DVec3::new(0.5, -0.6, 0.8).normalize_or_zero();
    let mut volume = |kind| {
        settings.lights = vec![scenes::light(kind, (direction * 200.0).into())];
        to_f64(&full_attenuation(&mut renderer(), &loaded, &settings, 0))
    };
    let (near, far) = (volume(LightGeometry::Parallel), volume(LightGeometry::Perspective));
    let limit = ErrorLimit { max: f64::INFINITY, rmse: FAR_LIGHT };
    compare("far light", &far, &near, limit).unwrap_or_else(|err| panic!("{err}"));
}

/// No. 15: A spotlight is dark outside its cone, full inside, and falls off smoothly at the rim.
fn a_spotlight_is_a_cone_with_a_soft_rim(engine: RenderEngine) {
    let n = 40;
    // One voxel, so that the volume is not empty; the light passes the rest unattenuated.
    let loaded = Dataset::new(scenes::block(n, |voxel| voxel == [0; 3]));
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast] {
        let mut settings = base(engine, 1.0);
        settings.shadows.algorithm = algorithm;
        settings.lights = vec![scenes::light(LightGeometry::Perspective, [0.0, 0.0, 4.0])];
        settings.lights[0].hood = Spotlight { on: true, half_angle_deg: 11.0, rim_deg: 4.0 };
        let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        // The middle plane, from the axis outwards: 4 scene units from the light, a voxel is 2/n wide.
        let middle = n / 2;
        let row: Vec<(f64, f32)> = (middle..n)
            .map(|x| {
                let away = (x as f64 - (n as f64 - 1.0) / 2.0) * 2.0 / n as f64;
                let z = 4.0 - (middle as f64 - (n as f64 - 1.0) / 2.0) * 2.0 / n as f64;
                ((away / z).atan().to_degrees(), volume[x + n * (middle + n * middle)])
            })
            .collect();
        for (angle_deg, arriving) in &row {
            match angle_deg {
                angle if *angle > 11.0 + SPOTLIGHT_RIM_DEG => {
                    assert_eq!(*arriving, 0.0, "{algorithm:?}, {angle}°");
                }
                angle if *angle < 7.0 - SPOTLIGHT_RIM_DEG => {
                    assert_eq!(*arriving, 1.0, "{algorithm:?}, {angle}°");
                }
                _ => {}
            }
        }
        assert!(row.windows(2).all(|pair| pair[1].1 <= pair[0].1), "{algorithm:?}: {row:?}");
        let grey = row.iter().filter(|(_, arriving)| (0.02..0.98).contains(arriving)).count();
        assert!(grey >= 4, "{algorithm:?}: a rim of 4° is {grey} voxels wide: {row:?}");
        assert!(row.last().is_some_and(|(angle, _)| *angle > 13.0), "the row reaches beyond the rim");
    }
}

/// Light along rows of voxels beside a flat face: dark rows lie beside lit ones, without bleeding. A row attenuates
/// light by its own reconstructed density, whether a voxel or a face of two lies in the middle.
#[test]
fn light_along_a_face_stays_in_its_rows() {
    for n in [40, 41] {
        let face = 12;
        let loaded = Dataset::new(scenes::block(n, |[_, _, z]| z >= face && z < n - face));
        let mut settings = base(RenderEngine::Gather, 0.3);
        settings.shadows.reverse_kernel = ReverseKernel::Tent;
        settings.lights[0].position = [1.0, 0.0, 0.0];
        let mut rays = settings.clone();
        rays.shadows.algorithm = ShadowAlgorithm::Raycast;
        let [found, expected] =
            [settings, rays].map(|settings| full_attenuation(&mut renderer(), &loaded, &settings, 0));
        let (mut worst, mut darkest) = (0.0_f32, 1.0_f32);
        for z in 0..n {
            for x in 4..n - 4 {
                let at = x + n * (n / 2 + n * z);
                worst = worst.max((found[at] - expected[at]).abs());
                darkest = darkest.min(expected[at]);
            }
        }
        println!("light along a face, {n}³: off by up to {worst:.4}");
        assert!(darkest < 0.01, "there is a shadow: {darkest}");
        assert!(f64::from(worst) <= LIGHT_ALONG_A_FACE, "{n}³: off by {worst}");
    }
}
