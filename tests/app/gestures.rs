//! Tests of pointer gestures in the picture: orbit, handles, flicks, window and level, and Escape.

use chiaroscuro::app::App;
use eframe::egui::{self, Event, Modifiers, PointerButton, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    click, drag, drag_with, flick, key_stroke, picture, render, send_in_one_frame, slow_window,
    wait_until_idle, window, window_without_overlays,
};

#[test]
fn the_window_shows_what_the_renderer_makes() {
    let mut harness = window_without_overlays();
    assert_eq!(harness.state().volume_name(), Some("chair"));
    harness.check_accessibility();
    let (shown, size) = picture(&mut harness);
    assert!(shown == render(&harness, size).display, "the window shows other bytes than the renderer makes");
}

#[test]
fn lights_and_camera_follow_the_mouse() {
    let mut harness = window_without_overlays();
    let (before, _) = picture(&mut harness);
    let rebuilds = harness.state().light_rebuilds();

    // Orbiting refills no light volume.
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
    assert!(turned == render(&harness, size).display, "after an orbit");

    // Drags the handle of the key light.
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
    assert!(lit == render(&harness, size).display, "after a light drag");

    // Undo restores the light's position.
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights[0].position, orbited.lights[0].position);
}

/// Event of pressing or releasing the primary button.
fn button(pos: egui::Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

/// Handles react to a finger or pen, which never hovers over a handle before it presses it.
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

/// A flick drags what was pressed, however far the pointer has moved when the next frame begins.
#[test]
fn flicks_drag_the_pressed_item() {
    let mut harness = slow_window(vec2(760.0, 1140.0));
    let camera = harness.state().settings().camera.clone();
    let flicks = |harness: &mut Harness<'static, App>, what: &str, by: egui::Vec2| {
        let before = harness.state().settings().clone();
        let from = harness.get_by_label(what).rect().center();
        send_in_one_frame(harness, flick(from, by));
        let after = harness.state().settings().clone();
        assert_eq!(after.camera, camera, "{what}: the camera turned");
        assert_ne!(after, before, "{what} stayed");
        (before, after)
    };
    // A number of the panel is dragged by its slider.
    let (before, after) = flick_strength_slider(&mut harness);
    assert_ne!(after, before);
    let (before, after) = flicks(&mut harness, "Light handle Key", vec2(-60.0, 45.0));
    assert_ne!(after.lights[0].position, before.lights[0].position);
    send_in_one_frame(&mut harness, key_stroke(egui::Key::K, Modifiers::NONE).to_vec());
    let (_, after) = flicks(&mut harness, "Crop box, side +z", vec2(0.0, 60.0));
    assert!(after.cuts.crop.high[2] < 1.0);
    let keys = [egui::Key::K, egui::Key::X].map(|key| key_stroke(key, Modifiers::NONE));
    send_in_one_frame(&mut harness, keys.concat());
    let place = |harness: &Harness<'_, App>, part| {
        harness.get_by_label(&format!("Clip plane, {part}")).rect().center()
    };
    let along = place(&harness, "direction") - place(&harness, "position");
    let (_, after) = flicks(&mut harness, "Clip plane, position", along * 0.8);
    assert!(after.cuts.plane.on && after.cuts.plane.offset > 0.1, "{:?}", after.cuts.plane);
    wait_until_idle(&mut harness);
}

/// Flicks the slider of the shadow strength, and returns the strength before and after.
fn flick_strength_slider(harness: &mut Harness<'static, App>) -> (f64, f64) {
    let strength = |harness: &Harness<'_, App>| harness.state().settings().shadows.strength;
    let before = strength(harness);
    let slider = harness.get_by_role_and_label(egui::Role::Slider, "Strength").rect();
    send_in_one_frame(harness, flick(slider.center(), vec2(-20.0, 70.0)));
    (before, strength(harness))
}

/// Key strokes that arrive within one frame are all counted: each undoes one step.
#[test]
fn keys_that_are_struck_within_a_frame_are_counted() {
    let mut harness = slow_window(vec2(760.0, 1140.0));
    let before = harness.state().settings().clone();
    for _ in 0..3 {
        harness.key_press(egui::Key::CloseBracket);
        // Longer than the interval within which changes are merged into one undo step.
        harness.run_steps(12);
    }
    assert!(harness.state().settings().lights[0].intensity > 1.3 * before.lights[0].intensity);
    let undo = key_stroke(egui::Key::Z, Modifiers::COMMAND);
    let modifiers = |modifiers| vec![Event::ModifiersChanged(modifiers)];
    let events = [modifiers(Modifiers::COMMAND), vec![undo; 3].concat(), modifiers(Modifiers::NONE)];
    send_in_one_frame(&mut harness, events.concat());
    assert_eq!(harness.state().settings().lights, before.lights);
    wait_until_idle(&mut harness);
}

#[test]
fn level_and_window_are_dragged_in_the_picture() {
    let mut harness = window();
    let ends = |harness: &Harness<'_, App>| {
        let points = &harness.state().settings().layer().transfer.points;
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
fn spotlights_widen_by_their_rim_handle() {
    let mut harness = window();
    click(&mut harness, "Positional");
    click(&mut harness, "Spotlight");
    harness.run_steps(3);
    let angle = |harness: &Harness<'_, App>| harness.state().settings().lights[0].hood.half_angle_deg;
    let before = angle(&harness);
    // The direction of the handle depends on how the picture shows the cone.
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

/// Size handle of a parallel light, which is shown on a sphere around the volume; handles of other lights may be
/// outside the picture.
#[test]
fn size_handles_resize_lights() {
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
    // A drag far beyond the middle gives the smallest size, and the handle can still be grabbed.
    drag(&mut harness, handle, (middle - handle) * 3.0);
    harness.run_steps(2);
    assert!(angle(&harness) < before && angle(&harness) > 0.0, "{}", angle(&harness));
    assert!(harness.query_by_label("Size handle Key").is_some());
    wait_until_idle(&mut harness);
}

#[test]
fn the_probe_says_what_light_arrives() {
    let mut harness = window_without_overlays();
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

/// Escape reverts a drag to its beginning: of a light, of the camera, or of a freehand curve.
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

/// Escape closes the windows over the picture, the topmost first.
#[test]
fn escape_closes_windows_one_by_one() {
    let mut harness = window();
    let press = |harness: &mut Harness<'_, App>, key| {
        harness.key_press(key);
        harness.run_steps(4);
    };
    press(&mut harness, egui::Key::D);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::E);
    harness.run_steps(4);
    let is_open = |harness: &Harness<'_, App>, title: &str| harness.query_by_label(title).is_some();
    assert!(is_open(&harness, "Slices") && is_open(&harness, "Export picture or turntable"));
    press(&mut harness, egui::Key::D);
    assert!(is_open(&harness, "Slices"), "letters are no commands where a name is typed");
    press(&mut harness, egui::Key::Escape);
    assert!(is_open(&harness, "Slices") && !is_open(&harness, "Export picture or turntable"));
    press(&mut harness, egui::Key::Escape);
    assert!(!is_open(&harness, "Slices"));
    wait_until_idle(&mut harness);
}
