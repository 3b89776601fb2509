//! Tests of the render modes: the key O, the isovalue of a clicked place, and what modes without light leave out.

use chiaroscuro::app::App;
use chiaroscuro_scene::{RenderMode, RenderModeSettings};
use eframe::egui::{self, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{click_at, picture, wait_until_idle, window_without_overlays};

fn mode(harness: &Harness<'_, App>) -> RenderModeSettings {
    harness.state().settings().mode.clone()
}

#[test]
fn a_key_shows_one_mode_after_the_other() {
    let mut harness = window_without_overlays();
    let (rect, _) = harness.state().viewport_rect().expect("a picture");
    let (matter, _) = picture(&mut harness);
    // Beside the object, the surface lies where the curve says.
    harness.hover_at(rect.left_top() + vec2(20.0, 60.0));
    let mut pictures = vec![matter.clone()];
    let handles = |harness: &Harness<'_, App>| harness.query_all_by_label_contains("Light handle").count();
    assert!(handles(&harness) > 0);
    for expected in [RenderMode::Surface, RenderMode::Maximum, RenderMode::Minimum, RenderMode::Mean] {
        harness.key_press(egui::Key::O);
        harness.run_steps(3);
        assert_eq!(mode(&harness), RenderModeSettings { kind: expected, ..RenderModeSettings::default() });
        wait_until_idle(&mut harness);
        pictures.push(picture(&mut harness).0);
        let is_lit = expected == RenderMode::Surface;
        assert_eq!(handles(&harness) > 0, is_lit, "handles only of lights that have an effect");
    }
    let [matter_again, surface, maximum, ..] = &pictures[..] else { panic!("five pictures") };
    assert!(surface != matter_again && maximum != matter_again && maximum != surface);
    harness.key_press(egui::Key::O);
    harness.run_steps(3);
    wait_until_idle(&mut harness);
    assert!(mode(&harness).kind == RenderMode::Matter && picture(&mut harness).0 == matter, "as before");
    // Each step can be undone.
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(mode(&harness).kind, RenderMode::Mean);
}

#[test]
fn a_surface_takes_its_value_from_the_clicked_place() {
    let mut harness = window_without_overlays();
    let (rect, _) = harness.state().viewport_rect().expect("a picture");
    harness.hover_at(rect.center());
    harness.run_steps(2);
    harness.key_press(egui::Key::O);
    harness.run_steps(3);
    let under_pointer = mode(&harness).isovalue.expect("the value under the pointer");
    click_at(&mut harness, rect.center() + vec2(0.0, 40.0), 1);
    harness.run_steps(20);
    let clicked = mode(&harness).isovalue.expect("a value");
    assert!(clicked != under_pointer, "{clicked}");
    // A click beside the object changes nothing.
    click_at(&mut harness, rect.left_top() + vec2(20.0, 60.0), 1);
    harness.run_steps(20);
    assert_eq!(mode(&harness).isovalue, Some(clicked));
    wait_until_idle(&mut harness);
}
