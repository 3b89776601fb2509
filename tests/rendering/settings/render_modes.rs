//! Render modes: projections against a plain walk along each ray in f64, and surfaces against steps of a curve.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_render::{RenderOptions, Renderer, TestSwitches};
use chiaroscuro_scene::{
    Camera, ControlPoint, DensityRange, Projection, RenderMode, Settings, TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use crate::common::{Dataset, damaged_renderer, new_renderer, render};
use crate::compare::{channels_f32, compare};
use crate::scenes;
use crate::thresholds::PROJECTION;

const SIZE: [u32; 2] = [48, 40];

/// Distance between the samples of the plain walk, in units of a ray's depth: about a hundredth of a voxel. Around the
/// extreme they are a hundred times nearer.
const STEP: f64 = 0.001;

const PROJECTIONS: [RenderMode; 3] = [RenderMode::Maximum, RenderMode::Minimum, RenderMode::Mean];

/// Volume of 20 × 14 × 17 voxels, each of which has a value of its own, without any order.
fn random_voxels() -> Volume {
    let hash =
        |at: u32| (at.wrapping_mul(2_654_435_761).rotate_left(13) ^ at).wrapping_mul(0x9e37_79b1) >> 24;
    let values = (0..20 * 14 * 17).map(|at| hash(at) as u8).collect();
    Volume::with_spacing("random", [20, 14, 17], DVec3::new(1.0, 1.3, 0.8), Samples::U8(values))
        .expect("a valid volume")
}

fn curve(points: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, opacity): &(f64, f64)| {
        let share = value as f32 / 255.0;
        ControlPoint::new(value, [share, 1.0 - 0.5 * share, 0.3], opacity)
    };
    TransferFunction { points: points.iter().map(point).collect(), ..TransferFunction::default() }
}

/// Curves that rise, fall, and have a peak.
fn curves() -> [TransferFunction; 3] {
    [
        &[(30.0, 0.0), (250.0, 0.9)][..],
        &[(5.0, 0.9), (200.0, 0.0)],
        &[(60.0, 0.0), (130.0, 0.8), (245.0, 0.0)],
    ]
    .map(curve)
}

fn look(kind: RenderMode, transfer: &TransferFunction) -> Settings {
    let mut settings = scenes::look().with_transfer(transfer.clone()).with_range(DensityRange::Full);
    settings.mode.kind = kind;
    settings.camera.distance = 4.0;
    // Has no effect on colours that are shown as they are.
    settings.output.exposure = 3.0;
    settings
}

/// Trilinear value between voxels; that of the outermost ones continues beyond them.
fn value_at(volume: &Volume, p: DVec3) -> f64 {
    let last = volume.dims().map(|n| n - 1);
    let place = |axis: usize| {
        let at = p[axis].clamp(0.0, last[axis] as f64);
        let low = (at as usize).min(last[axis].saturating_sub(1));
        (low, (low + 1).min(last[axis]), at - low as f64)
    };
    let [x, y, z] = [0, 1, 2].map(place);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |y: usize, z: usize| mix(volume.value(x.0, y, z), volume.value(x.1, y, z), x.2);
    let slice = |z: usize| mix(row(y.0, z), row(y.1, z), y.2);
    mix(slice(z.0), slice(z.1), z.2)
}

/// Picture by a plain walk along each ray; `shows` tells the points that are neither cut away nor missing.
fn plain_picture(volume: &Volume, settings: &Settings, shows: impl Fn(DVec3) -> bool) -> Vec<f64> {
    let frame = Reference::new(volume, settings, ReferenceOptions::default()).eye_frame(SIZE);
    let is_inside =
        |p: DVec3| (0..3).all(|axis| p[axis] >= -0.5 && p[axis] <= volume.dims()[axis] as f64 - 0.5);
    let sign = if settings.mode.kind == RenderMode::Minimum { -1.0 } else { 1.0 };
    let pixel = |at: u32| {
        let [i, j] = [at % SIZE[0], at / SIZE[0]].map(f64::from);
        let walk = |first: f64, length: f64, step: f64| -> Vec<(f64, f64)> {
            let depths = (0..(length / step) as u32).map(|at| first + (f64::from(at) + 0.5) * step);
            let points = depths.map(|depth| (depth, frame.point(i, j, depth)));
            let shown = points.filter(|(_, p)| is_inside(*p) && shows(*p));
            shown.map(|(depth, p)| (depth, value_at(volume, p))).collect()
        };
        let along = walk(frame.first_depth, f64::from(frame.slab_count) * frame.slab, STEP);
        let best = |values: &[(f64, f64)]| {
            values.iter().copied().max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))
        };
        let Some((depth, _)) = best(&along) else { return [0.0; 4] };
        let shown = if settings.mode.kind == RenderMode::Mean {
            // Short ways through a corner need samples that are nearer.
            let [first, last] = [along[0].0 - STEP, along[along.len() - 1].0 + STEP];
            let near = if along.len() < 100 { walk(first, last - first, 0.01 * STEP) } else { along };
            near.iter().map(|(_, value)| value).sum::<f64>() / near.len() as f64
        } else {
            best(&walk(depth - STEP, 2.0 * STEP, 0.01 * STEP)).map_or(0.0, |(_, value)| value)
        };
        let found = settings.layer().transfer.sample(shown);
        let opacity = 1.0 - (-found.depth).exp();
        let [r, g, b] = found.color.map(|c| c * opacity);
        [r, g, b, opacity]
    };
    (0..SIZE[0] * SIZE[1]).flat_map(pixel).collect()
}

fn drawn(renderer: &mut Renderer, loaded: &Dataset, settings: &Settings) -> Vec<f64> {
    channels_f32(&render(renderer, loaded, settings, SIZE).linear)
}

/// Compares a picture with a plain walk; `shows` tells the points that are neither cut away nor missing.
fn assert_plain(
    what: &str,
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    shows: impl Fn(DVec3) -> bool,
) {
    let expected = plain_picture(loaded.volume(), settings, shows);
    compare(what, &drawn(renderer, loaded, settings), &expected, PROJECTION)
        .unwrap_or_else(|err| panic!("{err}"));
}

#[test]
fn projections_are_those_of_a_plain_walk() {
    let loaded = Dataset::new(random_voxels());
    let mut renderer = new_renderer();
    for (kind, transfer) in PROJECTIONS.into_iter().flat_map(|kind| curves().map(|curve| (kind, curve))) {
        let mut settings = look(kind, &transfer);
        for projection in [Projection::Perspective, Projection::Orthographic] {
            settings.camera.projection = projection;
            assert_plain(&format!("{kind:?} {projection:?}"), &mut renderer, &loaded, &settings, |_| true);
        }
    }
}

/// Along an axis, a projection of the rows of voxels themselves.
#[test]
fn along_an_axis_rows_of_voxels_are_projected() {
    let loaded = Dataset::new(random_voxels());
    let mut renderer = new_renderer();
    for kind in PROJECTIONS {
        let mut settings = look(kind, &curves()[0]);
        settings.camera = Camera { distance: 3.0, ..scenes::axis_camera(0.0, 0.0) };
        assert_plain(&format!("{kind:?} along an axis"), &mut renderer, &loaded, &settings, |_| true);
    }
}

#[test]
fn what_is_cut_away_or_missing_is_not_projected() {
    let cut = Dataset::new(random_voxels());
    let mut renderer = new_renderer();
    for kind in PROJECTIONS {
        let mut settings = look(kind, &curves()[0]);
        settings.cuts.crop.on = true;
        (settings.cuts.crop.low, settings.cuts.crop.high) = ([0.2, 0.1, 0.3], [0.7, 1.0, 0.9]);
        let region = settings.cuts.visible_part().region(&cut.volume().scene());
        let shows = |p| region.contains(p);
        assert_plain(&format!("{kind:?} of a crop"), &mut renderer, &cut, &settings, shows);
    }
    // A value of its own in a third of the volume, which means that nothing was measured there.
    let samples = (0..20 * 14 * 17).map(|at| if at % 20 < 7 { 255 } else { 100 }).collect();
    let gap = Volume::with_spacing("gap", [20, 14, 17], DVec3::ONE, Samples::U8(samples)).expect("a volume");
    let gap = Dataset::new(gap.with_padding(255.0).expect("a volume with missing voxels"));
    let alone = look(RenderMode::Maximum, &curves()[0]).layer().transfer.sample(100.0);
    for kind in PROJECTIONS {
        let picture = render(&mut renderer, &gap, &look(kind, &curves()[0]), SIZE).linear;
        let opacity = 1.0 - (-alone.depth).exp();
        let seen: Vec<_> = picture.iter().filter(|texel| texel[3] > 0.0).collect();
        assert!(seen.len() > 200, "{kind:?}: {}", seen.len());
        assert!(seen.iter().all(|texel| (f64::from(texel[3]) - opacity).abs() < 2e-3), "{kind:?}");
    }
}

/// Skipping what the curve does not show changes nothing, whatever its shape, and also where missing voxels part values.
#[test]
fn skipping_changes_no_projection() {
    let samples = (0..32 * 32 * 32).map(|at| match at % 32 {
        0..16 => 255,
        16..18 => 1,
        _ => 60,
    });
    let parted = Volume::with_spacing("parted", [32; 3], DVec3::ONE, Samples::U8(samples.collect()));
    let parted = parted.and_then(|volume| volume.with_padding(1.0)).expect("a volume with missing voxels");
    let mut renderer = new_renderer();
    let mut shown = 0;
    for loaded in [scenes::creature(32, DVec3::ONE), parted].map(Dataset::new) {
        for (kind, transfer) in PROJECTIONS.into_iter().flat_map(|kind| curves().map(|curve| (kind, curve))) {
            let settings = look(kind, &transfer);
            let switches = TestSwitches { empty_space_skipping: false, ..TestSwitches::default() };
            let all = RenderOptions { switches, ..RenderOptions::default() };
            let mut light = |options| {
                channels_f32(&renderer.render(&loaded, &settings, SIZE, &options).expect("a picture").linear)
            };
            let (skipped, walked) = (light(RenderOptions::default()), light(all));
            compare(&format!("{kind:?} with skipping"), &skipped, &walked, PROJECTION)
                .unwrap_or_else(|err| panic!("{err}"));
            shown += u32::from(walked.iter().any(|&c| c > 0.1));
        }
    }
    // All but the smallest values and means with curves that begin above them.
    assert!(shown >= 10, "{shown} of 18 show something");
}

/// A lit maximum has the opacity of the plain one, and is brighter where its material faces the light.
#[test]
fn lit_maxima_are_shaded() {
    let loaded = Dataset::new(scenes::ball(32, DVec3::splat(15.5), 10.0));
    let mut renderer = new_renderer();
    let mut settings = look(RenderMode::Maximum, &curves()[0]);
    settings.camera = scenes::axis_camera(0.0, 0.0);
    let right = settings.camera.scene_from_view() * DVec3::new(3.0, 0.0, 1.0);
    settings.lights = vec![scenes::light(chiaroscuro_scene::LightGeometry::Parallel, right.into())];
    let plain = render(&mut renderer, &loaded, &settings, SIZE).linear;
    settings.mode.lit = true;
    let lit = render(&mut renderer, &loaded, &settings, SIZE).linear;
    assert!(plain.iter().zip(&lit).all(|(a, b)| (a[3] - b[3]).abs() < 1e-6));
    // Halfway to the edges of the ball, which is about a third of the picture wide.
    let at = |column: u32| lit[(SIZE[1] / 2 * SIZE[0] + column) as usize][1];
    let (left, right) = (at(SIZE[0] / 2 - 4), at(SIZE[0] / 2 + 4));
    assert!(right > 2.0 * left && left >= 0.0, "{left} on the left, {right} on the right");
}

#[test]
fn surfaces_are_steps_of_the_curve() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = look(RenderMode::Surface, &scenes::transfer());
    settings.mode.isovalue = Some(100.0);
    let surface = render(&mut renderer, &loaded, &settings, SIZE).linear;
    let material = settings.resolved_mode().into_owned();
    assert_eq!(render(&mut renderer, &loaded, &material, SIZE).linear, surface);
    // Opaque or clear, but for pixels that a surface grazes.
    let partial = surface.iter().filter(|texel| (0.05..0.95).contains(&texel[3])).count();
    let opaque = surface.iter().filter(|texel| texel[3] >= 0.95).count();
    assert!(opaque > 150 && partial * 8 < opaque, "{partial} of {opaque}");
}

/// Deliberate mistakes in the walk, each of which the comparison must notice.
#[test]
fn mistakes_in_projections_are_noticed() {
    let loaded = Dataset::new(random_voxels());
    let mistakes = [
        ("one plane in two", RenderMode::Mean, "planes + forward, meets", "planes + 2.0 * forward, meets"),
        (
            "a trapezium",
            RenderMode::Mean,
            "(densities.x + 4.0 * densities.y + densities.z) / 6.0",
            "0.5 * (densities.x + densities.z)",
        ),
        ("only planes", RenderMode::Maximum, "return select(end, top,", "return select(end, end,"),
        ("the other extreme", RenderMode::Minimum, "return -1.0;", "return 1.0;"),
        ("half a voxel aside", RenderMode::Maximum, "(inside + 1.5) * grid", "(inside + 1.0) * grid"),
        ("per unit of the scene", RenderMode::Maximum, "extinction * eye.shading.opacity_unit", "extinction"),
    ];
    for (name, kind, from, to) in mistakes {
        let settings = look(kind, &curves()[0]);
        let expected = plain_picture(loaded.volume(), &settings, |_| true);
        let actual = drawn(&mut damaged_renderer(from, to), &loaded, &settings);
        assert!(compare(name, &actual, &expected, PROJECTION).is_err(), "{name} is not noticed");
    }
}
