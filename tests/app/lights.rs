//! Tests of lights set by the keyboard, of the command palette, and of contact sheets of lights and presets.

use std::time::{Duration, Instant};

use chiaroscuro::app::App;
use eframe::egui::{self, Event, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{WAIT_TIMEOUT, click, wait_until_idle, window};

#[test]
fn lights_are_set_by_the_keyboard() {
    let mut harness = window();
    let lights = |harness: &Harness<'_, App>| harness.state().settings().lights.clone();
    let before = lights(&harness);
    let press = |harness: &mut Harness<'_, App>, key| {
        harness.key_press(key);
        harness.run_steps(2);
    };
    press(&mut harness, egui::Key::ArrowRight);
    let turned = lights(&harness);
    let angle = glam::DVec3::from(before[0].position).angle_between(turned[0].position.into()).to_degrees();
    assert!(angle > 0.1 && angle < 1.001, "one degree about the axis, {angle} between directions");
    assert_eq!(turned[1], before[1]);
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::ArrowUp);
    harness.run_steps(2);
    let far = lights(&harness);
    let angle = glam::DVec3::from(turned[0].position).angle_between(far[0].position.into()).to_degrees();
    assert!(angle > 2.0, "ten degrees about the axis, {angle} between directions");

    press(&mut harness, egui::Key::Period);
    press(&mut harness, egui::Key::CloseBracket);
    assert!(lights(&harness)[1].intensity > before[1].intensity, "the fill is selected and brighter");
    press(&mut harness, egui::Key::S);
    assert_eq!(lights(&harness).iter().map(|light| light.on).collect::<Vec<_>>(), [false, true]);
    press(&mut harness, egui::Key::M);
    assert!(!lights(&harness)[1].on);

    // The chip in the overlay selects the light, as its handle would.
    click(&mut harness, "Light Key, off");
    press(&mut harness, egui::Key::M);
    assert!(lights(&harness)[0].on);
    wait_until_idle(&mut harness);
}

#[test]
fn lights_are_tried_on_the_volume() {
    let mut harness = window();
    let before = harness.state().settings().lights.clone();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("try lights".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    let begin = Instant::now();
    while harness.query_by_label("From above").is_none() {
        assert!(begin.elapsed() < WAIT_TIMEOUT, "no pictures");
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(harness.query_all_by_label_contains("o'clock").count() % 6, 0);
    click(&mut harness, "Use From above");
    let lights = harness.state().settings().lights.clone();
    assert_ne!(lights, before);
    assert_eq!(lights[0].name, "Sun");
    wait_until_idle(&mut harness);
}

#[test]
fn presets_are_tried_on_the_volume() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    click(&mut harness, "Presets");
    click(&mut harness, "Try presets…");
    let begin = Instant::now();
    // Waits until the last picture is finished.
    while harness.query_by_label("Refresh").is_none() {
        assert!(begin.elapsed() < WAIT_TIMEOUT, "no pictures");
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    // The window grows around the pictures.
    harness.run_steps(5);
    assert!(harness.query_by_label("Use CT angiography").is_some());
    assert_eq!(harness.state().settings(), &before, "trying changes nothing");
    click(&mut harness, "Use Lobster");
    assert_ne!(harness.state().settings().layer().transfer, before.layer().transfer);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings(), &before);
    wait_until_idle(&mut harness);
}

#[test]
fn commands_are_found_by_name() {
    let mut harness = window();
    let lights = harness.state().settings().lights.len();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("key fill back".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights.len(), lights + 1, "three lights instead of two");
    assert!(harness.query_by_label("Find a command").is_none(), "it has closed");
    wait_until_idle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights.len(), lights);
    wait_until_idle(&mut harness);
}

/// The palette reports a missing feature with its nearest commands, and says when nothing is found.
#[test]
fn missing_features_are_reported() {
    let mut harness = window();
    let type_words = |harness: &mut Harness<'_, App>, words: &str| {
        harness.key_press(egui::Key::Escape);
        harness.run_steps(2);
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
        harness.run_steps(3);
        harness.event(Event::Text(words.to_owned()));
        harness.run_steps(3);
    };
    type_words(&mut harness, "stereo");
    harness.get_by_label_contains("There is no stereo picture");
    type_words(&mut harness, "measure");
    harness.get_by_label_contains("two clicks");
    type_words(&mut harness, "qwertz");
    harness.get_by_label("No matches");
    // The chair has no labels.
    type_words(&mut harness, "labels");
    assert!(harness.query_by_label("Labels").is_none());
    harness.get_by_label_contains("label maps of other programs");
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    wait_until_idle(&mut harness);
}

/// New lights have distinct positions and colours, and are visible when they shine from a point.
#[test]
fn new_lights_are_told_apart() {
    let mut harness = window();
    for _ in 0..6 {
        click(&mut harness, "+");
        harness.run_steps(2);
    }
    let lights = harness.state().settings().lights.clone();
    assert_eq!(lights.len(), 8);
    let direction = |at: usize| glam::DVec3::from(lights[at].position).normalize();
    for at in 2..8 {
        for other in 0..at {
            let angle = direction(at).angle_between(direction(other)).to_degrees();
            assert!(angle > 12.0, "lights {other} and {at} are {angle}° apart");
        }
        if at > 2 {
            assert_ne!(lights[at].color, lights[at - 1].color);
        }
    }
    // The sum of the added intensities stays within that of the first look.
    assert!(lights[2..].iter().map(|light| light.intensity).sum::<f64>() < 2.0);
    click(&mut harness, "Positional");
    harness.run_steps(4);
    let light = harness.state().settings().lights[7].clone();
    let camera = &harness.state().settings().camera;
    let (x, y, _) = camera.pixel_from_scene(light.position.into(), 1.0, 1.0).expect("in front of the eye");
    assert!((0.05..0.95).contains(&x) && (0.05..0.95).contains(&y), "{x} {y}");
    wait_until_idle(&mut harness);
}
