//! Tests of volumes that are shown with the open one as layers.

mod removal;

use std::path::Path;
use std::sync::Arc;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LayerBlend, LayerVisibility, LookRecord};
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::volume_choice::write_npy;
use crate::harness::{
    DroppedFile, SCENE, adjusted_window, click, picture, wait_until, wait_until_idle, window,
};

fn window_of(source: &Path, session: Option<&Path>) -> Harness<'static, App> {
    let (source, session) = (Some(source.to_owned()), session.map(Path::to_owned));
    let options = WindowOptions { source, session, ..WindowOptions::default() };
    adjusted_window(options, Vec2::new(900.0, 1500.0))
}

fn wait_until_read(harness: &mut Harness<'_, App>) {
    wait_until_idle(harness);
    wait_until(harness, "the volumes are read", |app| app.file_being_read().is_none());
    wait_until_idle(harness);
}

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
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait_until(&mut harness, "the layer is gone", |app| app.settings().layers.count() == 1);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness) == alone, "as before");
    let redo = Modifiers::COMMAND.plus(Modifiers::SHIFT);
    harness.key_press_modifiers(redo, Key::Z);
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

#[test]
fn a_session_opens_its_layers() {
    let folder = tempfile::tempdir().expect("a folder");
    let session = folder.path().join("session.json");
    let saved = {
        let mut harness = window_of(Path::new(SCENE), Some(&session));
        wait_until_idle(&mut harness);
        add(&mut harness, "builtin:sphere:32");
        // The note about the saved file is none of the picture.
        let shown = picture(&mut harness);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run_steps(3);
        shown
    };
    let mut harness = window_of(Path::new(SCENE), Some(&session));
    wait_until_read(&mut harness);
    assert_eq!(harness.state().errors(), [""; 0]);
    assert!(picture(&mut harness) == saved, "both volumes are seen");
}

#[test]
fn components_are_shown_together_and_one_by_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("vectors.nrrd");
    let header = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 16 16 16\n\
                  kinds: 2-vector domain domain domain\nencoding: raw\n\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend((0..2 * 4096).map(|at| {
        let (part, place) = (at % 2, [at / 2 % 16, at / 32 % 16, at / 512]);
        if place.iter().all(|c| (3 + 4 * part..8 + 4 * part).contains(c)) { 200 } else { (at % 5) as u8 }
    }));
    std::fs::write(&path, bytes).expect("written");
    let mut harness = window_of(&path, None);
    click(&mut harness, "Data");
    harness.run_steps(8);
    click(&mut harness, "Show all together");
    wait_until(&mut harness, "both are shown", |app| app.settings().layers.count() == 3);
    wait_until_read(&mut harness);
    // The last one that was added is selected.
    click(&mut harness, "Only this layer");
    harness.run_steps(3);
    let hidden = |harness: &Harness<'_, App>| {
        let layers = &harness.state().settings().layers;
        layers.iter().map(|layer| layer.visibility == LayerVisibility::Hidden).collect::<Vec<_>>()
    };
    assert_eq!(hidden(&harness), [true, false, true]);
    click(&mut harness, "Only this layer");
    harness.run_steps(3);
    assert_eq!(hidden(&harness), [false; 3]);
    // A transfer function is mirrored in the selected layer alone.
    let before = harness.state().settings().clone();
    click(&mut harness, "Automatic");
    wait_until_read(&mut harness);
    assert_eq!(harness.state().settings().layer(), before.layer());
}

#[test]
fn a_session_keeps_layers_that_cannot_be_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let (session, layer) = (folder.path().join("session.json"), folder.path().join("layer.npy"));
    write_npy(&layer, "16, 16, 16", 4096, |at| (at % 16 * 15) as u8);
    let save = |layer: Option<&Path>| {
        let mut harness = window_of(Path::new(SCENE), Some(&session));
        wait_until_read(&mut harness);
        if let Some(layer) = layer {
            add(&mut harness, &layer.to_string_lossy());
        }
        harness.key_press(Key::CloseBracket);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run_steps(5);
        let text = std::fs::read_to_string(&session).expect("saved");
        LookRecord::parse(&text).expect("a record").volume.expect("a volume").layers
    };
    let before = save(Some(&layer));
    assert_eq!(before.len(), 1);
    std::fs::remove_file(&layer).expect("removed");
    assert_eq!(save(None), before);
}

#[test]
fn corrections_of_a_session_apply_to_its_layers() {
    let folder = tempfile::tempdir().expect("a folder");
    let session = folder.path().join("session.json");
    {
        let mut harness = window_of(Path::new(SCENE), Some(&session));
        wait_until_idle(&mut harness);
        add(&mut harness, "builtin:sphere:32");
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run_steps(3);
    }
    let plain = {
        let mut harness = window_of(Path::new(SCENE), Some(&session));
        wait_until_read(&mut harness);
        picture(&mut harness)
    };
    let text = std::fs::read_to_string(&session).expect("saved");
    let mut record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    record["volume"]["flip"] = serde_json::json!([false, true, false]);
    std::fs::write(&session, record.to_string()).expect("written");
    let mut harness = window_of(Path::new(SCENE), Some(&session));
    wait_until_read(&mut harness);
    assert!(!harness.state().settings().volume.is_none(), "the correction is applied");
    let corrected = picture(&mut harness);
    assert!(corrected != plain, "flipped");
    // The sphere is still seen: without its layer the picture is another.
    click(&mut harness, "Data");
    harness.run_steps(8);
    click(&mut harness, "Hidden");
    wait_until_read(&mut harness);
    assert!(picture(&mut harness) != corrected, "the layer was there");
}

#[test]
fn a_dropped_volume_in_the_same_place_asks() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    write_npy(&path("first.npy"), "16, 16, 16", 4096, |at| (at % 16 * 15) as u8);
    write_npy(&path("second.npy"), "16, 16, 16", 4096, |at| (at / 256 * 15) as u8);
    write_npy(&path("other.npy"), "8, 16, 16", 2048, |at| (at % 16 * 15) as u8);
    let mut harness = window_of(&path("first.npy"), None);
    wait_until_read(&mut harness);
    let drop_file = |harness: &mut Harness<'_, App>, name: &str| {
        harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path(name))));
        harness.run_steps(2);
        wait_until_read(harness);
        harness.run_steps(3);
    };
    let question = "lies in the same place as";
    let is_asked =
        |harness: &Harness<'_, App>| harness.query_all_by_label_contains(question).next().is_some();
    drop_file(&mut harness, "second.npy");
    assert!(is_asked(&harness));
    click(&mut harness, "Show both");
    wait_until_read(&mut harness);
    assert_eq!(harness.state().settings().layers.count(), 2);
    assert!(!is_asked(&harness));
    // Alone it replaces both, and a volume of another grid is opened without a question.
    drop_file(&mut harness, "second.npy");
    assert!(is_asked(&harness));
    click(&mut harness, "Open it alone");
    wait_until_read(&mut harness);
    assert_eq!(harness.state().settings().layers.count(), 1);
    drop_file(&mut harness, "other.npy");
    assert!(!is_asked(&harness));
}

/// Writes a volume of 16-bit numbers, with voxels of a size in mm and its first corner at the origin of the body's space.
fn write_scan(path: &Path, edge: usize, spacing_mm: f64, value: impl Fn([usize; 3]) -> i16) {
    let s = spacing_mm;
    let mut bytes = format!(
        "NRRD0004\ntype: int16\ndimension: 3\nsizes: {edge} {edge} {edge}\nspace: right-anterior-superior\n\
         space directions: ({s},0,0) (0,{s},0) (0,0,{s})\nspace origin: (0,0,0)\nendian: little\nencoding: raw\n\n"
    )
    .into_bytes();
    for at in 0..edge.pow(3) {
        bytes.extend(value([at % edge, at / edge % edge, at / edge / edge]).to_le_bytes());
    }
    std::fs::write(path, bytes).expect("written");
}

#[test]
fn coarse_scans_and_labels_become_layers_over_a_finer_scan() {
    let folder = tempfile::tempdir().expect("a folder");
    let [scan, coarse, labels] =
        ["scan.nrrd", "coarse.nrrd", "labels.nrrd"].map(|name| folder.path().join(name));
    let ball = |[x, y, z]: [usize; 3], edge: usize| {
        let from_center = |c: usize| (c as f64 / (edge - 1) as f64 - 0.5).powi(2);
        let radius = (from_center(x) + from_center(y) + from_center(z)).sqrt();
        (1000.0 * (1.0 - 2.0 * radius)).max(0.0) as i16 + (x * 7 + y * 5 + z * 3) as i16 % 11
    };
    write_scan(&scan, 24, 1.0, |at| ball(at, 24));
    write_scan(&coarse, 12, 2.0, |at| ball(at, 12));
    write_scan(&labels, 24, 1.0, |at| ball(at, 24) / 400);
    let mut harness = window_of(&coarse, None);
    wait_until_idle(&mut harness);
    // A look that was changed goes along.
    assert!(harness.state().settings().layer().lighting.linked);
    click(&mut harness, "Same opacity for light and eye");
    harness.run_steps(3);
    let look = harness.state().settings().layer().lighting.clone();
    add(&mut harness, &scan.to_string_lossy());
    wait_until(&mut harness, "both are shown", |app| app.settings().layers.count() == 2);
    wait_until_read(&mut harness);
    assert_eq!(harness.state().volume_names(), ["scan", "coarse"]);
    assert_eq!(harness.state().settings().layer_at(1).lighting, look);
    // Labels that were opened first tint the scan.
    let mut harness = window_of(&labels, None);
    wait_until_idle(&mut harness);
    add(&mut harness, &scan.to_string_lossy());
    wait_until(&mut harness, "both are shown", |app| app.settings().layers.count() == 2);
    wait_until_read(&mut harness);
    assert_eq!(harness.state().volume_names(), ["scan", "labels"]);
    assert_eq!(harness.state().settings().layer_at(1).blend, LayerBlend::Tint);
    // The probe names the label that tints what is seen.
    harness.key_press(Key::I);
    let (picture, _) = harness.state().viewport_rect().expect("a picture");
    harness.hover_at(picture.center());
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("labels: Label ").is_some());
    // So do the slices at their cursor, in the middle of the volume.
    harness.key_press(Key::I);
    harness.key_press(Key::D);
    harness.run_steps(6);
    assert!(harness.query_by_label("Label 2").is_some());
}
