//! Tests of volumes that are shown with the open one as layers.

use std::path::Path;

use chiaroscuro::app::App;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{picture, wait_until, wait_until_idle, window};

fn add(harness: &mut Harness<'_, App>, source: &str) {
    let ctx = harness.ctx.clone();
    harness.state_mut().add_layer(Path::new(source), &ctx);
    wait_until(harness, "the volume is read", |app| app.file_being_read().is_none());
    wait_until_idle(harness);
}

#[test]
fn a_layer_is_added_undone_and_redone() {
    let mut harness = window();
    wait_until_idle(&mut harness);
    let alone = picture(&mut harness);
    add(&mut harness, "builtin:sphere:32");
    assert_eq!(harness.state().settings().layers.count(), 2);
    let both = picture(&mut harness);
    assert!(both != alone, "the sphere is seen");
    // Undo takes the layer away, and redo brings it back.
    harness.key_press_modifiers(eframe::egui::Modifiers::COMMAND, eframe::egui::Key::Z);
    wait_until(&mut harness, "the layer is gone", |app| app.settings().layers.count() == 1);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness) == alone, "as before");
    let redo = eframe::egui::Modifiers::COMMAND.plus(eframe::egui::Modifiers::SHIFT);
    harness.key_press_modifiers(redo, eframe::egui::Key::Z);
    wait_until(&mut harness, "the layer is back", |app| app.settings().layers.count() == 2);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness) == both, "the same two");
}

#[test]
fn what_is_no_volume_is_reported_and_nothing_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("broken.nrrd");
    std::fs::write(&path, "NRRD0004\nno volume").expect("written");
    let mut harness = window();
    wait_until_idle(&mut harness);
    let before = harness.state().settings().clone();
    add(&mut harness, &path.to_string_lossy());
    assert_eq!(*harness.state().settings(), before);
    assert!(harness.query_all_by_label_contains("not shown as a layer").next().is_some());
}
