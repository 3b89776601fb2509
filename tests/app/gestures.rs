//! What the pointer does in the picture.

use chiaroscuro::app::App;
use eframe::egui::{self, Event, Modifiers, PointerButton, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{bare_window, click, drag, drag_with, picture, render, wait_until_idle, window};

#[test]
fn the_window_shows_what_the_renderer_makes() {
    let mut harness = bare_window();
    assert_eq!(harness.state().volume_name(), Some("chair"));
    harness.check_accessibility();
    let (shown, size) = picture(&mut harness);
    assert!(shown == render(&harness, size).shown, "the window shows other bytes than the renderer makes");
}

#[test]
fn lights_and_camera_follow_the_mouse() {
    let mut harness = bare_window();
    let (before, _) = picture(&mut harness);
    let rebuilds = harness.state().light_rebuilds();

    // Orbit: nothing is refilled.
    let settings = harness.state().settings().clone();
    let (rect, _) = harness.state().viewport_rect().unwrap();
    drag(&mut harness, rect.left_bottom() + vec2(40.0, -30.0), vec2(60.0, -25.0));
    wait_until_idle(&mut harness);
    let orbited = harness.state().settings().clone();
    assert_ne!(orbited.camera, settings.camera);
    assert_eq!(orbited.lights, settings.lights);
    assert_eq!(harness.state().light_rebuilds(), rebuilds, "orbiting refilled a light volume");
    let (turned, size) = picture(&mut harness);
    assert!(turned != before);
    assert!(turned == render(&harness, size).shown, "after an orbit");

    // The key light's handle.
    harness.hover_at(rect.center());
    harness.run_steps(2);
    let handle = harness.state().light_handle_positions()[0];
    let to_middle = (rect.center() - handle).normalized() * 60.0;
    drag(&mut harness, handle, to_middle);
    wait_until_idle(&mut harness);
    let moved = harness.state().settings().clone();
    assert_ne!(moved.lights[0].position, orbited.lights[0].position);
    assert_eq!(moved.camera, orbited.camera, "the light's drag turned the camera too");
    assert!(harness.state().light_rebuilds() > rebuilds);
    let (lit, size) = picture(&mut harness);
    assert!(lit != turned);
    assert!(lit == render(&harness, size).shown, "after a light drag");

    // Undo puts the light back.
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights[0].position, orbited.lights[0].position);
}

/// The first button goes down or up.
fn button(pos: egui::Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

/// A finger or a pen comes from nowhere: it is never above a handle before it presses it.
#[test]
fn handles_are_taken_without_hovering() {
    let mut harness = window();
    harness.remove_cursor();
    harness.run_steps(12);
    let before = harness.state().settings().clone();
    let handle = harness.state().light_handle_positions()[0];
    harness.event(Event::PointerMoved(handle));
    harness.event(button(handle, true));
    harness.step();
    let to = handle + vec2(-40.0, 30.0);
    harness.event(Event::PointerMoved(to));
    harness.step();
    harness.event(button(to, false));
    harness.event(Event::PointerGone);
    harness.run_steps(2);
    let after = harness.state().settings();
    assert_ne!(after.lights[0].position, before.lights[0].position);
    assert_eq!(after.camera, before.camera);
}

#[test]
fn level_and_window_are_dragged_in_the_picture() {
    let mut harness = window();
    let ends = |harness: &Harness<'_, App>| {
        let points = &harness.state().settings().transfer.points;
        (points.first().expect("a point").value, points.last().expect("a point").value)
    };
    let (before, camera) = (ends(&harness), harness.state().settings().camera.clone());
    let center = harness.get_by_label("Picture").rect().center() + vec2(0.0, 60.0);
    drag_with(&mut harness, PointerButton::Secondary, center, vec2(0.0, 40.0));
    harness.run_steps(2);
    let shifted = ends(&harness);
    assert!(shifted.0 > before.0, "down means higher values");
    assert!((shifted.1 - shifted.0 - before.1 + before.0).abs() < 1e-9);
    drag_with(&mut harness, PointerButton::Secondary, center, vec2(40.0, 0.0));
    harness.run_steps(2);
    let spread = ends(&harness);
    assert!(spread.1 - spread.0 > shifted.1 - shifted.0);
    assert!((spread.0 + spread.1 - shifted.0 - shifted.1).abs() < 1e-6, "about the middle");
    assert_eq!(harness.state().settings().camera, camera);
    for _ in 0..2 {
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
    }
    assert_eq!(ends(&harness), before, "each drag is a step");
    wait_until_idle(&mut harness);
}

#[test]
fn hoods_are_opened_by_their_rim() {
    let mut harness = window();
    click(&mut harness, "Positional");
    click(&mut harness, "Spotlight");
    harness.run_steps(3);
    let angle = |harness: &Harness<'_, App>| harness.state().settings().lights[0].hood.half_angle_deg;
    let before = angle(&harness);
    // Where the handle is depends on what the picture shows of the cone.
    let mut changes = Vec::new();
    for by in [vec2(24.0, 0.0), vec2(-24.0, 0.0), vec2(0.0, 24.0), vec2(0.0, -24.0)] {
        let handle = harness.get_by_label("Spotlight handle Key").rect().center();
        drag(&mut harness, handle, by);
        harness.run_steps(2);
        changes.push(angle(&harness) - before);
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
        assert_eq!(angle(&harness), before, "a drag is a step");
    }
    assert!(changes.iter().any(|&change| change > 0.5), "{changes:?}");
    assert!(changes.iter().any(|&change| change < -0.5), "{changes:?}");
    wait_until_idle(&mut harness);
}

/// Of a parallel light, which is shown on a sphere around the volume: others may stand outside of the picture.
#[test]
fn lights_grow_by_their_borders() {
    let mut harness = window();
    click(&mut harness, "Disc");
    harness.run_steps(3);
    let angle = |harness: &Harness<'_, App>| harness.state().settings().lights[0].angle_deg;
    let before = angle(&harness);
    let middle = harness.get_by_label("Light handle Key").rect().center();
    let handle = harness.get_by_label("Size handle Key").rect().center();
    drag(&mut harness, handle, (handle - middle).normalized() * 20.0);
    harness.run_steps(2);
    assert!(angle(&harness) > 1.1 * before, "{} from {before}", angle(&harness));
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(angle(&harness), before, "a drag is a step");
    // Far beyond the middle: as narrow as can be, and there to be grabbed again.
    drag(&mut harness, handle, (middle - handle) * 3.0);
    harness.run_steps(2);
    assert!(angle(&harness) < before && angle(&harness) > 0.0, "{}", angle(&harness));
    assert!(harness.query_by_label("Size handle Key").is_some());
    wait_until_idle(&mut harness);
}

#[test]
fn the_probe_says_what_light_arrives() {
    let mut harness = bare_window();
    let (before, _) = picture(&mut harness);
    harness.key_press(egui::Key::I);
    let (rect, _) = harness.state().viewport_rect().unwrap();
    harness.hover_at(rect.center());
    harness.run_steps(3);
    let shown = harness.render().expect("a picture of the window");
    harness.key_press(egui::Key::I);
    harness.run_steps(3);
    let hidden = harness.render().expect("a picture of the window");
    assert!(shown.as_raw() != hidden.as_raw(), "the answer is painted over the picture");
    let (after, _) = picture(&mut harness);
    assert!(before == after, "and gone again");
}

/// Escape takes everything back to where a drag began: a light, the camera, what an editor's hand has changed.
#[test]
fn escape_ends_a_drag_where_it_began() {
    let mut harness = window();
    let (rect, _) = harness.state().viewport_rect().unwrap();
    harness.hover_at(rect.center());
    harness.run_steps(2);
    let handle = harness.state().light_handle_positions()[0];
    let slider = harness.get_by_role_and_label(egui::Role::Slider, "Strength").rect().center();
    for (what, from) in
        [("light", handle), ("camera", rect.left_bottom() + vec2(40.0, -30.0)), ("number", slider)]
    {
        let before = harness.state().settings().clone();
        harness.event(Event::PointerMoved(from));
        harness.event(button(from, true));
        harness.run_steps(1);
        for step in 1..=4 {
            harness.event(Event::PointerMoved(from + vec2(-12.0, 9.0) * step as f32));
            harness.run_steps(1);
        }
        assert_ne!(harness.state().settings(), &before, "the {what} moves");
        harness.key_press(egui::Key::Escape);
        harness.run_steps(2);
        assert_eq!(harness.state().settings(), &before, "{what}");
        let end = from + vec2(90.0, 20.0);
        harness.event(Event::PointerMoved(end));
        harness.event(button(end, false));
        harness.run_steps(2);
        assert_eq!(harness.state().settings(), &before, "what follows moves nothing: {what}");
    }
    wait_until_idle(&mut harness);
}

/// Escape closes the windows over the picture, the highest first.
#[test]
fn escape_closes_windows_one_by_one() {
    let mut harness = window();
    let press = |harness: &mut Harness<'_, App>, key| {
        harness.key_press(key);
        harness.run_steps(4);
    };
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::E);
    harness.run_steps(4);
    press(&mut harness, egui::Key::D);
    let is_open = |harness: &Harness<'_, App>, title: &str| harness.query_by_label(title).is_some();
    assert!(is_open(&harness, "Slices") && is_open(&harness, "Export picture or turntable"));
    press(&mut harness, egui::Key::Escape);
    assert!(!is_open(&harness, "Slices") && is_open(&harness, "Export picture or turntable"));
    press(&mut harness, egui::Key::Escape);
    assert!(!is_open(&harness, "Export picture or turntable"));
    wait_until_idle(&mut harness);
}
