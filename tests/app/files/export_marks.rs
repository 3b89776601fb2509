//! Tests of the export window beside the picture, which previews the export, marks included.

use eframe::egui::{Key, Modifiers, Role, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{click, picture, wait_until, wait_until_idle, window, window_without_overlays};

/// Tolerance in 255ths between marks over the window's picture and over the exported one: two implementations blend
/// and round them.
const ROUNDING: u8 = 3;

#[test]
fn the_picture_is_what_would_be_exported_with_its_marks() {
    let mut harness = window_without_overlays();
    harness.set_size(Vec2::new(1100.0, 760.0));
    harness.run_steps(4);
    wait_until_idle(&mut harness);
    let usual = harness.state().viewport_rect().expect("a picture").0;
    harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
    harness.run_steps(6);
    // Docked beside the picture.
    let dialog = harness.get_by_label("Transparent background").rect();
    let (beside, _) = harness.state().viewport_rect().expect("a picture");
    assert!(beside.left() >= dialog.right() && beside.left() > usual.left() + 200.0, "{dialog} {beside}");
    // The preview has the picture's aspect ratio, however much space is left for it.
    let shape = |rect: eframe::egui::Rect| rect.width() / rect.height();
    assert!((shape(beside) / shape(usual) - 1.0).abs() < 0.02, "{beside} of {usual}");

    harness.get_by_role_and_label(Role::Button, "Window").click();
    harness.run_steps(4);
    let (plain, _) = picture(&mut harness);
    click(&mut harness, "Scale bar");
    click(&mut harness, "Legend");
    let (shown, size) = picture(&mut harness);
    let marked = shown.iter().zip(&plain).filter(|(a, b)| a != b).count();
    assert!(marked > 1000, "only {marked} bytes are of marks");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("marked.png");
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&path, size, &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let exported = image::open(&path).expect("a picture").to_rgba8().into_raw();
    let apart = shown.iter().zip(&exported).filter(|(a, b)| a.abs_diff(**b) > ROUNDING).count();
    assert_eq!((shown.len(), apart), (exported.len(), 0));
    // Escape closes the window wherever the pointer is.
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(6);
    assert_eq!(harness.state().viewport_rect().expect("a picture").0, usual);
    wait_until_idle(&mut harness);
}

#[test]
fn letters_cannot_be_ticked_where_there_are_none() {
    let mut harness = window();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
    harness.run_steps(6);
    assert!(harness.get_by_label("Orientation letters").accesskit_node().is_disabled());
    assert!(!harness.get_by_label("Scale bar").accesskit_node().is_disabled());
    // In a narrow window it floats over the picture: docked, it would leave no space for one.
    harness.set_size(Vec2::new(640.0, 400.0));
    harness.run_steps(6);
    assert!(harness.query_by_label("Close window").is_some());
    wait_until_idle(&mut harness);
}
