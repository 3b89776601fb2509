//! Area lights whose penumbrae are known in closed form.

use std::f64::consts::PI;

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    LightGeometry, LightSettings, LightShape, LightVolumeResolution, LitSides, NearFieldRay, RenderEngine,
    Settings, ShadowAlgorithm,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::{DVec2, DVec3};

use super::{base, renderer};
use crate::common::{Dataset, damaged_renderer, full_attenuation, render};
use crate::scenes;
use crate::thresholds::{F16_STEP, PENUMBRA, PENUMBRA_ENERGY, PENUMBRA_MIDDLE, PENUMBRA_WIDTH, TERMINATOR};

/// Number of voxels along x, y and z.
const GRID_DIMS: [usize; 3] = [124, 124, 84];

/// Layer of the plate, which is lit from above.
const PLATE_LAYER: usize = 76;

/// Opaque plate, two voxels thick, where `covers` says so: x and y from the centre.
fn plate(covers: impl Fn(DVec2) -> f64) -> Dataset {
    let [nx, ny, nz] = GRID_DIMS;
    let value = |at: usize| {
        let [x, y, z] = [at % nx, at / nx % ny, at / (nx * ny)];
        let place = DVec2::new(x as f64, y as f64) - DVec2::new(nx as f64 - 1.0, ny as f64 - 1.0) / 2.0;
        if z == PLATE_LAYER || z == PLATE_LAYER + 1 { (255.0 * covers(place)).round() as u8 } else { 0 }
    };
    let values = (0..nx * ny * nz).map(value).collect();
    Dataset::new(Volume::with_spacing("plate", GRID_DIMS, DVec3::ONE, Samples::U8(values)).expect("a volume"))
}

/// Look with a disc above, with a given tangent of its angular radius.
fn disc_look(tangent: f64) -> Settings {
    let mut settings = base(RenderEngine::Gather, 8.0);
    settings.lights = vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 2.0])];
    settings.lights[0].shape = LightShape::Disc;
    settings.lights[0].angle_deg = 2.0 * tangent.atan().to_degrees();
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    settings
}

/// Share of the light of a disc at infinity, evenly bright with this tangent of its angular radius, that arrives on a
/// surface facing it behind a half-plane, whose edge is at `u` of that tangent from its centre.
///
/// The light is even over the sines of the angles: x and y of the unit vectors towards it. Its edge, x = u tan α z,
/// is half an ellipse there, x = k √(1 − y²) with k = u tan α / √(1 + u² tan² α). Integrated over rows of equal angle.
fn visible_disc_share(u: f64, tangent: f64) -> f64 {
    let radius = tangent / (1.0 + tangent * tangent).sqrt();
    let edge = u * tangent / (1.0 + (u * tangent).powi(2)).sqrt();
    let rows = 400;
    let row = |at: i32| {
        let angle = PI * ((f64::from(at) + 0.5) / f64::from(rows) - 0.5);
        let (y, half) = (radius * angle.sin(), radius * angle.cos());
        // dy is proportional to the cosine, as is half of the row.
        let seen = (edge * (1.0 - y * y).sqrt()).clamp(-half, half) + half;
        (seen * angle.cos(), 2.0 * half * angle.cos())
    };
    let (seen, all) = (0..rows).map(row).fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
    seen / all
}

/// Light in the layer `depth` voxels below the plate, along `across`, within `reach` of the edge: positions and
/// values.
fn profile(volume: &[f32], depth: usize, across: DVec2, reach: f64) -> Vec<(f64, f64)> {
    let [nx, ny, _] = GRID_DIMS;
    // The plate's middle is half a voxel above layer `PLATE_LAYER`.
    let z = PLATE_LAYER - depth;
    let voxels = (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y)));
    voxels
        .filter_map(|(x, y)| {
            let place = DVec2::new(x as f64, y as f64) - DVec2::new(nx as f64 - 1.0, ny as f64 - 1.0) / 2.0;
            let along = place.dot(across);
            // Away from the borders of the volume, where light enters beside the plate.
            let inside = place.perp_dot(across).abs() < 6.0 && along.abs() < reach;
            let value = || f64::from(volume[x + nx * (y + ny * z)]);
            inside.then(|| (along, value()))
        })
        .collect()
}

/// Row of means over values within half a voxel of each position, `reach` voxels to both sides of the edge.
fn mean_row(volume: &[f32], depth: usize, across: DVec2, reach: usize) -> Vec<f64> {
    let found = profile(volume, depth, across, reach as f64 + 1.5);
    let mean_at = |at: f64| {
        let weighted = found.iter().map(|(along, value)| ((1.0 - (along - at).abs()).max(0.0), value));
        let (sum, weights) =
            weighted.fold((0.0, 0.0), |(sum, all), (weight, value)| (sum + weight * value, all + weight));
        sum / weights
    };
    (0..=2 * reach).map(|at| mean_at(at as f64 - reach as f64)).collect()
}

/// Penumbra of a half-plane under a disc at every distance, in many directions. The edge is as soft as a point light's shadow of it, which convolves the penumbra.
#[test]
fn penumbrae_widen_with_the_distance() {
    let tangent = 0.4;
    let mut worst_of_all = 0.0_f64;
    for turn_deg in [22.5_f64, 45.0] {
        let across = DVec2::from_angle(turn_deg.to_radians());
        let loaded = plate(|place| (0.5 - place.dot(across)).clamp(0.0, 1.0));
        let mut settings = disc_look(tangent);
        let volume = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        settings.lights[0].shape = LightShape::Point;
        let sharp = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        let mut worst = [0.0_f64; 4];
        for (worst, depth) in worst.iter_mut().zip([8, 16, 32, 64]) {
            let half = (depth as f64 + 0.5) * tangent;
            // As far as light from this edge alone arrives.
            let reach = half as usize + 3;
            let edge = mean_row(&sharp, depth, across, 8);
            let found = mean_row(&volume, depth, across, reach);
            for (at, found) in found.into_iter().enumerate() {
                let place = at as f64 - reach as f64;
                let blurred = edge.windows(2).enumerate().map(|(at, pair)| {
                    let step = at as f64 + 0.5 - 8.0;
                    (pair[1] - pair[0]) * visible_disc_share((place - step) / half, tangent)
                });
                *worst = worst.max((found - blurred.sum::<f64>()).abs());
            }
        }
        println!("{turn_deg}°: {worst:.4?}");
        worst_of_all = worst.into_iter().fold(worst_of_all, f64::max);
    }
    assert!(worst_of_all <= PENUMBRA, "{worst_of_all}");
}

/// A penumbra is twice as wide at twice the distance, unlike a random walk, whose width grows by √2 only.
#[test]
fn twice_as_far_is_twice_as_wide() {
    let loaded = plate(|place| (0.5 - place.x).clamp(0.0, 1.0));
    let volume = full_attenuation(&mut renderer(), &loaded, &disc_look(0.4), 0);
    // Standard deviation of the slope, which discrete steps hardly affect.
    let width = |depth: usize| {
        let reach = (0.5 * depth as f64) as usize + 6;
        let slopes = mean_row(&volume, depth, DVec2::X, reach);
        let slopes: Vec<_> =
            slopes.windows(2).enumerate().map(|(at, pair)| (at as f64, pair[1] - pair[0])).collect();
        let total: f64 = slopes.iter().map(|(_, slope)| slope).sum();
        let mean = slopes.iter().map(|(at, slope)| at * slope).sum::<f64>() / total;
        (slopes.iter().map(|(at, slope)| (at - mean).powi(2) * slope).sum::<f64>() / total).sqrt()
    };
    let [near, far] = [30, 60].map(|depth| width(depth) / (depth as f64 + 0.5));
    println!("widths per distance: {near:.4}, {far:.4}");
    assert!((far / near - 1.0).abs() <= PENUMBRA_WIDTH, "{near}, {far}");
}

/// Grid of a plane with a plate above it.
const PLANE_DIMS: [usize; 3] = [100, 48, 52];
/// Number of layers that the plane fills.
const PLANE_LAYERS: usize = 16;
/// Lower of the plate's two layers.
const PLATE_ABOVE: usize = 45;
/// Number of columns that the plate covers.
const PLATE_COLUMNS: usize = 80;
/// Layer of a light volume at half the resolution that is measured: three voxels above the plane, where pictures look it
/// up, and 27 below the plate.
const MEASURED_LAYER: usize = 9;
const PLATE_HEIGHT: f64 = 27.0;

/// Opaque plane, and a plate above it that covers its left part.
fn plane_below_plate(has_plate: bool) -> Dataset {
    let [nx, ny, nz] = PLANE_DIMS;
    let value = |at: usize| {
        let [x, z] = [at % nx, at / (nx * ny)];
        let is_plate = has_plate && (PLATE_ABOVE..PLATE_ABOVE + 2).contains(&z) && x < PLATE_COLUMNS;
        if z < PLANE_LAYERS || is_plate { 255 } else { 0 }
    };
    let values = (0..nx * ny * nz).map(value).collect();
    Dataset::new(
        Volume::with_spacing("plane", PLANE_DIMS, DVec3::ONE, Samples::U8(values)).expect("a volume"),
    )
}

/// Position along x of the middle of the plate's penumbra, just above the plane: there, half of the light arrives that
/// does without the plate.
fn middle_of_penumbra(renderer: &mut Renderer, settings: &Settings) -> f64 {
    let [nx, ny] = [PLANE_DIMS[0] / 2, PLANE_DIMS[1] / 2];
    let mut row = |has_plate: bool| -> Vec<f64> {
        let volume = full_attenuation(renderer, &plane_below_plate(has_plate), settings, 0);
        let at = |x: usize, y: usize| f64::from(volume[x + nx * (y + ny * MEASURED_LAYER)]);
        (0..nx).map(|x| (ny / 2 - 2..ny / 2 + 2).map(|y| at(x, y)).sum()).collect()
    };
    let (behind, open) = (row(true), row(false));
    let shares: Vec<f64> = behind.iter().zip(&open).map(|(behind, open)| behind / open).collect();
    let left = shares.windows(2).position(|pair| pair[0] < 0.5 && pair[1] >= 0.5).expect("a penumbra");
    let between = (0.5 - shares[left]) / (shares[left + 1] - shares[left]);
    2.0 * (left as f64 + between)
}

/// Distance along x of the middle of a penumbra from the shadow's edge under the middle of the light. `tangents` are
/// even points of the light, in the plane at distance 1 across the direction to its middle, each of which gives the
/// same to a surface that faces it. The light is tilted by an angle towards x.
fn shift_of_penumbra(tangents: impl Iterator<Item = f64>, tilt_deg: f64) -> f64 {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    // Place of the edge's shadow, and what the plane takes of the point.
    let place_and_share = |t: f64| (-PLATE_HEIGHT * (cos * t + sin) / (cos - sin * t), cos - sin * t);
    let mut edges: Vec<_> = tangents.map(place_and_share).collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = edges.iter().map(|(_, share)| share).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let middle = edges.iter().find(|(_, share)| {
        sum += share;
        sum >= half
    });
    middle.expect("points").0 + PLATE_HEIGHT * sin / cos
}

/// Middles of the penumbrae of wide lights on a plane that they meet at several angles: low parts of a light give less
/// than high ones.
#[test]
fn middles_of_penumbrae_follow_the_cosines() {
    let half = 20_f64.to_radians();
    let even = |at: i32| (f64::from(at) + 0.5) / 200.0 - 1.0;
    let disc = || {
        let sines = (0..160_000).map(|at| DVec2::new(even(at % 400), even(at / 400)));
        let inside = sines.filter(|at| at.length_squared() < 1.0).map(|at| at * half.sin());
        inside.map(|at| at.x / (1.0 - at.length_squared()).sqrt()).collect::<Vec<_>>()
    };
    // Points of rectangles are even over the sine along each axis alone.
    let rectangle = (0..400).map(|at| (even(at) * half.sin()).asin().tan()).collect::<Vec<_>>();
    let settings = |kind, shape, tilt_deg: f64, samples| {
        let (sin, cos) = tilt_deg.to_radians().sin_cos();
        // Far away, so that light from its middle is parallel.
        let away = 20.0;
        let mut settings = base(RenderEngine::Gather, 8.0);
        settings.shading.surface_gradient = 0.02;
        settings.shadows.area.samples = samples;
        settings.lights = vec![LightSettings {
            shape,
            angle_deg: 40.0,
            size: 2.0 * away * half.tan(),
            aspect: 1.0,
            ..scenes::light(kind, [sin * away, 0.0, cos * away])
        }];
        settings
    };
    let (from, to) = ("return slope * (share", "return slope * (0.0 * share");
    crate::against_reference::mutations::assert_in_shader("light/area_light.wgsl", from);
    for (kind, shape, tangents) in [
        (LightGeometry::Parallel, LightShape::Disc, disc()),
        (LightGeometry::Perspective, LightShape::Rectangle, rectangle),
    ] {
        for tilt_deg in [0.0, 20.0, 30.0, 45.0] {
            let look = |samples| settings(kind, shape, tilt_deg, samples);
            let edge = middle_of_penumbra(&mut renderer(), &look(1));
            let found = middle_of_penumbra(&mut renderer(), &look(64)) - edge;
            let right = shift_of_penumbra(tangents.iter().copied(), tilt_deg);
            println!("{shape:?}, {tilt_deg}°: {found:.2}, closed form {right:.2}");
            assert!((found - right).abs() <= PENUMBRA_MIDDLE, "{shape:?}, {tilt_deg}°: {found}, not {right}");
            if tilt_deg > 40.0 {
                let equal = middle_of_penumbra(&mut damaged_renderer(from, to), &look(64)) - edge;
                println!("with equal weights {equal:.2}");
                assert!((equal - right).abs() > 2.0 * PENUMBRA_MIDDLE, "{shape:?}: equal weights: {equal}");
            }
        }
    }
}

/// A small occluder takes as much of an area light as of a point light; it is only spread.
#[test]
fn a_penumbra_takes_no_light_away() {
    let loaded = plate(|place| f64::from(u8::from(place.length() < 6.0)));
    let mean = |settings: &Settings| {
        let volume = full_attenuation(&mut renderer(), &loaded, settings, 0);
        let [nx, ny, _] = GRID_DIMS;
        let layer = &volume[nx * ny * (PLATE_LAYER - 40)..][..nx * ny];
        layer.iter().map(|&value| f64::from(value)).sum::<f64>() / (nx * ny) as f64
    };
    let large = disc_look(0.4);
    let mut point = large.clone();
    point.lights[0].shape = LightShape::Point;
    let (found, right) = (mean(&large), mean(&point));
    println!("left of a disc {found:.5}, of a point {right:.5}");
    assert!(right < 0.995 && (found - right).abs() <= PENUMBRA_ENERGY, "{found}, not {right}");
}

/// An area light of size 0 is a point light, byte for byte; a very small one nearly so.
#[test]
fn no_size_is_a_point() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let volume = |settings: &Settings| full_attenuation(&mut renderer(), &loaded, settings, 0);
    for kind in [LightGeometry::Parallel, LightGeometry::Perspective] {
        let mut settings = disc_look(0.4);
        settings.lights[0] = scenes::light(kind, [1.2, -1.7, 2.0]);
        let point = volume(&settings);
        let light = &mut settings.lights[0];
        (light.shape, light.size, light.angle_deg) = (LightShape::Ball, 0.0, 0.0);
        assert_eq!(volume(&settings), point, "{kind:?}");
        let light = &mut settings.lights[0];
        (light.size, light.angle_deg) = (1e-6, 1e-6);
        let farthest = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(farthest(&volume(&settings), &point) <= F16_STEP, "{kind:?}");
        let light = &mut settings.lights[0];
        (light.size, light.angle_deg) = (0.5, 20.0);
        assert!(farthest(&volume(&settings), &point) > 0.1, "a size is seen");
    }
}

/// Look with a light beside a ball, so large that parts of it set long before others.
fn look_beside_a_ball(light: LightSettings) -> Settings {
    let mut settings = scenes::look();
    settings.layer_mut().transfer = scenes::linear_extinction(4.0);
    settings.shading.sides = LitSides::One;
    (settings.shading.ambient, settings.shading.specular) = (0.0, 0.0);
    settings.shadows.near_field = NearFieldRay::Long;
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    settings.shadows.area.samples = 32;
    settings.camera = scenes::axis_camera(-60.0, 35.0);
    settings.lights = vec![light];
    settings
}

/// Light at the terminator of a surface is the mean over the points of a light: each shines only on surfaces that
/// face it.
#[test]
fn light_ends_where_the_last_point_sets() {
    let n = 40;
    let loaded = Dataset::new(scenes::ball(n, DVec3::splat(n as f64 / 2.0 - 0.5), 15.0));
    let mut renderer = renderer();
    let mut picture = |settings: &Settings| -> Vec<f64> {
        let picture = render(&mut renderer, &loaded, settings, [96, 72]);
        picture.linear.iter().map(|&[r, ..]| f64::from(r)).collect()
    };
    for (kind, position, algorithm) in [
        (LightGeometry::Parallel, [2.0, 0.6, 0.3], ShadowAlgorithm::Splat),
        (LightGeometry::Perspective, [1.9, 0.5, -0.2], ShadowAlgorithm::Splat),
        (LightGeometry::Parallel, [2.0, 0.6, 0.3], ShadowAlgorithm::Off),
    ] {
        let disc = LightSettings {
            shape: LightShape::Disc,
            angle_deg: 50.0,
            size: 1.6,
            ..scenes::light(kind, position)
        };
        let mut settings = look_beside_a_ball(disc);
        settings.shadows.algorithm = algorithm;
        let found = picture(&settings);
        let points = settings.lights[0].resolve(&settings.camera).sample_lights(32);
        let mut mean = vec![0.0; found.len()];
        for point in &points {
            let mut alone = settings.clone();
            (alone.lights[0].shape, alone.lights[0].position) = (LightShape::Point, point.position);
            let share = 1.0 / points.len() as f64;
            mean.iter_mut().zip(picture(&alone)).for_each(|(sum, light)| *sum += light * share);
        }
        // As if all of the light came from its centre.
        settings.shadows.area.samples = 1;
        let middle = picture(&settings);
        // Where at least half of the light has set, which is where it is weak.
        let brightest = mean.iter().copied().fold(0.0, f64::max);
        let is_low = |light: f64| light > 1e-3 * brightest && light < 0.2 * brightest;
        let off = |picture: &[f64]| {
            let low = picture.iter().zip(&mean).filter(|&(_, &mean)| is_low(mean));
            let (sum, all) = low.fold((0.0, 0.0), |(sum, all), (a, b)| (sum + (a - b).abs(), all + b));
            sum / all
        };
        let (off, of_middle) = (off(&found), off(&middle));
        println!("{kind:?}, {algorithm:?}: off by {off:.3}, {of_middle:.3} from the middle");
        assert!(
            off <= TERMINATOR && of_middle >= 1.75 * TERMINATOR,
            "{kind:?}, {algorithm:?}: {off} {of_middle}"
        );
    }
}
