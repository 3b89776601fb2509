//! Tests of the up axis on synthetic objects that stand, and on their neighbours that show no evidence.

use glam::{DVec2, DVec3};

use crate::SceneAxis;
use crate::first_look::{FirstLookOptions, first_settings, first_settings_with};
use chiaroscuro_volume::{Histogram, Samples, Volume};

const N: usize = 40;

/// Returns a volume of values at places relative to the centre, in units of voxels, with a grain.
fn volume(value: impl Fn(DVec3) -> f64) -> Volume {
    let value = |at: usize| {
        let value = value(DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 19.5)));
        let grain = (at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        (value + value / 20.0 * grain as f64 / f64::from(1 << 24)) as f32
    };
    let samples = Samples::F32((0..N * N * N).map(value).collect());
    Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap()
}

fn up(volume: &Volume) -> SceneAxis {
    first_settings(volume, &Histogram::from_volume(volume)).camera.up
}

/// Asserts that an object is turned if it stands on its head, and only then.
fn assert_stands(name: &str, value: impl Fn(DVec3) -> f64) {
    assert_eq!(up(&volume(&value)), SceneAxis::PlusZ, "{name} as it stands");
    let turned = volume(|p| value(DVec3::new(p.x, -p.y, -p.z)));
    assert_eq!(up(&turned), SceneAxis::MinusZ, "{name} on its head");
}

/// Asserts that an object stays as it is, either way up.
fn assert_stays(name: &str, value: impl Fn(DVec3) -> f64) {
    assert_eq!(up(&volume(&value)), SceneAxis::PlusZ, "{name}");
    assert_eq!(up(&volume(|p| value(DVec3::new(p.x, -p.y, -p.z)))), SceneAxis::PlusZ, "{name} turned");
}

fn solid(is_there: bool) -> f64 {
    if is_there { 190.0 } else { 0.0 }
}

fn bust(p: DVec3) -> f64 {
    let is_head = (p - DVec3::Z * 4.0).length() < 12.0;
    solid(is_head || p.z < 0.0 && p.truncate().length() < 8.0)
}

#[test]
fn cut_ends_go_down() {
    assert_stands("bust", bust);
    assert_stands("rod", |p| solid(p.z < 5.0 && p.truncate().length() < 7.0));
    // A base wider than what stands on it.
    assert_stands("bell", |p| solid(p.z < 12.0 && p.truncate().length() < 14.0 - 0.4 * p.z));
    // A little of the other end may touch the face.
    assert_stands("bust with a hair", |p| if p.truncate().length() < 1.5 { 190.0 } else { bust(p) });
}

#[test]
fn without_strong_evidence_nothing_is_turned() {
    assert_stays("ball", |p| solid(p.length() < 12.0));
    assert_stays("column", |p| solid(p.truncate().length() < 8.0));
    // Both ends are cut, one less than the other.
    assert_stays("cone", |p| solid(p.truncate().length() < 12.0 - 0.3 * p.z));
    assert_stays("block", |p| solid(p.abs().max_element() < 12.0));
    // A piece of something larger.
    assert_stays("corner", |p| solid(p.z < 3.0 && p.x < 3.0));
    // It only touches the face.
    assert_stays("ball on the face", |p| solid((p + DVec3::Z * 7.5).length() < 12.0));
    // Legs of a table, and a mushroom.
    let is_leg = |p: DVec3| p.x.abs() > 8.0 && p.y.abs() > 8.0;
    assert_stays("table", |p| solid(p.abs().max_element() < 12.0 && (p.z > 4.0 || is_leg(p))));
    assert_stays("mushroom", |p| {
        let is_cap = p.z > 0.0 && p.length() < 14.0;
        solid(is_cap || (-14.0..1.0).contains(&p.z) && p.truncate().length() < 4.0)
    });
    // Rods side by side, and a net.
    assert_stays("pieces", |p| solid(p.z < 5.0 && DVec2::new(p.x.abs() - 10.0, p.y).length() < 6.0));
    let is_net = |p: DVec3| p.to_array().iter().filter(|c| c.rem_euclid(8.0) < 1.0).count() > 1;
    assert_stays("net", |p| solid(p.z < 5.0 && p.truncate().length() < 15.0 && is_net(p)));
}

#[test]
fn cones_do_not_stand_on_their_tips() {
    assert_stands("cone", |p| {
        let from_tip = 14.0 - p.z;
        solid((0.0..28.0).contains(&from_tip) && p.truncate().length() < 0.5 + 0.45 * from_tip)
    });
}

#[test]
fn of_two_cut_ends_the_braincase_goes_up() {
    // A head of soft tissue within skin, and a neck with a spine, cut off within both.
    let head = |p: DVec3| {
        let radius = p.truncate().length();
        let is_head = p.z > -2.0;
        match radius {
            r if is_head && (10.5..13.0).contains(&r) => 210.0,
            r if is_head && r < 15.0 => 90.0,
            r if !is_head && r < 3.5 => 210.0,
            r if !is_head && r < 10.0 => 90.0,
            _ => 0.0,
        }
    };
    assert_stands("head", head);
    // A tube is closed at both ends.
    assert_stays("tube", |p| head(DVec3::new(p.x, p.y, 1.0)));
}

#[test]
fn files_and_wishes_are_obeyed() {
    let turned = volume(|p| bust(DVec3::new(p.x, -p.y, -p.z)));
    assert_eq!(up(&turned), SceneAxis::MinusZ);
    assert_eq!(up(&turned.clone().with_anatomical_axes(true)), SceneAxis::PlusZ);
    for axis in SceneAxis::ALL {
        let wishes = FirstLookOptions { up: Some(axis), ..FirstLookOptions::default() };
        let look = first_settings_with(&turned, &Histogram::from_volume(&turned), wishes);
        assert_eq!(look.camera.up, axis);
    }
    // Nothing is mirrored, and the object stands below the camera's horizon.
    let look = first_settings(&turned, &Histogram::from_volume(&turned));
    assert!((look.camera.scene_from_view().determinant() - 1.0).abs() < 1e-9);
    assert!(look.lights.iter().all(|light| light.position[2] < 0.0), "they are above it");
}

#[test]
fn fields_have_no_upper_end() {
    // A hill that goes on beyond the upper face.
    let hill = |p: DVec3| {
        let away = p - DVec3::Z * 19.5;
        250.0 * (-away.length_squared() / 300.0).exp()
    };
    assert_stays("hill", hill);
}
