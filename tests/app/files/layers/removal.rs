//! Tests of the removal of layers other than the last one.

use std::path::Path;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LayerVisibility, LookRecord};
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::files::volume_choice::write_npy;
use crate::harness::{adjusted_window, block_file_tasks, click, picture, wait_until, wait_until_idle};

/// Names of the volumes, in the order in which they are opened.
const NAMES: [&str; 3] = ["first", "second", "third"];

/// Writes three boxes of one grid, beside each other and partly in one another.
fn write_boxes(folder: &Path) {
    for (at, name) in NAMES.iter().enumerate() {
        let value = |voxel: usize| {
            let place = [voxel % 16, voxel / 16 % 16, voxel / 256];
            let is_inside = place.iter().all(|c| (2 + 3 * at..8 + 3 * at).contains(c));
            if is_inside { 150 + 40 * at as u8 } else { (voxel % (3 + at)) as u8 }
        };
        write_npy(&folder.join(name).with_extension("npy"), "16, 16, 16", 4096, value);
    }
}

fn window_of(folder: &Path, session: Option<&Path>) -> Harness<'static, App> {
    let (source, session) = (Some(folder.join("first.npy")), session.map(Path::to_owned));
    let options = WindowOptions { source, session, ..WindowOptions::default() };
    adjusted_window(options, Vec2::new(900.0, 1500.0))
}

fn wait_until_read(harness: &mut Harness<'_, App>) {
    harness.run_steps(4);
    wait_until(harness, "the volumes are read", |app| app.file_being_read().is_none());
    wait_until_idle(harness);
}

fn add(harness: &mut Harness<'_, App>, folder: &Path, name: &str) {
    let ctx = harness.ctx.clone();
    harness.state_mut().add_layer(&folder.join(name).with_extension("npy"), &ctx);
    wait_until_read(harness);
}

/// Opens the three volumes; the last one, with another look than at first, is selected.
fn window_of_three(folder: &Path, session: Option<&Path>) -> Harness<'static, App> {
    let mut harness = window_of(folder, session);
    wait_until_idle(&mut harness);
    add(&mut harness, folder, "second");
    add(&mut harness, folder, "third");
    assert_eq!(harness.state().volume_names(), NAMES);
    click(&mut harness, "Same opacity for light and eye");
    click(&mut harness, "Data");
    harness.run_steps(8);
    rest(&mut harness);
    harness
}

/// Waits until the last change is a step of the history.
fn rest(harness: &mut Harness<'_, App>) {
    harness.run_steps(8);
    wait_until_idle(harness);
}

/// Selects a layer by its tab.
fn select(harness: &mut Harness<'_, App>, name: &str) {
    harness.query_all_by_label(name).last().expect("a tab").click();
    harness.run_steps(3);
}

/// Removes a layer, as a step of the history.
fn remove(harness: &mut Harness<'_, App>, name: &str) {
    select(harness, name);
    click(harness, "Remove");
    rest(harness);
}

fn press(harness: &mut Harness<'_, App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    rest(harness);
}

fn undo(harness: &mut Harness<'_, App>) {
    press(harness, Modifiers::COMMAND, Key::Z);
}

fn redo(harness: &mut Harness<'_, App>) {
    press(harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
}

/// Names of the volumes in the record of a session.
fn recorded(session: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(session).expect("saved");
    let volume = LookRecord::parse(&text).expect("a record").volume.expect("a volume");
    volume.layers.into_iter().map(|layer| layer.source).collect()
}

#[test]
fn a_middle_layer_is_removed_undone_redone_and_stays_away_in_sessions() {
    let folder = tempfile::tempdir().expect("a folder");
    write_boxes(folder.path());
    let session = folder.path().join("session.json");
    let mut harness = window_of_three(folder.path(), Some(&session));
    let (all, look) = (picture(&mut harness), harness.state().settings().clone());
    remove(&mut harness, "second");
    // The other layers keep their looks.
    assert_eq!(harness.state().volume_names(), ["first", "third"]);
    let mut expected = look.clone();
    expected.remove_layer(1);
    assert_eq!(*harness.state().settings(), expected);
    assert_eq!(expected.layer_at(1), look.layer_at(2));
    let two = picture(&mut harness);
    assert!(two != all, "the second was seen");
    undo(&mut harness);
    assert_eq!(harness.state().volume_names(), NAMES);
    assert_eq!(*harness.state().settings(), look, "in one step");
    assert!(picture(&mut harness) == all, "as before");
    redo(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first", "third"]);
    assert!(picture(&mut harness) == two, "removed again");
    press(&mut harness, Modifiers::COMMAND, Key::S);
    assert_eq!(recorded(&session), ["third.npy"]);
    drop(harness);
    // The picture is that of a session that never had the second one.
    let mut harness = window_of(folder.path(), Some(&session));
    wait_until_read(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first", "third"]);
    assert_eq!(harness.state().settings().layers, expected.layers);
    assert!(picture(&mut harness) == two, "as it was saved");
}

#[test]
fn the_layer_before_is_selected_and_the_first_one_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    write_boxes(folder.path());
    let mut harness = window_of_three(folder.path(), None);
    click(&mut harness, "Only this layer");
    click(&mut harness, "Remove");
    rest(&mut harness);
    // The only one that was shown is gone, so that the others are shown.
    let settings = harness.state().settings();
    assert!(settings.layers.iter().all(|layer| layer.visibility == LayerVisibility::Shown));
    assert_eq!(harness.state().volume_names(), ["first", "second"]);
    click(&mut harness, "Remove");
    rest(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first"]);
    // Both come back, and after the selected layer was brought back the first one is still selected.
    undo(&mut harness);
    undo(&mut harness);
    assert_eq!(harness.state().volume_names(), NAMES);
    assert!(harness.query_by_label("Remove").is_some_and(|button| button.accesskit_node().is_disabled()));
}

#[test]
fn removed_layers_make_room_and_come_back_in_their_order() {
    let folder = tempfile::tempdir().expect("a folder");
    write_boxes(folder.path());
    let mut harness = window_of_three(folder.path(), None);
    let all = picture(&mut harness);
    remove(&mut harness, "second");
    add(&mut harness, folder.path(), "second");
    rest(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first", "third", "second"]);
    undo(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first", "third"]);
    undo(&mut harness);
    assert_eq!(harness.state().volume_names(), NAMES);
    assert!(picture(&mut harness) == all, "as at first");
    redo(&mut harness);
    redo(&mut harness);
    assert_eq!(harness.state().volume_names(), ["first", "third", "second"]);
}

#[test]
fn a_layer_that_is_read_while_another_is_removed_is_added_to_the_rest() {
    let folder = tempfile::tempdir().expect("a folder");
    write_boxes(folder.path());
    let mut harness = window_of_three(folder.path(), None);
    let look = harness.state().settings().layers.clone();
    select(&mut harness, "second");
    let held = block_file_tasks();
    let ctx = harness.ctx.clone();
    harness.state_mut().add_layer(Path::new("builtin:sphere:16"), &ctx);
    harness.run_steps(2);
    click(&mut harness, "Remove");
    harness.run_steps(4);
    assert_eq!(harness.state().volume_names(), ["first", "third"]);
    drop(held);
    wait_until(&mut harness, "the sphere is shown", |app| app.settings().layers.count() == 3);
    wait_until_read(&mut harness);
    assert_eq!(harness.state().volume_names()[..2], ["first", "third"]);
    assert_eq!(harness.state().volume_names().len(), 3);
    assert_eq!(Some(harness.state().settings().layer_at(1)), look.get(2), "its look stays");
}

#[test]
fn layers_come_back_to_a_volume_that_was_corrected_meanwhile() {
    let folder = tempfile::tempdir().expect("a folder");
    write_boxes(folder.path());
    let mut harness = window_of_three(folder.path(), None);
    let all = picture(&mut harness);
    remove(&mut harness, "second");
    click(&mut harness, "Corrections");
    harness.run_steps(8);
    harness.get_by_label("Flip x").scroll_to_me();
    harness.run_steps(8);
    click(&mut harness, "Flip x");
    wait_until(&mut harness, "the volume is corrected", |app| app.settings().volume.flip.x && app.is_idle());
    rest(&mut harness);
    let flipped = picture(&mut harness);
    undo(&mut harness);
    undo(&mut harness);
    assert_eq!(harness.state().volume_names(), NAMES);
    assert!(picture(&mut harness) == all, "as at first");
    redo(&mut harness);
    redo(&mut harness);
    assert!(picture(&mut harness) == flipped, "two layers, turned over");
}
