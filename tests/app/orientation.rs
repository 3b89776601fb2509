//! Tests of the object's orientation: turned by a key, after a reset, and in the next file of the folder.

use std::path::{Path, PathBuf};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{Camera, SceneAxis, Settings};
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{SCENE, adjusted_window, click, wait_until, wait_until_idle};

fn settings(harness: &Harness<'_, App>) -> Settings {
    harness.state().settings().clone()
}

fn press(harness: &mut Harness<'_, App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
    wait_until_turned(harness);
}

/// Waits for the turn, whose framing is computed on another thread.
fn wait_until_turned(harness: &mut Harness<'_, App>) {
    wait_until(harness, "never turned", |app| !app.is_making_look());
    harness.run_steps(3);
}

/// Fails if two views differ by more than rounding; angles may differ by full turns.
fn assert_same_view(a: &Camera, b: &Camera) {
    let views = [a, b].map(Camera::scene_from_view);
    assert_eq!(a.up, b.up);
    assert!((0..3).all(|axis| (views[0].col(axis) - views[1].col(axis)).length() < 1e-9), "{a:?} and {b:?}");
    assert!((a.position() - b.position()).length() < 1e-6, "{a:?} and {b:?}");
}

/// Writes a slab that is long in x, shorter in y and thin in z, surrounded by zeros.
fn write_slab(path: &Path) {
    let value = |at: usize| {
        let [x, y, z] = [at % 24, at / 24 % 24, at / 576];
        u8::from((2..22).contains(&x) && (6..18).contains(&y) && (10..14).contains(&z)) * 200
    };
    std::fs::write(path, (0..24 * 24 * 24).map(value).collect::<Vec<_>>()).expect("written");
}

#[test]
fn the_object_lies_down_stands_up_and_stays_so() {
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let [first, second] = ["a", "b"].map(|name| folder.path().join(format!("{name}_24x24x24_uint8.raw")));
    write_slab(&first);
    write_slab(&second);
    let start = |source: PathBuf| {
        let (source, storage) = (Some(source), Some(storage.path().to_owned()));
        adjusted_window(
            WindowOptions { source, storage, ..WindowOptions::default() },
            Vec2::new(760.0, 1140.0),
        )
    };
    let mut harness = start(first);
    let flat = settings(&harness);
    assert_eq!(flat.camera.up, SceneAxis::PlusZ);
    let fills = harness.state().light_rebuilds();
    press(&mut harness, Modifiers::NONE, Key::T);
    let on_end = settings(&harness);
    assert_ne!(on_end.camera.up, SceneAxis::PlusZ);
    assert!(on_end.floor.height < flat.floor.height - 0.2, "it is taller now: {}", on_end.floor.height);
    assert_eq!(
        (&on_end.cuts, &on_end.layer().transfer),
        (&flat.cuts, &flat.layer().transfer),
        "the data stay"
    );
    assert_ne!(on_end.lights[0].position, flat.lights[0].position, "lights stay with the viewer");
    wait_until_idle(&mut harness);
    assert!(harness.state().light_rebuilds() > fills, "and shine on another side");

    // The chosen orientation survives a reset of the view; undo reverts it.
    press(&mut harness, Modifiers::SHIFT, Key::T);
    let round = settings(&harness);
    assert_eq!((round.camera.up, &round.lights), (on_end.camera.up, &on_end.lights));
    assert!(((round.camera.azimuth_deg - on_end.camera.azimuth_deg).rem_euclid(360.0) - 270.0).abs() < 1e-9);
    press(&mut harness, Modifiers::NONE, Key::R);
    assert_eq!(settings(&harness), on_end);
    harness.run_steps(8);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&harness), flat);
    press(&mut harness, Modifiers::NONE, Key::R);
    assert_same_view(&settings(&harness).camera, &flat.camera);
    // Turns queue up, however quickly they follow each other.
    for _ in 0..4 {
        harness.key_press(Key::T);
        harness.step();
    }
    wait_until_turned(&mut harness);
    let again = settings(&harness);
    assert_same_view(&again.camera, &flat.camera);
    assert_eq!(again.floor.height, flat.floor.height);
    // A kept view of the object in another orientation: its lights turn as well.
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Num4);
    harness.run_steps(3);
    let kept = settings(&harness);
    press(&mut harness, Modifiers::NONE, Key::T);
    assert_ne!(settings(&harness).lights, kept.lights);
    press(&mut harness, Modifiers::COMMAND, Key::Num4);
    assert_eq!(settings(&harness), kept);
    press(&mut harness, Modifiers::NONE, Key::T);

    // The next file of the folder takes this orientation, also after a restart; other volumes do not.
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&second, &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("b") && app.is_idle());
    assert_eq!(settings(&harness).camera.up, on_end.camera.up);
    assert!((settings(&harness).floor.height - on_end.floor.height).abs() < 1e-9);
    harness.state_mut().open(SCENE, &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair") && app.is_idle());
    assert_eq!(settings(&harness).camera.up, SceneAxis::PlusZ);
    drop(harness);
    let mut harness = start(second);
    assert_eq!(settings(&harness).camera.up, on_end.camera.up);
    // The panel has an equivalent control. Its section may begin below the window's edge.
    harness.get_by_label("Camera").scroll_to_me();
    harness.run_steps(10);
    click(&mut harness, "Camera");
    harness.run_steps(10);
    click(&mut harness, "−z");
    wait_until_turned(&mut harness);
    assert_eq!(settings(&harness).camera.up, SceneAxis::MinusZ);
    assert!(harness.query_by_label("Tilt by 90°").is_none(), "the menu is closed");
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
}
