//! Robustness tests of the first look: single voxels and the number format must not matter.

use glam::DVec3;

use super::empty_look_fallback::{VisibleContent, visible_content};
use super::*;
use crate::TransferFunction;
use chiaroscuro_volume::{Samples, ValueRange};

const N: usize = 32;

/// Returns a soft ball of 900 in noise around 60, both with a ripple.
fn values() -> Vec<f64> {
    let mut state = 3u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let value = |at: usize| {
        let radius = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5)).length();
        (60.0 * noise() + 840.0 / (1.0 + (2.0 * (radius - 9.0)).exp()) + 40.0 * noise()).round()
    };
    (0..N * N * N).map(value).collect()
}

fn volume(values: &[f64]) -> Volume {
    Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::F64(values.to_vec())).unwrap()
}

fn look(volume: &Volume) -> Settings {
    first_settings(volume, &Histogram::from_volume(volume))
}

/// Returns the largest change of a control point as a share of the robust range, and asserts that the object is
/// visible.
fn largest_point_change(from: &Settings, volume: &Volume) -> f64 {
    let to = look(volume);
    assert_eq!(visible_content(&to, volume), VisibleContent::Object);
    assert_eq!(from.layer().transfer.points.len(), to.layer().transfer.points.len());
    let pairs = from.layer().transfer.points.iter().zip(&to.layer().transfer.points);
    let largest = pairs.map(|(a, b)| (a.value - b.value).abs()).fold(0.0, f64::max);
    largest / volume.ranges().robust.span()
}

#[test]
fn one_voxel_of_any_value_changes_nothing() {
    let values = values();
    let before = look(&volume(&values));
    let highest = values.iter().copied().fold(0.0, f64::max);
    for at in [0, 5 * N * N + 9 * N + 11, N * N * N / 2 + N / 2 * N + N / 2] {
        for odd in [1e30, -1e30, 30_000.0, -32_768.0, highest + 1.0, -1.0, 400.0, f64::NAN, f64::INFINITY] {
            let mut changed = values.clone();
            changed[at] = odd;
            let by = largest_point_change(&before, &volume(&changed));
            assert!(by <= 0.01, "{odd} at {at}: {by}");
        }
    }
}

#[test]
fn one_voxel_between_object_and_surroundings_is_neither() {
    // Only that voxel lies between 30 and 170.
    let value = |at: usize| {
        let radius = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 15.5)).length();
        (if radius < 9.0 { 170.0 } else { 0.0 }) + (at % 31) as f64
    };
    let values: Vec<f64> = (0..N * N * N).map(value).collect();
    let before = look(&volume(&values));
    for odd in [60.0, 100.0, 140.0] {
        let mut changed = values.clone();
        changed[77] = odd;
        let by = largest_point_change(&before, &volume(&changed));
        assert!(by <= 0.01, "{odd}: {by}");
    }
}

#[test]
fn a_border_of_the_lowest_value_hardly_matters() {
    let values = values();
    let before = look(&volume(&values));
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let wide = N + 8;
    for padding in [lowest, -32_768.0] {
        let padded: Vec<f64> = (0..wide * wide * wide)
            .map(|at| {
                let place = [at % wide, at / wide % wide, at / wide / wide].map(|c| c.wrapping_sub(4));
                let inside = place.iter().all(|&c| c < N);
                if inside { values[place[0] + N * (place[1] + N * place[2])] } else { padding }
            })
            .collect();
        let padded = Volume::with_spacing("t", [wide; 3], DVec3::ONE, Samples::F64(padded)).unwrap();
        let robust = padded.ranges().robust;
        assert!(robust.low > lowest - 0.1 * robust.span(), "{robust:?}");
        let function = look(&padded).layer().transfer.clone();
        // Noise in the corners is hidden, the ball is visible.
        assert!(
            function.opacity_at(50.0) < 0.01 && function.opacity_at(880.0) > 0.3,
            "{padding}: {function:?}"
        );
        let ends = |look: &TransferFunction| look.points.last().unwrap().value;
        assert!((ends(&function) - ends(&before.layer().transfer)).abs() <= 0.01 * robust.span());
    }
}

#[test]
fn scale_and_offset_change_nothing_in_relative_terms() {
    let values = values();
    let before = look(&volume(&values));
    for (scale, offset) in [(3.0, 0.0), (0.001, -5.0), (1e6, 1e9)] {
        let changed = volume(&values.iter().map(|value| value * scale + offset).collect::<Vec<_>>());
        let mut moved = before.clone();
        for point in &mut moved.layer_mut().transfer.points {
            point.value = point.value * scale + offset;
        }
        // Rounding may move a value to the next bin.
        let by = largest_point_change(&moved, &changed);
        assert!(by <= 0.002, "{scale} {offset}: {by}");
    }
}

#[test]
fn number_types_change_nothing() {
    let values = values();
    let before = look(&volume(&values));
    for samples in [
        Samples::U16(values.iter().map(|&value| value as u16).collect()),
        Samples::I16(values.iter().map(|&value| value as i16).collect()),
        Samples::U32(values.iter().map(|&value| value as u32).collect()),
        Samples::F32(values.iter().map(|&value| value as f32).collect()),
    ] {
        let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        assert!(largest_point_change(&before, &volume) < 1e-9);
    }
}

/// Returns half of the ball with a bar on it, which has no symmetry between axes.
fn lopsided(place: [f64; 3]) -> f64 {
    let [x, y, z] = place.map(|c| c - 15.5);
    let ball = if z > -3.0 { 9.0 - DVec3::new(x, y, z).length() } else { z + 3.0 };
    let bar = (2.5 - DVec3::new(0.0, y - 3.0, z - 4.0).length()).min(13.0 - x.abs()).min(x);
    860.0 / (1.0 + (-2.0 * ball.max(bar)).exp()) + 40.0
}

/// Stores the lopsided shape with permuted and mirrored index axes.
fn with_permuted_axes(axes: [usize; 3], turned: [bool; 3]) -> Volume {
    let value = |at: usize| {
        let stored = [at % N, at / N % N, at / N / N];
        let mut place = [0.0; 3];
        for along in 0..3 {
            let c = stored[along] as f64;
            place[axes[along]] = if turned[along] { (N - 1) as f64 - c } else { c };
        }
        lopsided(place)
    };
    let direction =
        |along: usize| if turned[along] { -DVec3::AXES[axes[along]] } else { DVec3::AXES[axes[along]] };
    let matrix3 = glam::DMat3::from_cols(direction(0), direction(1), direction(2));
    let begins =
        |along: usize| if turned[along] { DVec3::AXES[axes[along]] * (N - 1) as f64 } else { DVec3::ZERO };
    let geometry = glam::DAffine3 { matrix3, translation: begins(0) + begins(1) + begins(2) };
    let values = (0..N * N * N).map(value).collect();
    Volume::new("t", [N; 3], geometry, Samples::F64(values)).unwrap()
}

/// Returns the larger distance between the cameras' positions or targets, relative to the camera distance.
fn camera_shift(a: &Settings, b: &Settings) -> f64 {
    let target = |look: &Settings| DVec3::from(look.camera.target);
    let by = a.camera.position().distance(b.camera.position()).max(target(a).distance(target(b)));
    by / a.camera.distance
}

#[test]
fn how_axes_are_stored_changes_nothing() {
    let before = look(&with_permuted_axes([0, 1, 2], [false; 3]));
    for (axes, turned) in [
        ([0, 1, 2], [true, false, false]),
        ([0, 1, 2], [true, true, true]),
        ([1, 2, 0], [false; 3]),
        ([2, 1, 0], [false, true, false]),
    ] {
        let stored = with_permuted_axes(axes, turned);
        let by = largest_point_change(&before, &stored);
        assert!(by < 1e-9, "{axes:?} {turned:?}: {by}");
        // Cells of objects have different boundaries.
        let by = camera_shift(&before, &look(&stored));
        assert!(by < 0.02, "{axes:?} {turned:?}: {by}");
    }
}

#[test]
fn half_the_resolution_is_the_same_thing() {
    // Twice as fine, so that half of it is the resolution of the other tests.
    let (fine, per_voxel) = (2 * N, 0.5);
    let place = |c: usize| (c as f64 + 0.5) * per_voxel - 0.5;
    let value = |at: usize| lopsided([at % fine, at / fine % fine, at / fine / fine].map(place));
    let samples = Samples::F64((0..fine * fine * fine).map(value).collect());
    let whole = Volume::with_spacing("t", [fine; 3], DVec3::splat(per_voxel), samples).unwrap();
    let half = whole.to_block_averaged([2; 3]).unwrap();
    let before = look(&whole);
    // Its edge is a voxel wide, and half as steep in blocks: curves may begin anywhere in it, …
    let by = largest_point_change(&before, &half);
    assert!(by < 0.15, "{by}");
    // … and show the same object.
    let seen = |volume: &Volume| {
        let object = VisibleObject::from_visible(&look(volume), volume);
        object.occupied_cells().count() as f64 / volume.voxel_count() as f64
    };
    assert!((seen(&half) / seen(&whole) - 1.0).abs() < 0.15, "{} {}", seen(&half), seen(&whole));
    // Blocks at the object's surface are half full, so its extent differs by up to a block of 32.
    let by = camera_shift(&before, &look(&half));
    assert!(by < 0.15, "{by}");
}

#[test]
fn it_does_not_matter_whether_air_is_missing() {
    let values = values();
    let missing: Vec<f64> =
        values.iter().map(|&value| if value < 110.0 { f64::NAN } else { value }).collect();
    let seen = |values: &[f64]| {
        let volume = volume(values);
        let look = look(&volume);
        assert_eq!(visible_content(&look, &volume), VisibleContent::Object);
        (VisibleObject::from_visible(&look, &volume).occupied_cells().count() as f64, look)
    };
    let ((whole, before), (without_air, after)) = (seen(&values), seen(&missing));
    // Only the ball is left, with its soft edge, of which half may be visible.
    assert!((0.8..1.3).contains(&(without_air / whole)), "{whole} {without_air}");
    assert!(camera_shift(&before, &after) < 0.1);
}

#[test]
fn sixteen_bits_are_spent_on_the_values_that_matter() {
    let mut values = values();
    values[0] = -32_768.0;
    values[1] = 32_767.0;
    let samples = Samples::I16(values.iter().map(|&value| value as i16).collect());
    let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
    let steps = |volume: &Volume| (volume.density_of(501.0) - volume.density_of(500.0)) * 65535.0;
    assert!(steps(&volume) > 50.0, "{}", steps(&volume));
    assert!(steps(&volume.with_density_mapping(volume.value_range())) < 1.01);
    let seen = Histogram::from_volume(&volume).counts.iter().filter(|&&count| count > 0).count();
    assert!(seen > 700, "{seen}");
}

#[test]
fn a_typed_range_has_densities_zero_and_one_at_its_ends() {
    let volume = volume(&values());
    for (low, high) in [(-100.0, 300.0), (0.1, 0.3), (123.4, 1e6)] {
        let shown = volume.with_density_mapping(ValueRange::new(low, high));
        assert_eq!((shown.density_of(low), shown.density_of(high)), (0.0, 1.0));
        assert_eq!((shown.density_of(low - 1.0), shown.density_of(high + 1.0)), (0.0, 1.0));
        assert_eq!((shown.value(3, 4, 5), shown.content_id()), (volume.value(3, 4, 5), volume.content_id()));
    }
}

#[test]
fn no_picture_is_empty() {
    let constant = vec![7.0; N * N * N];
    let mut outlier = constant.clone();
    outlier[500] = 1e30;
    let mut mask: Vec<f64> = (0..N * N * N).map(|at| f64::from(u8::from(at / N / N > 20))).collect();
    mask[3] = 1e30;
    for (what, values) in [("constant", constant), ("outlier", outlier), ("mask", mask)] {
        let volume = volume(&values);
        assert_ne!(visible_content(&look(&volume), &volume), VisibleContent::Nothing, "{what}");
        let blind = Settings::default().with_transfer(TransferFunction::default());
        let mut helped = with_visible_transfer(&blind, &volume);
        choose_view_and_lights(&mut helped, &volume);
        assert_ne!(visible_content(&helped, &volume), VisibleContent::Nothing, "{what}");
    }
    let volume = volume(&values());
    let mut helped = with_visible_transfer(&Settings::default(), &volume);
    choose_view_and_lights(&mut helped, &volume);
    let visible =
        VisibleObject::from_visible(&helped, &volume).occupied_cells().count() as f64 / (N * N * N) as f64;
    assert!((0.02..=0.06).contains(&visible), "{visible}");
}
