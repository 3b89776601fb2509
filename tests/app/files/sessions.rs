//! Tests of saved sessions, and of crash recovery.

use std::path::Path;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LookRecord, Settings, VolumeRecord};
use chiaroscuro_volume::ValueRanges;
use eframe::egui::{self, Modifiers, Vec2, ViewportEvent, ViewportId};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{SCENE, adjusted_window, automatic_window, autosaved_look, click, wait_until, window};

/// Creates a window with a session file, changes the look, and presses Ctrl+S.
fn changed_and_saved(session: &Path) -> Harness<'static, App> {
    let options = WindowOptions {
        source: Some(SCENE.into()),
        session: Some(session.to_owned()),
        ..WindowOptions::default()
    };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 900.0));
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::S);
    harness.run_steps(3);
    harness
}

#[test]
fn the_session_is_written_when_the_window_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("preset.json"), r#"{"shadows": {"gain": 2.0}}"#).unwrap();
    // A file that is no session stays as it is.
    for (name, saves_on_close, is_written) in
        [("asked.json", true, true), ("unasked.json", false, false), ("preset.json", true, false)]
    {
        let before = std::fs::read(path(name)).unwrap_or_default();
        let session = Some(path(name));
        let options =
            WindowOptions { source: Some(SCENE.into()), session, saves_on_close, ..WindowOptions::default() };
        let mut harness = adjusted_window(options, Vec2::new(760.0, 900.0));
        harness.key_press(egui::Key::CloseBracket);
        harness.run_steps(2);
        let shown = harness.state().settings().clone();
        eframe::App::on_exit(harness.state_mut());
        let after = std::fs::read(path(name)).unwrap_or_default();
        assert_eq!(after != before, is_written, "{name}");
        if is_written {
            let record = LookRecord::from_bytes(&after).unwrap();
            let read = record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings;
            assert_eq!(read.lights, shown.lights);
            assert_eq!(read.camera, shown.camera);
        }
    }
}

fn backup(session: &Path) -> std::path::PathBuf {
    std::path::PathBuf::from(format!("{}.bak", session.display()))
}

#[test]
fn other_files_are_not_overwritten_as_sessions() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut harness = window();
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&path("picture.png"), [40, 30], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    drop(harness);
    let written = [
        ("newer.json", r#"{"schema": 999, "future": {"a": 1}}"#),
        ("preset.json", r#"{"shadows": {"gain": 2.0}}"#),
        ("wrong.json", r#"{"schema": 2, "shadows": {"gain": "much"}}"#),
        ("broken.json", r#"{"schema": 2, "#),
        ("volume.nrrd", "NRRD0004\n"),
    ];
    for (name, text) in written {
        std::fs::write(path(name), text).unwrap();
    }
    for name in written.map(|(name, _)| name).into_iter().chain(["picture.png"]) {
        let before = std::fs::read(path(name)).unwrap();
        let harness = changed_and_saved(&path(name));
        assert!(harness.query_by_label_contains("was not overwritten").is_some(), "{name}");
        assert!(std::fs::read(path(name)).unwrap() == before, "{name}");
        assert!(!backup(&path(name)).exists());
    }
}

#[test]
fn unknown_fields_and_a_backup_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let session = folder.path().join("s.json");
    let before = r#"{"schema": 2, "_notes": "mine", "shadows": {"gain": 2.0, "glow": 3}}"#;
    std::fs::write(&session, before).unwrap();
    let mut harness = changed_and_saved(&session);
    let text = std::fs::read_to_string(&session).unwrap();
    let tree: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&tree["_notes"], &tree["shadows"]["glow"]), (&"mine".into(), &3.into()));
    assert_eq!(tree["shadows"]["gain"], 2.0);
    assert_eq!(std::fs::read_to_string(backup(&session)).unwrap(), before);
    // Saved again: the backup is the previous session.
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::S);
    harness.run_steps(3);
    assert_ne!(std::fs::read_to_string(&session).unwrap(), text);
    assert_eq!(std::fs::read_to_string(backup(&session)).unwrap(), text);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_killed_run_is_offered_for_recovery() {
    let folder = tempfile::tempdir().unwrap();
    let start = || {
        let options = WindowOptions {
            source: Some("builtin:sphere:16".into()),
            storage: Some(folder.path().to_owned()),
            ..WindowOptions::default()
        };
        adjusted_window(options, Vec2::new(760.0, 900.0))
    };
    // Leaves the files of a process that was killed.
    let mut look = window().state().settings().clone();
    look.shadows.gain = 1.75;
    let volume = VolumeRecord::new(Path::new(SCENE), 0, None);
    std::fs::create_dir(folder.path().join("runs")).unwrap();
    let file = folder.path().join("runs/0000000000001-1-0.json");
    std::fs::write(&file, LookRecord::to_json(&look, Some(&volume), None)).unwrap();
    std::fs::write(file.with_extension("lock"), "").unwrap();

    let mut harness = start();
    let offer = "Reopen the last session?";
    assert!(harness.query_by_label(offer).is_some());
    click(&mut harness, "Not now");
    assert!(harness.query_by_label(offer).is_none());
    drop(harness);
    let harness = start();
    assert!(harness.query_by_label(offer).is_none(), "the user knows");
    drop(harness);

    std::fs::write(file.with_extension("lock"), "").unwrap();
    let mut harness = start();
    click(&mut harness, "Reopen");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair") && app.is_idle());
    assert_eq!(harness.state().settings().shadows.gain, 1.75);
    assert!(file.exists(), "and it stays");
    drop(harness);
    assert_eq!(autosaved_look(folder.path()).expect("a look").shadows.gain, 1.75);
}

/// Nothing is opened behind the question about the last session.
#[test]
fn the_question_about_the_last_session_comes_first() {
    for (answer, gain) in [("Not now", None), ("Reopen", Some(1.75))] {
        let folder = tempfile::tempdir().unwrap();
        let mut look = Settings::default();
        look.shadows.gain = 1.75;
        std::fs::create_dir(folder.path().join("runs")).unwrap();
        let file = folder.path().join("runs/0000000000001-1-0.json");
        let volume = VolumeRecord::new(Path::new("builtin:sphere:16"), 0, None);
        std::fs::write(&file, LookRecord::to_json(&look, Some(&volume), None)).unwrap();
        std::fs::write(file.with_extension("lock"), "").unwrap();
        let options = WindowOptions { storage: Some(folder.path().to_owned()), ..WindowOptions::default() };
        let mut harness = automatic_window(options);
        harness.run_steps(30);
        assert!(harness.query_by_label("Reopen the last session?").is_some());
        assert!(harness.query_by_label("Recent files").is_none(), "the start screen comes after it");
        assert_eq!(harness.state().volume_name(), None);
        click(&mut harness, answer);
        if let Some(gain) = gain {
            wait_until(&mut harness, "never opened", |app| app.volume_name().is_some());
            assert_eq!(harness.state().volume_name(), Some("sphere"));
            assert_eq!(harness.state().settings().shadows.gain, gain);
            assert!(!harness.state().shows_start());
        } else {
            harness.run_steps(3);
            assert!(harness.state().shows_start() && harness.state().volume_name().is_none());
            assert!(harness.query_by_label("Recent files").is_some(), "the start screen");
        }
    }
}

#[test]
fn after_three_failed_starts_the_file_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("runs")).unwrap();
    for at in 1..=3 {
        std::fs::write(folder.path().join(format!("runs/000000000000{at}-1-0.lock")), "").unwrap();
    }
    let start = || {
        let options = WindowOptions {
            source: Some("builtin:sphere:16".into()),
            storage: Some(folder.path().to_owned()),
            adjust: Some(Box::new(|settings| settings)),
            ..WindowOptions::default()
        };
        adjusted_window(options, Vec2::new(760.0, 900.0))
    };
    let mut harness = start();
    assert!(harness.state().shows_start() && harness.state().volume_name().is_none());
    harness.run_steps(3);
    assert!(
        harness.query_by_label_contains("Not everything works as usual: ").is_some(),
        "with the reason in the row"
    );
    // A start has succeeded when there is a look.
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:box:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box") && app.is_idle());
    drop(harness);
    assert_eq!(start().state().volume_name(), Some("sphere"), "one start was enough");
}

#[test]
fn quitting_while_a_picture_is_exported_asks() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.png");
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&path, [1200, 900], &ctx);
    let close = |harness: &mut Harness<'_, App>| {
        let viewport = harness.input_mut().viewports.entry(ViewportId::ROOT).or_default();
        viewport.events.push(ViewportEvent::Close);
        harness.run_steps(3);
    };
    close(&mut harness);
    let question = "Quit while a picture is being exported?";
    assert!(harness.query_by_label(question).is_some());
    harness.get_by_label("Stay").click();
    harness.run_steps(2);
    assert!(harness.query_by_label(question).is_none());
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    close(&mut harness);
    assert!(harness.query_by_label(question).is_none(), "nothing is lost");
    assert!(path.exists());
}
