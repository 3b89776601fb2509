//! Tests of the dialog that asks how much of a large volume to load.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use chiaroscuro::app::{App, Options};
use chiaroscuro::data::load::LoadOptions;
use eframe::egui::{Key, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{Dropped, SCENE, click, wait_until, wait_until_idle, window_with};

const QUESTION: &str = "A large volume: how much of it?";

/// Writes 64³ voxels of a byte: 340 KB with their brick data, and 1.6 MB on the adapter.
fn large(folder: &Path) -> PathBuf {
    let path = folder.join("large_64x64x64_uint8.raw");
    let value = |at: usize| ((at % 64) * 2 + (at / 64 % 64) + at / 4096) as u8;
    std::fs::write(&path, (0..64 * 64 * 64).map(value).collect::<Vec<_>>()).expect("written");
    path
}

/// Creates a window with a memory budget of 300 KB without a question, and 400 KB in total: not even that on adapters
/// that share the memory. The scene, of 32³ voxels, takes 250 KB of both.
fn little_window() -> Harness<'static, App> {
    let load = LoadOptions { memory_budget_bytes: 300 << 10, ..LoadOptions::default() };
    let options = Options { source: Some(SCENE.into()), load, ..Options::default() };
    window_with(options, Vec2::new(760.0, 1100.0))
}

fn ask_about(harness: &mut Harness<'_, App>, path: &Path) {
    harness.input_mut().dropped_files.push(Arc::new(Dropped(path.to_owned())));
    harness.run_steps(2);
    wait_until(harness, "never read", App::is_idle);
    harness.run_steps(3);
    assert!(harness.query_by_label(QUESTION).is_some(), "{:?}", harness.state().errors());
}

fn is_said(harness: &Harness<'_, App>, words: &str) -> bool {
    harness.query_all_by_label_contains(words).next().is_some()
}

#[test]
fn who_opens_a_large_volume_is_asked_how_much_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = large(folder.path());
    let mut harness = little_window();
    ask_about(&mut harness, &path);
    assert_eq!(harness.state().volume_name(), Some("chair"), "what is open stays");
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    for words in
        ["holds 64 × 64 × 64 voxels of uint8, 256.0 KiB", "400.0 KiB are free", "32 × 32 × 32 voxels, 41."]
    {
        assert!(is_said(&harness, words), "{words}");
    }
    click(&mut harness, "Every second voxel");
    click(&mut harness, "Open this much");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("large"));
    wait_until_idle(&mut harness);
    harness.run_steps(3);
    assert!(harness.query_by_label(QUESTION).is_none());
    assert!(is_said(&harness, "32×32×32"), "the title says how many are shown");
    assert_eq!(harness.state().errors(), [""; 0]);
}

#[test]
fn a_region_is_typed_and_nothing_can_be_opened_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let path = large(folder.path());
    let mut harness = little_window();
    ask_about(&mut harness, &path);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label(QUESTION).is_none());
    assert_eq!((harness.state().volume_name(), harness.state().errors().len()), (Some("chair"), 0));

    ask_about(&mut harness, &path);
    for (name, n) in [
        ("First voxel along x", 8.0),
        ("End along x", 28.0),
        ("First voxel along y", 0.0),
        ("End along y", 24.0),
        ("First voxel along z", 10.0),
        ("End along z", 26.0),
    ] {
        harness.get_by_role_and_label(Role::SpinButton, name).set_value_accesskit(n);
        harness.run_steps(2);
    }
    assert!(is_said(&harness, "20 × 24 × 16 voxels"), "its size is said at once");
    harness.key_press(Key::Enter);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("large"));
    wait_until_idle(&mut harness);
    harness.run_steps(3);
    assert!(is_said(&harness, "20×24×16"));
    assert_eq!(harness.state().errors(), [""; 0]);
}
