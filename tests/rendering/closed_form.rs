//! Scenes whose answer is known in closed form, on the GPU path.

use crate::common::{Loaded, attenuation, context, render};
use crate::compare::{Limit, compare, difference, wide};
use crate::scenes::{self, isotropic, linear_extinction, straight};
use crate::thresholds::{
    BALL_SHADOW, BEER_LAMBERT, CHORD_OPACITY, FAR_LIGHT, HEADLIGHT_COARSE, HEADLIGHT_FINE, OBLIQUE_CHORD,
    ORDER_FRONT, ORDER_MEAN, RAY_BEER_LAMBERT, ROTATION_RANGE, ROTATION_STEP, SLAB_MEAN_CHANGE, UNITY,
};
use chiaroscuro::gpu::{Picture, Renderer, mean_luminance};
use chiaroscuro::model::{
    Camera, Deposit, Engine, Hood, Length, LightKind, Quadrature, Settings, ShadowAlgorithm,
};
use glam::DVec3;

/// Variance of the cubic B-spline, in voxels².
const KERNEL_VARIANCE: f64 = 1.0 / 3.0;

fn renderer() -> Renderer {
    Renderer::new(&context().with_full_precision()).expect("a renderer")
}

fn base(engine: Engine, per_voxel: f64) -> Settings {
    let mut settings = Settings {
        transfer: linear_extinction(per_voxel),
        opacity_unit: Length::Voxels(1.0),
        lights: vec![scenes::light(LightKind::Parallel, [0.0, 0.0, 1.0])],
        camera: straight(-90.0, 0.0),
        ..Settings::default()
    };
    isotropic(&mut settings);
    settings.sampling.engine = engine;
    settings
}

/// Makes a test of each check, for each of the engines.
macro_rules! with_both_engines {
    ($($check:ident)+) => {
        mod gathered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro::model::Engine::Gather);
            })+
        }
        mod scattered {
            $(#[test]
            fn $check() {
                super::$check(chiaroscuro::model::Engine::Scatter);
            })+
        }
    };
}

with_both_engines! {
    kernels_are_a_partition_of_unity
    beer_lambert_in_a_homogeneous_block
    opacity_of_a_chord
    headlight_gives_one_half
    shadow_of_a_ball
    turning_does_not_change_brightness
    thinner_slabs_converge
    a_far_point_light_is_parallel
    a_hood_is_a_cone_with_a_soft_rim
    oblique_rays_have_longer_paths
    extremes_stay_finite
}

/// Mean of the picture's alpha over its middle.
fn middle_alpha(picture: &Picture) -> f64 {
    let [w, h] = picture.size.map(|n| n as usize);
    let texels: Vec<f64> = (h / 2 - 2..h / 2 + 2)
        .flat_map(|y| (w / 2 - 2..w / 2 + 2).map(move |x| y * w + x))
        .map(|at| f64::from(picture.light[at][3]))
        .collect();
    texels.iter().sum::<f64>() / texels.len() as f64
}

fn middle_red(picture: &Picture) -> f64 {
    let [w, h] = picture.size.map(|n| n as usize);
    f64::from(picture.light[h / 2 * w + w / 2][0])
}

/// No. 1: A constant stays constant under the kernel, wherever it is sampled: the ratio of successive
/// sheets of a light gives the density back.
fn kernels_are_a_partition_of_unity(engine: Engine) {
    let per_slab = 1.0;
    let n = 32;
    let loaded = Loaded::new(scenes::block(n, |v| v != [0, 0, 0]));
    for light in [[0.31, -0.62, 0.77], [-0.9, 0.2, 0.13]] {
        let mut settings = base(engine, per_slab);
        settings.lights[0].position = light;
        // Sheets that deposit what arrives: successive ratios are e^−τ of one slab.
        settings.shadows.deposit = Deposit::Front;
        let sheets =
            renderer().light_sheets(&loaded.volume, &loaded.bricks, &settings, 0, 0).expect("sheets");
        let view =
            &chiaroscuro::plan::light_views(&settings.lights[0], &settings.shadows, &loaded.volume.scene())
                [0];
        let [w, h] = view.frame.size;
        let mut checked = 0;
        for k in 0..view.frame.slab_count - 1 {
            for (i, j) in (0..w).flat_map(|i| (0..h).map(move |j| (i, j))) {
                let p = view.frame.point(f64::from(i), f64::from(j), view.frame.depth_of(f64::from(k)));
                // Three voxels away from the faces, and from the one empty voxel.
                let inside = p.min_element() > 3.0 && p.max_element() < n as f64 - 4.0;
                let at = |k: u32| f64::from(sheets[(i + w * (j + h * k)) as usize]);
                if inside && at(k) > 1e-3 {
                    let density = -(at(k + 1) / at(k)).ln() / per_slab;
                    assert!((density - 1.0).abs() <= UNITY, "{density} at {p}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 200, "only {checked} samples were checked");
    }
}

/// No. 2: Light falls off exponentially in homogeneous material, times what the kernel does to an
/// exponential: e^(μ²σ²/2) from the reverse splat, sinh(μΔs/2)/(μΔs/2) from the slab.
fn beer_lambert_in_a_homogeneous_block(engine: Engine) {
    let n = 48;
    let face = 8;
    let loaded =
        Loaded::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    for (per_voxel, slab, tolerance) in BEER_LAMBERT {
        for (quadrature, power) in [(Quadrature::One, 1), (Quadrature::Two, 2)] {
            let mut settings = base(engine, per_voxel);
            settings.shadows.slab = slab;
            settings.shadows.quadrature = quadrature;
            let volume = attenuation(&mut renderer(), &loaded, &settings, 0);
            let half = per_voxel * slab / 2.0;
            let factor =
                (per_voxel * per_voxel * KERNEL_VARIANCE / 2.0).exp() * (half.sinh() / half).powi(power);
            for z in face + 3..n - face - 3 {
                // Light comes from +z; the block's upper face is at z = n − face − ½.
                let depth = (n - face) as f64 - 0.5 - z as f64;
                let expected = (-per_voxel * depth).exp() * factor;
                let found = f64::from(volume[n / 2 + n * (n / 2 + n * z)]);
                if expected > 1e-3 {
                    let error = (found / expected - 1.0).abs();
                    assert!(
                        error <= tolerance,
                        "μ {per_voxel}, Δs {slab}, {quadrature:?}: {found} not {expected} at depth {depth}"
                    );
                }
            }
        }
    }
}

/// No. 2, for rays from the voxels: nothing is blurred on the way back, so light falls as e^(−μ·depth)
/// and no faster. Sampled twice per voxel, where the midpoint rule meets the faces exactly.
#[test]
fn beer_lambert_by_rays() {
    let n = 48;
    let face = 8;
    let loaded =
        Loaded::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    for per_voxel in [0.1, 0.3, 0.7] {
        let mut settings = base(Engine::Gather, per_voxel);
        settings.shadows.algorithm = ShadowAlgorithm::Raycast;
        settings.shadows.slab = 0.5;
        let volume = attenuation(&mut renderer(), &loaded, &settings, 0);
        for z in face + 3..n - face - 3 {
            let depth = (n - face) as f64 - 0.5 - z as f64;
            let expected = (-per_voxel * depth).exp();
            let found = f64::from(volume[n / 2 + n * (n / 2 + n * z)]);
            // Rays end at 1/4096 of the light.
            if expected > 1e-3 {
                let error = (found / expected - 1.0).abs();
                assert!(error <= RAY_BEER_LAMBERT, "μ {per_voxel}: {found} not {expected} at depth {depth}");
            }
        }
    }
}

/// No. 3: What a ray sees of homogeneous material is 1 − e^(−μ·chord), whatever the slab.
fn opacity_of_a_chord(engine: Engine) {
    let n = 48;
    let block = Loaded::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (12..36).contains(c))));
    let ball = Loaded::new(scenes::ball(n, DVec3::splat(23.5), 14.0));
    for (name, loaded, chord) in [("block", &block, 24.0f64), ("ball", &ball, 28.0)] {
        let mut means = Vec::new();
        for (slab, quadrature) in
            [(0.25, Quadrature::One), (0.5, Quadrature::One), (1.0, Quadrature::One), (2.0, Quadrature::Two)]
        {
            let mut settings = base(engine, 0.05);
            settings.sampling.slab = slab;
            settings.sampling.quadrature = quadrature;
            let picture = render(&mut renderer(), loaded, &settings, [96, 96]);
            let expected = 1.0 - (-0.05 * chord).exp();
            let found = if name == "ball" {
                f64::from(picture.light[48 * 96 + 48][3])
            } else {
                middle_alpha(&picture)
            };
            // Half a pixel off the middle shortens the ball's chord by less than 0.1 %.
            assert!((found - expected).abs() <= CHORD_OPACITY, "{name}, Δs {slab}: {found} not {expected}");
            means.push(picture.light.iter().map(|texel| f64::from(texel[3])).sum::<f64>());
        }
        assert!((means[2] / means[0] - 1.0).abs() <= SLAB_MEAN_CHANGE, "{name}: {means:?}");
    }
}

fn headlight(engine: Engine, deposit: Deposit, slab: f64) -> f64 {
    let n = 40;
    let loaded =
        Loaded::new(scenes::block(n, |[x, y, z]| (6..26).contains(&y) && x > 2 && z > 2 && x < 37 && z < 37));
    // From −y, as the eye of `straight(-90, 0)`.
    let mut settings = base(engine, 0.7);
    settings.lights[0].position = [0.0, -1.0, 0.0];
    settings.shadows.deposit = deposit;
    settings.shadows.slab = slab;
    settings.sampling.slab = slab;
    middle_red(&render(&mut renderer(), &loaded, &settings, [48, 48]))
}

/// No. 4: Light from the eye's direction, material that scatters evenly, optically thick:
/// C = ∫ T·T dτ = ½, whatever the density.
fn headlight_gives_one_half(engine: Engine) {
    let errors = |deposit| [1.0, 0.5, 0.25].map(|slab| headlight(engine, deposit, slab) - 0.5);
    let mean = errors(Deposit::SlabMean);
    let front = errors(Deposit::Front);
    println!("headlight: slab mean {mean:.4?}, front {front:.4?}");
    assert!(mean[2].abs() <= 0.5 * HEADLIGHT_FINE, "slab mean: {mean:?}");
    assert!(mean[0].abs() <= 0.5 * HEADLIGHT_COARSE, "slab mean: {mean:?}");
    assert!(
        front.iter().all(|&error| error > 0.0),
        "in front of the slab there is always more light: {front:?}"
    );
    assert!(front[0] > mean[0], "the literal deposit is brighter");
    // First order: halving the slab halves the error.
    assert!(front[0] / front[1] > 1.6 && front[1] / front[2] > 1.4, "front: {front:?}");
}

/// No. 5: Behind a ball of radius r the light is e^(−2μ√(r² − b²)) at distance b from its axis.
fn shadow_of_a_ball(engine: Engine) {
    let n = 60;
    let radius = 10.0;
    let centre = DVec3::new(29.5, 29.5, 40.0);
    let loaded = Loaded::new(scenes::ball(n, centre, radius));
    let per_voxel = 0.1;
    let settings = base(engine, per_voxel);
    let volume = attenuation(&mut renderer(), &loaded, &settings, 0);
    let plane = 15;
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    for (x, y) in (4..n - 4).flat_map(|x| (4..n - 4).map(move |y| (x, y))) {
        let b = (x as f64 - centre.x).hypot(y as f64 - centre.y);
        if (b - radius).abs() > 3.0 {
            found.push(f64::from(volume[x + n * (y + n * plane)]));
            expected.push((-2.0 * per_voxel * (radius * radius - b * b).max(0.0).sqrt()).exp());
        }
    }
    let limit = Limit { max: f64::INFINITY, rmse: BALL_SHADOW };
    compare("shadow of a ball", &found, &expected, limit).unwrap_or_else(|err| panic!("{err}"));
    let middle = f64::from(volume[29 + n * (29 + n * plane)]);
    let b2 = 0.5;
    let exact = (-2.0 * per_voxel * (radius * radius - b2).sqrt()).exp();
    assert!((middle - exact).abs() <= BALL_SHADOW, "{middle} not {exact}");
}

/// No. 7: A ball looks the same from everywhere: no popping while the camera or the light turns.
fn turning_does_not_change_brightness(engine: Engine) {
    let loaded = Loaded::new(scenes::ball(32, DVec3::splat(15.5), 11.0));
    let mut settings = base(engine, 0.25);
    settings.shading.ambient = 1.0;
    settings.lights.clear();
    let mut renderer = renderer();
    let mut by_camera = Vec::new();
    for degree in 0..=90 {
        settings.camera = straight(f64::from(degree), 30.0);
        let picture = render(&mut renderer, &loaded, &settings, [64, 64]);
        by_camera.push(picture.light.iter().map(|texel| f64::from(texel[1])).sum::<f64>() / 4096.0);
    }
    steady("camera", &by_camera);
    let mut by_light = Vec::new();
    for degree in (0..=90).step_by(3) {
        let angle = f64::from(degree).to_radians();
        settings.lights = vec![scenes::light(LightKind::Parallel, [angle.cos(), angle.sin(), 0.6])];
        let volume = attenuation(&mut renderer, &loaded, &settings, 0);
        // Within the ball: the mean over the grid would see how far the shadow runs inside it.
        let inside: Vec<f64> = (0..volume.len())
            .filter(|at| {
                let p = DVec3::new((at % 32) as f64, (at / 32 % 32) as f64, (at / 1024) as f64);
                p.distance(DVec3::splat(15.5)) < 11.0
            })
            .map(|at| f64::from(volume[at]))
            .collect();
        by_light.push(inside.iter().sum::<f64>() / inside.len() as f64);
    }
    let mean = by_light.iter().sum::<f64>() / by_light.len() as f64;
    let range = spread(&by_light) / mean;
    println!("turning the light: range {range:.5}");
    assert!(range <= ROTATION_RANGE, "turning the light changes the light volume by {range}");
}

fn spread(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
}

fn steady(what: &str, means: &[f64]) {
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let range = spread(means) / mean;
    let step = means.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max) / mean;
    println!("turning the {what}: range {range:.5}, largest step {step:.5}");
    assert!(range <= ROTATION_RANGE && step <= ROTATION_STEP, "{what}: range {range}, step {step}");
}

/// No. 8: Thinner light slabs converge: first order with the literal deposit, second with the mean.
fn thinner_slabs_converge(engine: Engine) {
    let loaded = Loaded::new(scenes::ball(40, DVec3::splat(19.5), 13.0));
    for (deposit, order) in [(Deposit::Front, ORDER_FRONT), (Deposit::SlabMean, ORDER_MEAN)] {
        let volume = |slab: f64| {
            let mut settings = base(engine, 0.3);
            // Along the grid: what is left is the slabs' error alone.
            settings.lights[0].position = [0.0, 0.0, 1.0];
            settings.shadows.deposit = deposit;
            settings.shadows.slab = slab;
            settings.shadows.quadrature = Quadrature::Two;
            wide(&attenuation(&mut renderer(), &loaded, &settings, 0))
        };
        let coarse = difference(&volume(2.0), &volume(0.5)).rmse;
        let fine = difference(&volume(1.0), &volume(0.25)).rmse;
        println!("{deposit:?}: {coarse:.2e} → {fine:.2e}, ratio {:.2}", coarse / fine);
        assert!(coarse / fine >= order, "{deposit:?}: {coarse} → {fine}");
    }
}

/// No. 15: A point light a hundred volumes away is a parallel light.
fn a_far_point_light_is_parallel(engine: Engine) {
    let loaded = Loaded::new(scenes::creature(32, DVec3::ONE));
    let mut settings = scenes::look();
    settings.sampling.engine = engine;
    let direction = DVec3::new(0.5, -0.6, 0.8).normalize_or_zero();
    let mut volume = |kind| {
        settings.lights = vec![scenes::light(kind, (direction * 200.0).into())];
        wide(&attenuation(&mut renderer(), &loaded, &settings, 0))
    };
    let (near, far) = (volume(LightKind::Parallel), volume(LightKind::Perspective));
    let limit = Limit { max: f64::INFINITY, rmse: FAR_LIGHT };
    compare("far light", &far, &near, limit).unwrap_or_else(|err| panic!("{err}"));
}

/// No. 15: A hood lets nothing out beyond its rim, everything within, and fades smoothly between.
fn a_hood_is_a_cone_with_a_soft_rim(engine: Engine) {
    let n = 40;
    // One voxel, that the volume is not empty; the light passes the rest unhindered.
    let loaded = Loaded::new(scenes::block(n, |voxel| voxel == [0; 3]));
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast] {
        let mut settings = base(engine, 1.0);
        settings.shadows.algorithm = algorithm;
        settings.lights = vec![scenes::light(LightKind::Perspective, [0.0, 0.0, 4.0])];
        settings.lights[0].hood = Hood { on: true, half_angle_deg: 11.0, rim_deg: 4.0 };
        let volume = attenuation(&mut renderer(), &loaded, &settings, 0);
        // The middle plane, from the axis outwards: 4 scene units from the light, a voxel is 2/n wide.
        let middle = n / 2;
        let row: Vec<(f64, f32)> = (middle..n)
            .map(|x| {
                let away = (x as f64 - (n as f64 - 1.0) / 2.0) * 2.0 / n as f64;
                let z = 4.0 - (middle as f64 - (n as f64 - 1.0) / 2.0) * 2.0 / n as f64;
                ((away / z).atan().to_degrees(), volume[x + n * (middle + n * middle)])
            })
            .collect();
        // Two and a half voxels, the reverse kernel's reach and half a pixel, are 1.8° from here.
        for (angle_deg, arriving) in &row {
            match angle_deg {
                angle if *angle > 11.0 + 1.8 => assert_eq!(*arriving, 0.0, "{algorithm:?}, {angle}°"),
                angle if *angle < 7.0 - 1.8 => assert_eq!(*arriving, 1.0, "{algorithm:?}, {angle}°"),
                _ => {}
            }
        }
        assert!(row.windows(2).all(|pair| pair[1].1 <= pair[0].1), "{algorithm:?}: {row:?}");
        let grey = row.iter().filter(|(_, arriving)| (0.02..0.98).contains(arriving)).count();
        assert!(grey >= 4, "{algorithm:?}: a rim of 4° is {grey} voxels wide: {row:?}");
        assert!(row.last().is_some_and(|(angle, _)| *angle > 13.0), "the row reaches beyond the rim");
    }
}

/// No. 18: Path lengths are those of the oblique rays: a point light at 1.5 N, and a perspective eye.
fn oblique_rays_have_longer_paths(engine: Engine) {
    let n = 48;
    let (low, high) = (8, 40);
    let loaded = Loaded::new(scenes::block(n, |v| v.iter().all(|c| (low..high).contains(c))));
    let per_voxel = 0.02;
    let mut settings = base(engine, per_voxel);
    settings.shadows.slab = 0.5;
    // 1.5 N above the middle is 3 scene units: in index space 72 voxels from the centre.
    settings.lights = vec![scenes::light(LightKind::Perspective, [0.0, 0.0, 3.0])];
    let volume = attenuation(&mut renderer(), &loaded, &settings, 0);
    let light = DVec3::new(23.5, 23.5, 23.5 + 72.0);
    let chord_from = |from: DVec3, to: DVec3| {
        let (a, b) = (DVec3::splat(low as f64 - 0.5), DVec3::splat(high as f64 - 0.5));
        let (near, far) = ((a - from) / (to - from), (b - from) / (to - from));
        let enter = near.min(far).max_element().max(0.0);
        let leave = near.max(far).min_element().min(1.0);
        (leave - enter).max(0.0) * to.distance(from)
    };
    // In each corner of the block, three voxels inside.
    for (x, y) in [(11, 11), (36, 11), (11, 36), (36, 36), (23, 23)] {
        let z = 11;
        let voxel = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
        let expected = (-per_voxel * chord_from(light, voxel)).exp();
        let found = f64::from(volume[x as usize + n * (y as usize + n * z as usize)]);
        assert!((found / expected - 1.0).abs() <= OBLIQUE_CHORD, "at {voxel}: {found} not {expected}");
    }
    settings.camera = Camera {
        distance: 1.6,
        fov_y_deg: 60.0,
        azimuth_deg: -90.0,
        elevation_deg: 0.0,
        ..Camera::default()
    };
    let size = [64, 64];
    let picture = render(&mut renderer(), &loaded, &settings, size);
    let scene = loaded.volume.scene();
    // Rays that pass the near and the far face at least three voxels from their edges.
    for (i, j) in [(32, 32), (19, 19), (44, 19), (19, 44), (44, 44)] {
        let (origin, direction) =
            settings.camera.ray_through(f64::from(i) + 0.5, f64::from(j) + 0.5, 64.0, 64.0);
        let from = scene.index_from_scene.transform_point3(origin);
        let to = scene.index_from_scene.transform_point3(origin + direction * 6.0);
        let expected = 1.0 - (-per_voxel * chord_from(from, to)).exp();
        let found = f64::from(picture.light[(i + 64 * j) as usize][3]);
        assert!((found / expected - 1.0).abs() <= OBLIQUE_CHORD, "pixel {i} {j}: {found} not {expected}");
    }
}

/// No. 17: Noise, emptiness and solidity give numbers, and nothing is exactly the background.
fn extremes_stay_finite(engine: Engine) {
    let noise: Vec<u8> = (0..32usize.pow(3)).map(|i| (i.wrapping_mul(2654435761) >> 13) as u8).collect();
    let noise = chiaroscuro::data::Volume::with_spacing(
        "noise",
        [32; 3],
        DVec3::ONE,
        chiaroscuro::data::Samples::U8(noise),
    )
    .expect("a valid volume");
    let loaded = Loaded::new(noise);
    let mut renderer = renderer();
    for opacity in [0.0, 0.5, 1.0] {
        let mut settings = scenes::look();
        settings.sampling.engine = engine;
        for point in &mut settings.transfer.points {
            point.opacity = opacity;
        }
        let picture = render(&mut renderer, &loaded, &settings, [64, 64]);
        assert!(picture.light.iter().flatten().all(|c| c.is_finite() && *c >= 0.0), "opacity {opacity}");
        assert!(picture.light.iter().all(|texel| texel[3] <= 1.0), "opacity {opacity}");
        let empty = picture.light.iter().all(|texel| texel[3] == 0.0);
        assert_eq!(empty, opacity == 0.0);
        if empty {
            let [top, bottom] = [settings.output.background.top, settings.output.background.bottom];
            for (at, texel) in picture.shown.chunks_exact(4).enumerate() {
                let down = ((at / 64) as f32 + 0.5) / 64.0;
                for c in 0..3 {
                    let expected = (top[c] + (bottom[c] - top[c]) * down) * 255.0;
                    assert!((f32::from(texel[c]) - expected).abs() <= 0.501, "{texel:?} in row {}", at / 64);
                }
            }
        }
    }
}

/// The measure of balance and of the darkness of shadows.
#[test]
fn balanced_pictures_are_as_bright_as_unshadowed_ones() {
    let loaded = Loaded::new(scenes::creature(48, DVec3::ONE));
    let mut renderer = renderer();
    let mut settings = scenes::look();
    let plain = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).light);
    settings.shadows.balance =
        chiaroscuro::gpu::balance(&mut renderer, &loaded.volume, &loaded.bricks, &settings).expect("balance");
    let with = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).light);
    settings.shadows.algorithm = chiaroscuro::model::ShadowAlgorithm::Off;
    let without = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).light);
    println!("shadows, unbalanced {plain:.4}, balanced {with:.4}, none {without:.4}");
    assert!((with / without - 1.0).abs() < 0.02, "{with} against {without}");
    assert!(plain < without, "shadows take light away");
}
