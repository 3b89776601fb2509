//! Tests of the bar with the time steps of a series: going through them, playback, range and export.

use std::path::{Path, PathBuf};

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::LookRecord;
use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::volume_choice::write_npy;
use crate::harness::{click, picture, sharp_window_with, wait_until, wait_until_idle};

const FORWARD: &str = "Forward by one time step";
const BACK: &str = "Back by one time step";

/// Voxel of a block that grows and becomes brighter from step to step.
fn growing_block(step: usize, at: usize) -> u8 {
    let inside = [at % 12, at / 12 % 12, at / 144];
    if inside.iter().all(|&n| n >= 2 && n < 5 + step) { 100 + 40 * step as u8 } else { (at % 7) as u8 }
}

/// Writes three time steps into one file.
fn write_steps(folder: &Path) -> PathBuf {
    let path = folder.join("steps.npy");
    write_npy(&path, "3, 12, 12, 12", 3 * 1728, |at| growing_block(at / 1728, at % 1728));
    path
}

/// Writes three time steps into numbered files; returns the second.
fn write_files(folder: &Path) -> PathBuf {
    let path = |step: usize| folder.join(format!("t{step}.npy"));
    for step in 0..3 {
        write_npy(&path(step), "12, 12, 12", 1728, |at| growing_block(step, at));
    }
    path(1)
}

fn window_of(source: &Path, session: Option<&Path>) -> Harness<'static, App> {
    let session = session.map(Path::to_owned);
    let options = WindowOptions { source: Some(source.to_owned()), session, ..WindowOptions::default() };
    sharp_window_with(options, Vec2::new(900.0, 700.0))
}

fn press(harness: &mut Harness<'_, App>, key: Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

fn go(harness: &mut Harness<'_, App>, label: &str) {
    click(harness, label);
    wait_until_idle(harness);
}

#[test]
fn steps_are_shown_one_after_the_other_with_one_look() {
    let folder = tempfile::tempdir().unwrap();
    let session = folder.path().join("s.json");
    let mut harness = window_of(&write_steps(folder.path()), Some(&session));
    assert_eq!(harness.state().time_step(), Some((0, 3)));
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    let (look, ranges) = (harness.state().settings().clone(), harness.state().ranges());
    let first = picture(&mut harness);
    go(&mut harness, FORWARD);
    assert_eq!(harness.state().time_step(), Some((1, 3)));
    let second = picture(&mut harness);
    assert!(second != first, "another step is another picture");
    go(&mut harness, FORWARD);
    go(&mut harness, FORWARD);
    assert_eq!(harness.state().time_step(), Some((2, 3)), "there is no fourth");
    assert_eq!(harness.state().settings(), &look, "the look stays");
    assert_eq!(harness.state().ranges(), ranges, "and so do the colours");
    go(&mut harness, BACK);
    assert!(picture(&mut harness) == second, "as before");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(3);
    let record = LookRecord::parse(&std::fs::read_to_string(&session).unwrap()).unwrap();
    assert_eq!(record.volume.unwrap().choice.frame, Some(1), "the session names the step");
    go(&mut harness, BACK);
    assert!(picture(&mut harness) == first, "as before");
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_series_plays_until_it_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_steps(folder.path()), None);
    let look = harness.state().settings().clone();
    press(&mut harness, Key::Y);
    for step in [1, 2, 0, 1] {
        wait_until(&mut harness, "the next step", |app| app.time_step() == Some((step, 3)));
    }
    assert!(!harness.state().is_idle());
    press(&mut harness, Key::Y);
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().settings(), &look);
    // Without a loop it ends at the last step.
    click(&mut harness, "Loop");
    click(&mut harness, "Play");
    wait_until(&mut harness, "the end", |app| app.time_step() == Some((2, 3)));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn numbered_files_are_steps_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_files(folder.path()), None);
    assert_eq!(harness.state().time_step(), None);
    press(&mut harness, Key::Y);
    assert_eq!(harness.state().time_step(), Some((1, 3)));
    go(&mut harness, FORWARD);
    assert_eq!(harness.state().volume_name(), Some("t2"));
    go(&mut harness, "Close");
    assert_eq!(harness.state().time_step(), None);
    assert_eq!(harness.state().volume_name(), Some("t2"), "the volume stays");
}

#[test]
fn the_range_of_all_steps_is_used_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_steps(folder.path()), None);
    assert_eq!(harness.state().ranges().unwrap().all.high, 100.0);
    let highest = |app: &App| app.settings().layer().transfer.points.last().unwrap().value;
    let before = highest(harness.state());
    go(&mut harness, "Range of all steps");
    assert_eq!(harness.state().ranges().unwrap().all.high, 180.0);
    assert!(highest(harness.state()) > 1.5 * before, "the curve reaches up to the brightest step");
    go(&mut harness, FORWARD);
    assert_eq!(harness.state().ranges().unwrap().all.high, 180.0, "of every step");
}

#[test]
fn a_step_that_cannot_be_read_leaves_the_one_that_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let source = write_files(folder.path());
    std::fs::write(folder.path().join("t2.npy"), b"\x93NUMPY\x01\x00 torn").unwrap();
    let mut harness = window_of(&source, None);
    press(&mut harness, Key::Y);
    go(&mut harness, FORWARD);
    assert_eq!(
        (harness.state().time_step(), harness.state().volume_name()),
        (Some((1, 3)), Some("t1")),
        "it stays"
    );
    let errors = harness.state().errors().join("\n");
    assert!(errors.contains("t2.npy"), "{errors}");
    go(&mut harness, BACK);
    assert_eq!(harness.state().volume_name(), Some("t0"), "others can be shown");
    // Mended meanwhile, it is read.
    write_npy(&folder.path().join("t2.npy"), "12, 12, 12", 1728, |at| growing_block(2, at));
    go(&mut harness, FORWARD);
    go(&mut harness, FORWARD);
    assert_eq!(harness.state().volume_name(), Some("t2"));
}

#[test]
fn layers_of_the_file_follow_and_going_to_a_step_is_no_step_of_the_history() {
    let folder = tempfile::tempdir().unwrap();
    let source = write_steps(folder.path());
    let mut harness = window_of(&source, None);
    let ctx = harness.ctx.clone();
    harness.state_mut().add_layer(&source, &ctx);
    harness.run_steps(4);
    wait_until(&mut harness, "the layer is read", |app| app.volume_names().len() == 2);
    wait_until_idle(&mut harness);
    harness.run_steps(8);
    let look = harness.state().settings().clone();
    go(&mut harness, FORWARD);
    harness.run_steps(8);
    assert_eq!((harness.state().settings(), harness.state().volume_names().len()), (&look, 2));
    // The addition of the layer is undone and redone, at the step that is shown.
    for (key, count) in [(Modifiers::COMMAND, 1), (Modifiers::COMMAND.plus(Modifiers::SHIFT), 2)] {
        harness.key_press_modifiers(key, Key::Z);
        harness.run_steps(3);
        wait_until_idle(&mut harness);
        assert_eq!(harness.state().settings().layers.count(), count);
        assert_eq!(
            (harness.state().volume_names().len(), harness.state().time_step()),
            (count, Some((1, 3)))
        );
    }
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_series_is_exported_step_by_step() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_of(&write_steps(folder.path()), None);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
    harness.run_steps(4);
    click(&mut harness, "Time series");
    assert!(harness.query_by_label("3 time steps").is_some());
    let ctx = harness.ctx.clone();
    let target = folder.path().join("film");
    harness.state_mut().export(&target, [48, 36], &ctx);
    wait_until(&mut harness, "the series is exported", |app| !app.is_exporting());
    harness.run_steps(3);
    assert!(harness.state().errors().is_empty(), "{:?}", harness.state().errors());
    let mut files: Vec<_> = std::fs::read_dir(&target).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    let frames: Vec<_> = files
        .iter()
        .map(|file| {
            let record = chiaroscuro_media::read_record(file).unwrap().unwrap();
            LookRecord::parse(&record).unwrap().volume.unwrap().choice.frame
        })
        .collect();
    assert_eq!(frames, [Some(0), Some(1), Some(2)]);
}
