//! Tests of the start screen: built-in scenes and recent files in a window without a volume.

use std::sync::Arc;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{PRESETS, Settings};
use eframe::egui::{self, Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{DroppedFile, SCENE, click, sharp_window_with, wait_until};

/// Creates a window of a usual size without a file argument; `storage` is its folder for state.
pub(crate) fn start_window(storage: Option<&std::path::Path>) -> Harness<'static, App> {
    // Scenes have the light of their presets.
    let adjust = |mut settings: Settings| {
        settings.shadows.keep_balanced = false;
        settings
    };
    let options = WindowOptions {
        storage: storage.map(Into::into),
        adjust: Some(Box::new(adjust)),
        ..WindowOptions::default()
    };
    let mut harness = sharp_window_with(options, Vec2::new(1100.0, 760.0));
    harness.run_steps(10);
    harness
}

/// Card of a scene, whose label begins with its title.
fn card<'a>(harness: &'a Harness<'_, App>, title: &'a str) -> egui_kittest::Node<'a> {
    harness.get_by_label_contains(title)
}

/// Returns true if a volume is open in place of the start screen; its picture may still be rendered.
fn is_open(app: &App, name: &str) -> bool {
    app.volume_name() == Some(name) && !app.shows_start()
}

#[test]
fn a_window_without_a_file_shows_scenes_and_generates_none() {
    let harness = start_window(None);
    assert!(harness.state().shows_start());
    assert_eq!(harness.state().volume_name(), None);
    assert!(harness.state().viewport_rect().is_none(), "there is no picture");
    let scenes: Vec<_> = PRESETS.into_iter().filter(|preset| preset.scene_volume().is_some()).collect();
    assert_eq!(scenes.len(), 5);
    for scene in scenes {
        card(&harness, scene.title);
    }
    for label in ["Recent files", "Files that you open are listed here", "Open file…", "Open folder…"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_card_opens_its_scene_with_its_settings() {
    let mut harness = start_window(None);
    card(&harness, "Rose window").click();
    harness.run_steps(3);
    wait_until(&mut harness, "never opened", |app| is_open(app, "stained_glass"));
    let scene = PRESETS.into_iter().find(|preset| preset.name == "scene/stained_glass").unwrap();
    let wanted = scene.apply(&Settings::default(), &harness.state().ranges().unwrap()).unwrap();
    let found = harness.state().settings();
    assert_eq!((&found.lights, &found.camera, &found.sky), (&wanted.lights, &wanted.camera, &wanted.sky));
    assert_eq!(found.floor, wanted.floor);
    for number in 1..=9 {
        let label = wanted.layer().labels.get(number);
        assert!(label.is_some() && found.layer().labels.get(number) == label, "{number}");
    }
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
}

#[test]
fn a_file_argument_skips_the_screen_and_a_missing_one_leads_to_it() {
    let options = |source: &str| WindowOptions { source: Some(source.into()), ..WindowOptions::default() };
    let harness = sharp_window_with(options(SCENE), Vec2::new(1100.0, 760.0));
    assert!(is_open(harness.state(), "chair"));
    let mut harness = sharp_window_with(options("/no/such/volume.nrrd"), Vec2::new(1100.0, 760.0));
    harness.run_steps(3);
    assert!(harness.state().shows_start() && harness.state().errors().len() == 1);
    assert!(harness.query_by_label_contains("there is no such file").is_some(), "with the reason");
}

#[test]
fn keys_choose_a_card() {
    let mut harness = start_window(None);
    // The arrow key finds the first card, and the next one moves on.
    for _ in 0..2 {
        harness.key_press(Key::ArrowRight);
        harness.run_steps(3);
    }
    let focused =
        |harness: &Harness<'_, App>, title: &str| card(harness, title).accesskit_node().is_focused();
    assert!(focused(&harness, "Evening cloud"), "the second of the first row");
    harness.key_press(Key::Tab);
    harness.run_steps(3);
    assert!(focused(&harness, "Wax rabbit"));
    harness.key_press_modifiers(Modifiers::SHIFT, Key::Tab);
    harness.run_steps(3);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    wait_until(&mut harness, "never opened", |app| is_open(app, "cloud"));
}

#[test]
fn recent_files_are_listed_and_open() {
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = folder.path().join("ramp_8x9x10_uint8.raw");
    std::fs::write(&path, (0..720).map(|i| (i / 3) as u8).collect::<Vec<_>>()).unwrap();
    let mut harness = start_window(Some(storage.path()));
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path)));
    wait_until(&mut harness, "never opened", |app| is_open(app, "ramp"));
    drop(harness);
    let mut harness = start_window(Some(storage.path()));
    assert!(harness.state().shows_start());
    harness.get_by_label_contains("ramp_8x9x10_uint8.raw").click();
    harness.run_steps(3);
    wait_until(&mut harness, "never opened", |app| is_open(app, "ramp"));
}

#[test]
fn the_screen_can_be_seen_again_and_left() {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    let mut harness = sharp_window_with(options, Vec2::new(1100.0, 760.0));
    let before = harness.state().settings().clone();
    let show_start = |harness: &mut Harness<'_, App>| {
        click(harness, "File");
        harness.get_by_label_contains("Start").click();
        harness.run_steps(8);
        assert!(harness.state().shows_start());
    };
    show_start(&mut harness);
    // Keys for the picture have no effect while it is hidden, and neither do those of its lights.
    for key in [Key::CloseBracket, Key::K, Key::ArrowLeft, Key::R] {
        harness.key_press(key);
        harness.run_steps(2);
    }
    assert!(harness.state().shows_start());
    // The first press takes the focus from the card that the arrow key has found.
    for _ in 0..2 {
        harness.key_press(Key::Escape);
        harness.run_steps(4);
    }
    assert!(is_open(harness.state(), "chair"), "the volume was kept");
    assert_eq!(harness.state().settings(), &before);
    // A command that needs the picture shows it.
    show_start(&mut harness);
    click(&mut harness, "View");
    harness.get_by_label_contains("Reset view").click();
    harness.run_steps(4);
    assert!(!harness.state().shows_start());
    // Another scene takes the place of the volume.
    show_start(&mut harness);
    card(&harness, "Cell cluster").click();
    wait_until(&mut harness, "never opened", |app| is_open(app, "cells"));
    assert_ne!(harness.state().settings().lights, before.lights);
    // Without a volume there is nothing to return to.
    let mut harness = start_window(None);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(4);
    assert!(harness.state().shows_start());
}
