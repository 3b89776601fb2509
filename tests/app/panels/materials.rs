//! Materials by value and change in the window: the boxes over the histogram, and clicks in the picture.

use chiaroscuro::app::App;
use chiaroscuro_scene::MaterialBox;
use eframe::egui::{Key, Modifiers, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    click, click_at, drag, picture, picture_with_pointer, wait_until_idle, window_without_overlays,
};

fn materials(harness: &Harness<'_, App>) -> Vec<MaterialBox> {
    harness.state().settings().layer().materials.clone()
}

fn undo(harness: &mut Harness<'_, App>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    wait_until_idle(harness);
}

#[test]
fn a_curve_becomes_boxes_that_are_drawn_and_removed() {
    let mut harness = window_without_overlays();
    let (by_curve, _) = picture(&mut harness);
    let curve = harness.state().settings().layer().transfer.clone();
    click(&mut harness, "Shape");
    click(&mut harness, "Materials by value and change");
    wait_until_idle(&mut harness);
    assert_eq!(materials(&harness).len(), 1);
    let unnamed = harness.unnamed_widgets();
    assert!(unnamed.is_empty(), "{unnamed:#?}");
    let (one, _) = picture(&mut harness);
    assert!(one != by_curve, "one colour");
    // A box over the lowest values, beside that of the curve.
    let plane = harness.get_by_label("Materials by value and change").rect();
    let at = |x: f32, y: f32| pos2(plane.left() + x * plane.width(), plane.top() + y * plane.height());
    drag(&mut harness, at(0.05, 0.2), at(0.12, 0.7) - at(0.05, 0.2));
    wait_until_idle(&mut harness);
    let two = materials(&harness);
    assert_eq!(two.len(), 2);
    assert!(two[1].values[0] < two[1].values[1] && two[1].changes[0] < two[1].changes[1], "{:?}", two[1]);
    assert!(two[1].color != two[0].color);
    // Under the pointer, a material is bright, and others are dark; outside of the plane, nothing is changed.
    let away = plane.left_top() - vec2(0.0, 60.0);
    let picture_at = |harness: &mut Harness<'_, App>, at| {
        harness.hover_at(at);
        harness.run_steps(3);
        wait_until_idle(harness);
        picture_with_pointer(harness).0
    };
    let both = picture_at(&mut harness, away);
    let highlighted = picture_at(&mut harness, at(0.085, 0.45));
    assert!(highlighted != both, "one of two");
    assert!(picture_at(&mut harness, away) == both);
    undo(&mut harness);
    assert_eq!(materials(&harness).len(), 1, "a drag is one step");
    assert!(picture(&mut harness).0 == one);
    click(&mut harness, "+ Material");
    assert_eq!(materials(&harness).len(), 2);
    click(&mut harness, "Remove");
    assert_eq!(materials(&harness).len(), 1);
    click(&mut harness, "Curve");
    wait_until_idle(&mut harness);
    assert_eq!(materials(&harness), []);
    assert_eq!(harness.state().settings().layer().transfer, curve);
    assert!(picture(&mut harness).0 == by_curve, "as it was");
    assert_eq!(harness.state().errors(), [""; 0]);
}

#[test]
fn parts_that_are_clicked_become_materials() {
    let mut harness = window_without_overlays();
    click(&mut harness, "Shape");
    click(&mut harness, "Pick materials");
    let (area, _) = harness.state().viewport_rect().expect("a picture");
    let camera = harness.state().settings().camera.clone();
    click_at(&mut harness, area.center(), 1);
    harness.run_steps(3);
    assert_eq!(materials(&harness), [], "one alone would hide the other");
    click_at(&mut harness, area.center() + vec2(0.0, 0.1 * area.height()), 1);
    harness.run_steps(3);
    wait_until_idle(&mut harness);
    assert_eq!(materials(&harness).len(), 2);
    assert_eq!(harness.state().settings().camera, camera, "a click navigates nowhere");
    undo(&mut harness);
    assert_eq!(materials(&harness), []);
    assert_eq!(harness.state().errors(), [""; 0]);
}
