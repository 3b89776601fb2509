//! Tests of opening files: dropped, missing, next in the folder, and remembered.

use std::sync::Arc;
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::{self, Event, Modifiers, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    DroppedFile, SCENE, WAIT_TIMEOUT, adjusted_window, autosaved_look, click, drag, wait_until,
    wait_until_idle, window, window_without_overlays,
};

#[test]
fn a_dropped_file_opens() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ramp_8x9x10_uint8.raw");
    std::fs::write(&path, (0..720).map(|i| (i / 3) as u8).collect::<Vec<_>>()).unwrap();
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path)));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("ramp"));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_dropped_picture_brings_its_look_back() {
    let mut harness = window_without_overlays();
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first.png"), folder.path().join("second.png"));
    let ctx = harness.ctx.clone();
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    harness.state_mut().export(&first, [120, 90], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let before = harness.state().settings().clone();

    // Another look of another volume.
    harness.state_mut().open("builtin:sphere:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("sphere"));
    wait_until_idle(&mut harness);
    assert_ne!(harness.state().settings(), &before);

    // The last request wins: no look is applied to another volume.
    harness.state_mut().open(&first, &ctx);
    harness.state_mut().open("builtin:box:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box"));
    assert_ne!(harness.state().settings().lights, before.lights);

    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(first.clone())));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair"));
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().settings(), &before);
    harness.state_mut().export(&second, [120, 90], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    assert!(std::fs::read(&first).unwrap() == std::fs::read(&second).unwrap(), "all bytes, record included");
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_missing_file_leaves_the_volume_alone() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    let ctx = harness.ctx.clone();
    harness.state_mut().open("/no/such/volume.nrrd", &ctx);
    wait_until(&mut harness, "no error", |app| !app.errors().is_empty());
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("there is no such file").is_some());
    assert_eq!(harness.state().volume_name(), Some("chair"));
    assert_eq!(harness.state().settings(), &before);
    wait_until_idle(&mut harness);
}

#[test]
fn the_next_file_can_have_the_look_of_this_one() {
    let mut harness = window();
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let lights = harness.state().settings().lights.clone();
    let open_sphere = |harness: &mut Harness<'_, App>, n: usize| {
        let ctx = harness.ctx.clone();
        harness.state_mut().open(format!("builtin:sphere:{n}"), &ctx);
        let other = move |app: &App| app.volume_name() == Some("sphere") && app.is_idle();
        wait_until(harness, "never opened", other);
    };
    open_sphere(&mut harness, 16);
    assert_ne!(harness.state().settings().lights, lights, "a first look of its own");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("keep look for next".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let lights = harness.state().settings().lights.clone();
    let height = harness.state().settings().floor.height;
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:box:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box") && app.is_idle());
    assert_eq!(harness.state().settings().lights, lights);
    assert_ne!(harness.state().settings().floor.height, height, "the floor lies under the other object");
}

#[test]
fn the_first_run_has_hints_and_the_next_remembers() {
    let folder = tempfile::tempdir().unwrap();
    let start = |source: Option<&str>| {
        let options = WindowOptions {
            source: source.map(Into::into),
            storage: Some(folder.path().to_owned()),
            ..WindowOptions::default()
        };
        adjusted_window(options, Vec2::new(760.0, 900.0))
    };
    let mut harness = start(Some(SCENE));
    assert!(harness.query_by_label("Close the hints").is_some());
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let (rect, _) = harness.state().viewport_rect().unwrap();
    drag(&mut harness, rect.left_center() + vec2(30.0, 60.0), vec2(30.0, 0.0));
    harness.run_steps(20);
    assert!(harness.query_by_label("Close the hints").is_none(), "gone with the first drag");
    wait_until_idle(&mut harness);
    // No further frame is drawn: the look is autosaved nevertheless.
    let wanted = harness.state().settings().clone();
    let begin = Instant::now();
    while autosaved_look(folder.path()).as_ref() != Some(&wanted) {
        assert!(begin.elapsed() < WAIT_TIMEOUT, "the look was not kept");
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(harness);

    let mut harness = start(Some("builtin:sphere:16"));
    assert!(harness.query_by_label("Close the hints").is_none());
    click(&mut harness, "File");
    harness.get_by_label_contains("Reopen last session").click();
    harness.run_steps(3);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair") && app.is_idle());
    assert_eq!(harness.state().settings(), &wanted);
}

/// Once opened, a file whose name is not valid UTF-8 is offered again and belongs to the autosaved look.
#[cfg(unix)]
#[test]
fn a_file_whose_name_is_no_text_is_opened_again() {
    use std::os::unix::ffi::OsStrExt as _;
    let (folder, storage) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = folder.path().join(std::ffi::OsStr::from_bytes(b"t\xfcr_8x9x10_uint8.raw"));
    // Not every file system supports such names.
    if std::fs::write(&path, (0..720).map(|i| (i / 3) as u8).collect::<Vec<_>>()).is_err() {
        println!("the temporary folder has no names that are no text: nothing is checked");
        return;
    }
    let start = |source: std::path::PathBuf| {
        let (source, storage) = (Some(source), Some(storage.path().to_owned()));
        adjusted_window(
            WindowOptions { source, storage, ..WindowOptions::default() },
            Vec2::new(760.0, 900.0),
        )
    };
    let harness = start(path);
    let name = harness.state().volume_name().unwrap().to_owned();
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
    drop(harness);
    for again in ["Reopen last session", "Open recent"] {
        let mut harness = start(SCENE.into());
        assert_eq!(harness.state().volume_name(), Some("chair"));
        click(&mut harness, "File");
        harness.get_by_label_contains(again).click();
        harness.run_steps(3);
        if again == "Open recent" {
            harness.get_by_label_contains("r_8x9x10_uint8.raw").click();
            harness.run_steps(3);
        }
        wait_until(&mut harness, "never opened", |app| app.volume_name() == Some(&name) && app.is_idle());
        assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
    }
}
