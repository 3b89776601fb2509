//! Tests of proposed looks: lights found after the first picture, light positions, and whole looks.

use std::time::{Duration, Instant};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_render::{LightSearch, SearchedLight, UndecidedPart, complete_first_look, first_look};
use chiaroscuro_scene::Settings;
use eframe::egui::accesskit::Toggled;
use eframe::egui::{self, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{
    SCENE, WAIT_TIMEOUT, adjusted_window, automatic_window, click, second_renderer, wait_until,
    wait_until_idle, window,
};

/// Waits for a picture of a contact sheet.
fn wait_for(harness: &mut Harness<'_, App>, label: &str) {
    let begin = Instant::now();
    while harness.query_by_label(label).is_none() {
        assert!(begin.elapsed() < WAIT_TIMEOUT, "no {label}: {:?}", harness.state().errors());
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    // The window grows around the pictures.
    harness.run_steps(5);
}

#[test]
fn the_light_search_is_not_an_undo_step() {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    let mut harness = automatic_window(options);
    wait_until_idle(&mut harness);
    let (dataset, mut renderer) = second_renderer();
    let first = first_look(&mut renderer, &dataset).expect("a first look");
    let search =
        LightSearch::new(renderer.shaders(), &dataset, &first, SearchedLight::KeyAndRim).expect("a search");
    let found = search.run().expect("a search").expect("something is seen");
    let Settings { lights, floor, .. } = found.apply(&first);
    let shown = harness.state().settings().clone();
    assert_eq!((&shown.lights, &shown.floor), (&lights, &floor), "what the search finds by itself");
    // The command line waits for the search and arrives at the same look; its brightness is measured with all voxels.
    let open = [UndecidedPart::Lights, UndecidedPart::Floor, UndecidedPart::Balance, UndecidedPart::Exposure];
    let waited = complete_first_look(&mut renderer, &dataset, &first, &open).expect("a look");
    assert_eq!((&waited.lights, &waited.floor), (&lights, &floor));
    let apart = |a: f64, b: f64| (a / b - 1.0).abs();
    assert!(apart(waited.output.exposure, shown.output.exposure) < 0.1, "{shown:?}");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().settings(), &shown, "there is nothing to undo");
}

#[test]
fn lights_that_are_found_stay_when_a_turn_is_undone() {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    let mut harness = automatic_window(options);
    wait_until(&mut harness, "never opened", |app| app.volume_name().is_some());
    let first = harness.state().settings().clone();
    // Lights are searched for while the camera is turned: an undo step of its own.
    harness.key_press(egui::Key::Num3);
    wait_until(&mut harness, "never turned", |app| app.settings().camera != first.camera);
    let turned = harness.state().settings().camera.clone();
    assert_ne!(turned, first.camera);
    wait_until_idle(&mut harness);
    harness.run_steps(10);
    let found = harness.state().settings().clone();
    assert_eq!(found.camera, turned);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    let back = harness.state().settings().clone();
    assert_eq!(back.camera, first.camera, "the view goes back");
    assert_eq!((&back.lights, &back.floor), (&found.lights, &found.floor), "and the lights stay");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings(), &back, "there is nothing more to undo");
}

#[test]
fn lights_are_suggested() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    click(&mut harness, "Suggest…");
    wait_for(&mut harness, "Refresh");
    assert_eq!(harness.state().settings(), &before, "trying changes nothing");
    assert!(harness.query_by_label("Use As it is").is_some(), "what they are compared with");
    click(&mut harness, "Use Key, suggestion 2");
    let after = harness.state().settings().clone();
    assert_ne!(after.lights[0].position, before.lights[0].position);
    assert_eq!(after.lights[1..], before.lights[1..], "the others stay");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings(), &before);
    wait_until_idle(&mut harness);
}

#[test]
fn looks_are_tried_on_the_volume() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    harness.key_press(egui::Key::V);
    harness.run_steps(3);
    wait_for(&mut harness, "Use 1 · First look");
    // The other looks follow one by one.
    wait_for(&mut harness, "Refresh");
    let count = harness.query_all_by_label_contains("Use ").count();
    assert!([12, 14].contains(&count), "{count} looks");
    assert_eq!(harness.state().settings(), &before, "trying changes nothing");
    harness.query_all_by_label_contains("Rim light").next().expect("a look").click();
    harness.run_steps(3);
    let after = harness.state().settings().clone();
    assert_eq!(after.lights[0].name, "Rim left");
    assert_eq!(after.kept, before.kept);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings(), &before, "one key goes back");
    wait_until_idle(&mut harness);
}

#[test]
fn looks_that_were_tried_are_forgotten_with_their_volume() {
    let mut harness = window();
    // Like the repeats of a held key.
    for _ in 0..8 {
        harness.key_press(egui::Key::V);
        harness.step();
    }
    wait_for(&mut harness, "Use 1 · First look");
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:sphere:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("sphere") && app.is_idle());
    assert_eq!(harness.query_all_by_label_contains("Use 1").count(), 0, "it was of the volume before");
}

/// Small CT: a ball of bone in a ball of water, in air.
fn write_ct(folder: &std::path::Path) -> std::path::PathBuf {
    let mut file =
        "NRRD0004\ntype: int16\ndimension: 3\nsizes: 24 24 24\nspacings: 4 4 4\nendian: little\nencoding: raw\nsample units: \"HU\"\n\n".as_bytes().to_vec();
    for at in 0..24_i32.pow(3) {
        let away = [at % 24, at / 24 % 24, at / 576].map(|place| f64::from(place) - 11.5);
        let radius = away.iter().map(|x| x * x).sum::<f64>().sqrt();
        let value: i16 = if radius < 4.0 {
            900
        } else if radius < 9.0 {
            40
        } else {
            -1000
        };
        file.extend(value.to_le_bytes());
    }
    let path = folder.join("ct.nrrd");
    std::fs::write(&path, file).expect("a file");
    path
}

/// CT looks are offered over the picture of a CT, and over no other, until the user closes the offer.
#[test]
fn looks_of_a_ct_are_offered_over_its_picture() {
    assert!(window().query_by_label("Lung").is_none());
    let folder = tempfile::tempdir().expect("a folder");
    let options = WindowOptions { source: Some(write_ct(folder.path())), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, vec2(760.0, 1140.0));
    let before = harness.state().settings().clone();
    click(&mut harness, "Muscle and skin");
    wait_until_idle(&mut harness);
    let bone = harness.state().settings().clone();
    assert_ne!(bone.layer().transfer, before.layer().transfer);
    assert_eq!(bone.camera, before.camera);
    harness.run_steps(3);
    let is_marked = |harness: &Harness<'_, App>, title: &str| {
        harness.get_by_label(title).accesskit_node().toggled() == Some(Toggled::True)
    };
    assert!(is_marked(&harness, "Muscle and skin") && !is_marked(&harness, "Bone"), "the one in use");
    click(&mut harness, "Close this row; presets stay in the editor");
    assert!(harness.query_by_label("Muscle and skin").is_none());
    wait_until_idle(&mut harness);
}

/// The table under a body is hidden by one click over the picture, where there is room for the button.
#[test]
fn the_table_is_hidden_over_the_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = WindowOptions { source: Some(write_ct(folder.path())), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, vec2(1300.0, 900.0));
    for is_hidden in [true, false] {
        click(&mut harness, "Without table");
        wait_until_idle(&mut harness);
        assert_eq!(harness.state().settings().volume.hidden_table.is_some(), is_hidden);
    }
}
