//! Narrow peaks of transfer functions, which slabs by need must not skip.

use chiaroscuro_render::mean_luminance;
use chiaroscuro_scene::{Camera, ControlPoint, OpacityInterpolation, SlabMode, TransferFunction};
use glam::DVec3;

use crate::common::{Dataset, new_renderer, render};
use crate::compare::{channels_f32, compare, to_f64};
use crate::scenes;
use crate::thresholds::{PEAK, PEAK_MEAN};

/// Shell that is a tenth of a voxel thick, in a ball with a soft edge: one sample per voxel misses most of it.
#[test]
fn a_thin_shell_is_seen_whole() {
    let loaded = Dataset::new(scenes::ball(48, DVec3::splat(23.5), 16.0));
    let mut renderer = new_renderer();
    let mut settings = scenes::look();
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    settings.layer_mut().transfer = TransferFunction {
        points: vec![
            point(0.0, 0.0),
            point(120.0, 0.0),
            point(126.0, 0.9),
            point(132.0, 0.0),
            point(255.0, 0.0),
        ],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    };
    settings.camera = Camera { distance: 3.0, ..settings.camera };
    let mut picture = |slabs, slab, share| {
        (settings.sampling.slabs, settings.sampling.slab) = (slabs, slab);
        settings.sampling.max_undivided_share = share;
        render(&mut renderer, &loaded, &settings, [96, 96]).linear
    };
    // Slabs of a sixteenth of a voxel: middles of a quarter hit or miss the shell.
    let (thin, needed) = (picture(SlabMode::ByNeed, 0.25, 0.0), picture(SlabMode::ByNeed, 1.0, 0.125));
    let coarse = picture(SlabMode::Even, 1.0, 0.125);
    let [thin_mean, needed_mean, coarse_mean] = [&thin, &needed, &coarse].map(|light| mean_luminance(light));
    println!("mean of thin slabs {thin_mean:.4}, by need {needed_mean:.4}, of thick ones {coarse_mean:.4}");
    assert!((coarse_mean / thin_mean - 1.0).abs() > 2.0 * PEAK_MEAN, "thick slabs miss it");
    assert!((needed_mean / thin_mean - 1.0).abs() <= PEAK_MEAN, "{needed_mean} not {thin_mean}");
    compare("a thin shell", &channels_f32(&needed), &to_f64(&thin.concat()), PEAK)
        .unwrap_or_else(|err| panic!("{err}"));
}
