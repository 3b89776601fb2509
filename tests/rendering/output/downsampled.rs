//! Downsampled volumes look like the full-resolution ones.

use chiaroscuro_render::{downsample_to_fit, mean_luminance};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::{Histogram, Volume};
use glam::DVec3;

use crate::common::{Dataset, context, new_renderer, render};
use crate::compare::{channels_f32, difference};
use crate::scenes;
use crate::thresholds::{AVERAGED, AVERAGED_MEAN};

const SIZE: [u32; 2] = [96, 72];

/// Test look with the automatic opacity unit, which depends on the number of voxels. Without near-field rays, by
/// which softer surfaces shade themselves more: with full rays the mean is 4 % less.
fn look(volume: &Volume) -> Settings {
    let first = first_look::first_settings(volume, &Histogram::from_volume(volume));
    let mut settings = scenes::look().with_opacity_unit(first.layer().opacity_unit);
    scenes::use_paper_shadows(&mut settings);
    settings
}

#[test]
fn averaged_voxels_look_like_those_that_they_stand_for() {
    let whole = scenes::creature(64, DVec3::new(1.0, 0.8, 1.6));
    let half = whole.clone().block_averaged([2; 3]).expect("a volume");
    assert_eq!(half.dims(), [32; 3]);
    let mut renderer = new_renderer();
    let mut picture = |volume: &Volume, settings: &Settings| {
        render(&mut renderer, &Dataset::new(volume.clone()), settings, SIZE)
    };
    let (before, after) = (picture(&whole, &look(&whole)), picture(&half, &look(&half)));
    let far = difference(&channels_f32(&after.linear), &channels_f32(&before.linear)).rmse;
    let mean = mean_luminance(&after.linear) / mean_luminance(&before.linear);
    println!("rmse {:.2}/255, mean {mean:.3}", far * 255.0);
    assert!(far < AVERAGED && (mean - 1.0).abs() < AVERAGED_MEAN, "{far} {mean}");
    // Guards the comparison: an opacity unit of the file is detected.
    let wrong = picture(&half, &look(&whole));
    let mean = mean_luminance(&wrong.linear) / mean_luminance(&before.linear);
    println!("with a unit of the averaged voxels: mean {mean:.3}");
    assert!((mean - 1.0).abs() > AVERAGED_MEAN, "{mean}");
}

#[test]
fn what_the_adapter_can_hold_stays_whole() {
    let whole = scenes::creature(24, DVec3::ONE);
    let id = whole.content_id();
    let shown = downsample_to_fit(&context(), whole).expect("it fits");
    assert_eq!((shown.content_id(), shown.dims()), (id, shown.file_dims()));
}
