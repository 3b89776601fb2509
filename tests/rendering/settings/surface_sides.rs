//! Sides of surfaces: they face towards falling opacity, whichever way density runs.

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    Camera, ControlPoint, LightSettings, LitSides, OpacityInterpolation, OpacityLength, Settings,
    TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use crate::common::{Dataset, full_precision_renderer, render};
use crate::compare::{channels_f32, compare, to_f64};
use crate::scenes::{self, axis_camera};
use crate::thresholds::MIRRORED;

const N: usize = 32;

fn renderer() -> Renderer {
    full_precision_renderer()
}

fn curve(points: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, opacity): &(f64, f64)| ControlPoint::new(value, [0.9, 0.7, 0.5], opacity);
    TransferFunction {
        points: points.iter().map(point).collect(),
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    }
}

fn look(transfer: TransferFunction) -> Settings {
    scenes::look().with_transfer(transfer).with_opacity_unit(OpacityLength::Voxels(1.0))
}

/// Two balls of which one is the negative of the other, in a medium halfway between; values 0 … 255.
fn lobes_volume(turned: bool) -> Volume {
    let ball = |p: DVec3, centre: DVec3| (7.0 - p.distance(centre) + 0.5).clamp(0.0, 1.0);
    let values = (0..N * N * N)
        .map(|at| {
            let p = DVec3::new((at % N) as f64, (at / N % N) as f64, (at / N / N) as f64);
            let sum = ball(p, DVec3::new(9.0, 14.0, 20.0)) - ball(p, DVec3::new(22.0, 17.0, 11.0));
            let sum = if turned { -sum } else { sum };
            128.0 + 120.0 * sum as f32
        })
        .collect();
    let mut values: Vec<f32> = values;
    // The whole range, in voxels far from everything visible, so that the middle is the same both ways.
    values[0] = 0.0;
    values[N - 1] = 256.0;
    Volume::with_spacing("lobes", [N; 3], DVec3::ONE, Samples::F32(values)).expect("a volume")
}

/// Both lobes of ±f under a curve that shows either: exchanged, they give the same picture.
#[test]
fn lobes_of_either_sign_look_the_same() {
    let both = curve(&[(20.0, 0.6), (100.0, 0.0), (156.0, 0.0), (236.0, 0.6)]);
    let mut renderer = renderer();
    let mut picture = |turned: bool, sides: LitSides| {
        let mut settings = look(both.clone());
        settings.shading.sides = sides;
        // Away from the border, where the medium ends.
        settings.cuts.crop.on = true;
        settings.cuts.crop.low = [0.1; 3];
        settings.cuts.crop.high = [0.9; 3];
        render(&mut renderer, &Dataset::new(lobes_volume(turned)), &settings, [96, 96])
    };
    let (found, turned) = (picture(false, LitSides::One), picture(true, LitSides::One));
    compare("lobes", &channels_f32(&found.linear), &to_f64(&turned.linear.concat()), MIRRORED)
        .unwrap_or_else(|err| panic!("{err}"));
    // Guards the comparison: lit from both sides, highlights lie where density falls, on one of the lobes only.
    let (found, turned) = (picture(false, LitSides::Two), picture(true, LitSides::Two));
    assert!(
        compare("both sides", &channels_f32(&found.linear), &to_f64(&turned.linear.concat()), MIRRORED)
            .is_err()
    );
}

/// A ball under a falling curve is lit where it faces the light, and dark behind.
#[test]
fn holes_in_the_data_are_lit_from_outside() {
    let values = (0..N * N * N)
        .map(|at| {
            let p = DVec3::new((at % N) as f64, (at / N % N) as f64, (at / N / N) as f64);
            255.0 * (p.distance(DVec3::splat(15.5)) - 10.0 + 0.5).clamp(0.0, 1.0) as f32
        })
        .collect();
    let volume = Volume::with_spacing("hole", [N; 3], DVec3::ONE, Samples::F32(values)).expect("a volume");
    let loaded = Dataset::new(volume);
    let mut settings = look(curve(&[(40.0, 0.9), (160.0, 0.0), (255.0, 0.0)]));
    settings.camera = Camera { distance: 3.0, ..axis_camera(-90.0, 0.0) };
    settings.lights = vec![LightSettings { position: [1.0, 0.0, 0.0], ..LightSettings::default() }];
    settings.shading.ambient = 0.0;
    settings.shading.specular = 0.0;
    settings.cuts.crop.on = true;
    settings.cuts.crop.low = [0.1; 3];
    settings.cuts.crop.high = [0.9; 3];
    let picture = render(&mut renderer(), &loaded, &settings, [64, 64]);
    let row: Vec<f32> = (0..64).map(|x| picture.linear[32 * 64 + x][1]).collect();
    let seen: Vec<usize> = (0..64).filter(|&x| picture.linear[32 * 64 + x][3] > 0.9).collect();
    let (first, last) = (seen[0], seen[seen.len() - 1]);
    let quarter = (last - first) / 4;
    assert!(
        row[last - quarter] > 10.0 * row[first + quarter],
        "lit {} dark {}",
        row[last - quarter],
        row[first + quarter]
    );
}
