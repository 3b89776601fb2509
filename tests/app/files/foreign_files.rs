//! Tests of files of other programs, read while the window stays responsive.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::{self, Key};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{adjusted_window, block_file_tasks, click, wait_until, wait_until_idle, window};

/// Longest frame while a file is read, on a machine that is busy with other tests.
const LONGEST_FRAME: Duration = Duration::from_secs(5);

/// Transfer function file of Inviwo, with additional XML before its points.
fn inviwo_transfer_function(before: &str) -> String {
    let point = |share: f64| {
        format!("<Point><pos content=\"{share}\"/><rgba x=\"1\" y=\"0\" z=\"0\" w=\"{share}\"/></Point>")
    };
    format!("<InviwoWorkspace>{before}<Points>{}{}</Points></InviwoWorkspace>", point(0.25), point(0.75))
}

fn write_file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the folder can be written to");
    path
}

/// Runs frames until the file is read; none may take long.
fn wait_for_file(harness: &mut Harness<'_, App>) {
    loop {
        let start = Instant::now();
        harness.step();
        assert!(start.elapsed() < LONGEST_FRAME, "the window stood still for {:?}", start.elapsed());
        if harness.state().file_being_read().is_none() {
            return;
        }
    }
}

#[test]
fn a_transfer_function_is_imported_while_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_file(folder.path(), "red.itf", &inviwo_transfer_function(""));
    let mut harness = window();
    let ctx = harness.ctx.clone();
    let held = block_file_tasks();
    harness.state_mut().import_transfer(&path, &ctx);
    harness.run_steps(2);
    assert_eq!(harness.state().file_being_read(), Some(path.as_path()));
    assert!(harness.query_all_by_label_contains("Reading").next().is_some(), "the status bar says so");
    // Keys are handled meanwhile.
    harness.key_press(Key::F1);
    harness.run_steps(2);
    assert!(harness.query_all_by_label_contains("Keys and mouse").next().is_some());
    harness.key_press(Key::F1);
    harness.run_steps(2);
    drop(held);
    wait_for_file(&mut harness);
    let points = &harness.state().settings().layer().transfer.points;
    assert_eq!((points.len(), points[1].opacity), (2, 0.75));
    wait_until_idle(&mut harness);
}

#[test]
fn reading_is_cancelled_by_escape_and_by_the_button() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_file(folder.path(), "red.itf", &inviwo_transfer_function(""));
    let mut harness = window();
    let ctx = harness.ctx.clone();
    let before = harness.state().settings().layer().transfer.clone();
    for by_key in [true, false] {
        let held = block_file_tasks();
        harness.state_mut().import_transfer(&path, &ctx);
        harness.run_steps(2);
        if by_key {
            harness.key_press(Key::Escape);
            harness.run_steps(2);
        } else {
            click(&mut harness, "Cancel");
        }
        assert_eq!(harness.state().file_being_read(), None);
        assert_eq!(harness.state().latest_note(), Some("Reading was cancelled"));
        drop(held);
        wait_until_idle(&mut harness);
        assert_eq!(harness.state().settings().layer().transfer, before, "by key: {by_key}");
    }
    assert!(harness.state().errors().is_empty());
}

#[test]
fn xml_that_would_take_minutes_is_refused_within_a_frame_or_two() {
    let folder = tempfile::tempdir().expect("a folder");
    let declared = (0..4000).map(|at| format!(" xmlns:a{at}=\"u{at}\"")).collect::<Vec<String>>().concat();
    let cubic = format!("<p{declared}>{}</p>", "<x xmlns:q=\"z\"/>".repeat(4000));
    let attributes = (0..60_000).map(|at| format!(" a{at}=\"\"")).collect::<Vec<String>>().concat();
    let square = format!("<p{attributes}/>");
    let mut harness = window();
    let ctx = harness.ctx.clone();
    let before = harness.state().settings().layer().transfer.clone();
    for (name, text) in [("cubic.itf", cubic), ("square.tfi", square)] {
        let path = write_file(folder.path(), name, &inviwo_transfer_function(&text));
        harness.state_mut().import_transfer(&path, &ctx);
        wait_for_file(&mut harness);
        let error = harness.state().errors().last().expect("an error").clone();
        assert_eq!(error, "The transfer function was not imported", "{name}");
        // The error message appears with the next frame.
        harness.run_steps(2);
        click(&mut harness, "Details");
        for words in [name, "more attributes and namespaces than can be compared"] {
            assert!(harness.query_all_by_label_contains(words).next().is_some(), "{words}");
        }
        assert_eq!(harness.state().settings().layer().transfer, before, "{name}");
    }
    assert_eq!(harness.state().errors().len(), 2);
}

#[test]
fn looks_that_are_named_at_the_start_are_read_while_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let look = write_file(folder.path(), "look.json", r#"{"shadows": {"gain": 2.5}}"#);
    let session =
        write_file(folder.path(), "session.json", r#"{"schema": 1, "camera": {"fov_y_deg": 21.0}}"#);
    let broken = write_file(folder.path(), "broken.json", "{");
    let size = egui::Vec2::new(760.0, 1140.0);
    let (source, volume) = (Some(look), Some(crate::harness::SCENE.into()));
    let options =
        WindowOptions { source, volume, session: Some(session.clone()), ..WindowOptions::default() };
    let harness = adjusted_window(options, size);
    assert_eq!(harness.state().settings().shadows.gain, 2.5, "the look");
    assert_eq!(harness.state().settings().camera.fov_y_deg, 21.0, "the session");
    // A file that cannot be read leads to the start screen.
    let harness = adjusted_window(WindowOptions { source: Some(broken), ..WindowOptions::default() }, size);
    assert!(harness.state().shows_start() && harness.state().errors().len() == 1);
    // If the wait for the session is cancelled, the volume opens without it.
    let source = Some(crate::harness::SCENE.into());
    let held = block_file_tasks();
    let options = WindowOptions { source, session: Some(session), ..WindowOptions::default() };
    let mut harness = crate::harness::automatic_window(options);
    wait_until(&mut harness, "the session is read", |app| app.file_being_read().is_some());
    assert_eq!(harness.state().volume_name(), None);
    harness.key_press(Key::Escape);
    wait_until(&mut harness, "the volume is there", |app| app.volume_name().is_some());
    assert_ne!(harness.state().settings().camera.fov_y_deg, 21.0);
    drop(held);
    wait_until_idle(&mut harness);
}
