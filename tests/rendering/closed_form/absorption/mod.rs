//! Absorption by homogeneous material in closed form: Beer–Lambert, and the opacity of chords.

mod materials;

use chiaroscuro_render::{RenderedPicture, plan::light_views};
use chiaroscuro_scene::{
    Camera, DepositMode, LightGeometry, RenderEngine, ReverseKernel, ShadowAlgorithm, SlabMode,
    SlabQuadrature,
};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, full_attenuation, render};
use crate::scenes;
use crate::thresholds::{
    BEER_LAMBERT, CHORD_OPACITY, MIN_COMPARED_LIGHT, OBLIQUE_CHORD, RAY_BEER_LAMBERT, SLAB_MEAN_CHANGE,
};

with_both_engines! {
    beer_lambert_in_a_homogeneous_block
    opacity_of_a_chord
    oblique_rays_have_longer_paths
}

/// Variance of the cubic B-spline, in voxels².
const KERNEL_VARIANCE: f64 = 1.0 / 3.0;

/// Mean of the picture's alpha over its central 4 × 4 pixels.
fn middle_alpha(picture: &RenderedPicture) -> f64 {
    let [w, h] = picture.size.map(|n| n as usize);
    let texels: Vec<f64> = (h / 2 - 2..h / 2 + 2)
        .flat_map(|y| (w / 2 - 2..w / 2 + 2).map(move |x| y * w + x))
        .map(|at| f64::from(picture.linear[at][3]))
        .collect();
    texels.iter().sum::<f64>() / texels.len() as f64
}

/// No. 2: Light falls off exponentially in homogeneous material, times the kernel's effect on an exponential:
/// e^(μ²σ²/2) from the reverse splat, sinh(μΔs/2)/(μΔs/2) from the slab.
fn beer_lambert_in_a_homogeneous_block(engine: RenderEngine) {
    let n = 48;
    let face = 8;
    let loaded =
        Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    for (per_voxel, slab, tolerance) in BEER_LAMBERT {
        for (quadrature, power) in [(SlabQuadrature::One, 1), (SlabQuadrature::Two, 2)] {
            let mut settings = base(engine, per_voxel);
            settings.shadows.slab = slab;
            settings.shadows.quadrature = quadrature;
            let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
            let half = per_voxel * slab / 2.0;
            let factor =
                (per_voxel * per_voxel * KERNEL_VARIANCE / 2.0).exp() * (half.sinh() / half).powi(power);
            for z in face + 3..n - face - 3 {
                // Light comes from +z; the block's upper face is at z = n − face − ½.
                let depth = (n - face) as f64 - 0.5 - z as f64;
                let expected = (-per_voxel * depth).exp() * factor;
                let found = f64::from(volume[n / 2 + n * (n / 2 + n * z)]);
                if expected > MIN_COMPARED_LIGHT {
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

/// No. 2, splatted back with a tent: its effect on an exponential is a sum over the slabs under it, whose positions
/// are given by the sheets' frame.
#[test]
fn beer_lambert_with_a_tent_on_the_way_back() {
    let n = 48;
    let face = 8;
    let loaded =
        Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    let scene = loaded.volume().scene();
    for (per_voxel, slab, tolerance) in BEER_LAMBERT {
        let mut settings = base(RenderEngine::Gather, per_voxel);
        settings.shadows.reverse_kernel = ReverseKernel::Tent;
        settings.shadows.slab = slab;
        let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        let light = settings.lights[0].resolve(&settings.camera);
        let view = light_views(&light, &settings.shadows, &scene).remove(0);
        let half = per_voxel * slab / 2.0;
        for z in face + 3..n - face - 3 {
            let depth = (n - face) as f64 - 0.5 - z as f64;
            let point = DVec3::new(n as f64 / 2.0, n as f64 / 2.0, z as f64);
            let at = view.project(scene.scene_from_index.transform_point3(point)).expect("seen").slab;
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in (at - 8.0).floor() as i32..=(at + 8.0).ceil() as i32 {
                // In voxels, from the voxel to the middle of the slab.
                let behind = (f64::from(k) - at) * slab;
                let weight = (1.0 - behind.abs()).max(0.0);
                sum += weight * (-per_voxel * (depth + behind)).exp();
                weights += weight;
            }
            let expected = sum / weights * half.sinh() / half;
            let found = f64::from(volume[n / 2 + n * (n / 2 + n * z)]);
            if expected > MIN_COMPARED_LIGHT {
                let error = (found / expected - 1.0).abs();
                assert!(
                    error <= tolerance,
                    "μ {per_voxel}, Δs {slab}: {found} not {expected} at depth {depth}"
                );
            }
        }
    }
}

/// No. 2, for rays from the voxels: back-projection blurs nothing, so light falls exactly as e^(−μ·depth). Sampled
/// twice per voxel, where the midpoint rule meets the faces exactly.
#[test]
fn beer_lambert_by_rays() {
    let n = 48;
    let face = 8;
    let loaded =
        Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    for per_voxel in [0.1, 0.3, 0.7] {
        let mut settings = base(RenderEngine::Gather, per_voxel);
        settings.shadows.algorithm = ShadowAlgorithm::Raycast;
        settings.shadows.slab = 0.5;
        let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        for z in face + 3..n - face - 3 {
            let depth = (n - face) as f64 - 0.5 - z as f64;
            let expected = (-per_voxel * depth).exp();
            let found = f64::from(volume[n / 2 + n * (n / 2 + n * z)]);
            if expected > MIN_COMPARED_LIGHT {
                let error = (found / expected - 1.0).abs();
                assert!(error <= RAY_BEER_LAMBERT, "μ {per_voxel}: {found} not {expected} at depth {depth}");
            }
        }
    }
}

/// Rays end at the light: amid homogeneous material a near light falls as e^(−μ·distance), however the distance
/// divides into steps.
#[test]
fn beer_lambert_by_rays_to_a_light_inside() {
    let n = 48;
    let loaded = Dataset::new(scenes::block(n, |v| v.iter().all(|c| (4..n - 4).contains(c))));
    let middle = (n as f64 - 1.0) / 2.0;
    let light = DVec3::new(25.3, 22.1, 24.45);
    let place = (light - middle) * 2.0 / n as f64;
    let mut renderer = renderer();
    for (per_voxel, deposit) in [
        (0.1, DepositMode::SlabMean),
        (0.3, DepositMode::SlabMean),
        (0.1, DepositMode::Front),
        (0.3, DepositMode::Front),
    ] {
        let mut settings = base(RenderEngine::Gather, per_voxel);
        settings.shadows.algorithm = ShadowAlgorithm::Raycast;
        settings.shadows.deposit = deposit;
        settings.lights = vec![scenes::light(LightGeometry::Perspective, place.into())];
        let volume = full_attenuation(&mut renderer, &loaded, &settings, 0);
        // In the paper's deposit, the half step before the first sample is not counted.
        let missing = if deposit == DepositMode::Front { 0.5 } else { 0.0 };
        for at in (0..n * n * n).step_by(7) {
            let voxel = DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64);
            let distance = voxel.distance(light);
            if !(missing..=12.0).contains(&distance) {
                continue;
            }
            let expected = (-per_voxel * (distance - missing)).exp();
            let found = f64::from(volume[at]);
            let error = (found / expected - 1.0).abs();
            assert!(
                error <= RAY_BEER_LAMBERT,
                "μ {per_voxel}, {deposit:?}: {found} not {expected} at {distance} voxels"
            );
        }
    }
}

/// No. 3: The opacity of homogeneous material along a ray is 1 − e^(−μ·chord), whatever the slab.
fn opacity_of_a_chord(engine: RenderEngine) {
    let n = 48;
    let block = Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (12..36).contains(c))));
    let ball = Dataset::new(scenes::ball(n, DVec3::splat(23.5), 14.0));
    for (name, loaded, chord) in [("block", &block, 24.0f64), ("ball", &ball, 28.0)] {
        let mut means = Vec::new();
        for (slab, quadrature) in [
            (0.25, SlabQuadrature::One),
            (0.5, SlabQuadrature::One),
            (1.0, SlabQuadrature::One),
            (2.0, SlabQuadrature::Two),
        ] {
            let mut settings = base(engine, 0.05);
            settings.sampling.slab = slab;
            settings.sampling.quadrature = quadrature;
            let picture = render(&mut renderer(), loaded, &settings, [96, 96]);
            let expected = 1.0 - (-0.05 * chord).exp();
            let found = if name == "ball" {
                f64::from(picture.linear[48 * 96 + 48][3])
            } else {
                middle_alpha(&picture)
            };
            // Half a pixel off the centre shortens the ball's chord by less than 0.1 %.
            assert!((found - expected).abs() <= CHORD_OPACITY, "{name}, Δs {slab}: {found} not {expected}");
            means.push(picture.linear.iter().map(|texel| f64::from(texel[3])).sum::<f64>());
        }
        assert!((means[2] / means[0] - 1.0).abs() <= SLAB_MEAN_CHANGE, "{name}: {means:?}");
    }
}

/// Opacity of a chord with slabs by need, for material that absorbs much, or little, within a voxel.
#[test]
fn opacity_of_a_chord_by_need() {
    let ball = Dataset::new(scenes::ball(48, DVec3::splat(23.5), 14.0));
    for per_voxel in [0.02, 0.1, 0.2] {
        let mut settings = base(RenderEngine::Gather, per_voxel);
        settings.sampling.slabs = SlabMode::ByNeed;
        let picture = render(&mut renderer(), &ball, &settings, [96, 96]);
        let expected = 1.0 - (-per_voxel * 28.0_f64).exp();
        let found = f64::from(picture.linear[48 * 96 + 48][3]);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{per_voxel}: {found} not {expected}");
    }
}

/// No. 18: Path lengths are those of the oblique rays: a point light at 1.5 N, and a perspective eye.
fn oblique_rays_have_longer_paths(engine: RenderEngine) {
    let n = 48;
    let (low, high) = (8, 40);
    let loaded = Dataset::new(scenes::block(n, |v| v.iter().all(|c| (low..high).contains(c))));
    let per_voxel = 0.02;
    let mut settings = base(engine, per_voxel);
    settings.shadows.slab = 0.5;
    // 1.5 N above the middle is 3 scene units: in index space 72 voxels from the centre.
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [0.0, 0.0, 3.0])];
    let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
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
    let scene = loaded.volume().scene();
    // Rays that pass the near and the far face at least three voxels from their edges.
    for (i, j) in [(32, 32), (19, 19), (44, 19), (19, 44), (44, 44)] {
        let (origin, direction) =
            settings.camera.ray_through(f64::from(i) + 0.5, f64::from(j) + 0.5, 64.0, 64.0);
        let from = scene.index_from_scene.transform_point3(origin);
        let to = scene.index_from_scene.transform_point3(origin + direction * 6.0);
        let expected = 1.0 - (-per_voxel * chord_from(from, to)).exp();
        let found = f64::from(picture.linear[(i + 64 * j) as usize][3]);
        assert!((found / expected - 1.0).abs() <= OBLIQUE_CHORD, "pixel {i} {j}: {found} not {expected}");
    }
}
