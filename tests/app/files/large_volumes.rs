//! Tests of the dialog that asks how much of a large volume to load.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_volume_io::LoadOptions;
use eframe::egui::{Key, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{DroppedFile, SCENE, adjusted_window, click, wait_until, wait_until_idle};

const QUESTION: &str = "Large volume: how much to open?";

/// Writes 64³ voxels of a byte: 340 KB with their brick data, and 1.6 MB on the adapter.
fn write_large_volume(folder: &Path) -> PathBuf {
    let path = folder.join("large_64x64x64_uint8.raw");
    let value = |at: usize| ((at % 64) * 2 + (at / 64 % 64) + at / 4096) as u8;
    std::fs::write(&path, (0..64 * 64 * 64).map(value).collect::<Vec<_>>()).expect("written");
    path
}

/// Creates a window with a memory budget of 300 KB without a question, and 400 KB in total: not even that on adapters
/// that share the memory. The scene, of 32³ voxels, takes 250 KB of both.
fn low_memory_window() -> Harness<'static, App> {
    let load = LoadOptions { memory_budget_bytes: 300 << 10, ..LoadOptions::default() };
    let options = WindowOptions { source: Some(SCENE.into()), load, ..WindowOptions::default() };
    adjusted_window(options, Vec2::new(760.0, 1100.0))
}

fn ask_about(harness: &mut Harness<'_, App>, path: &Path) {
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path.to_owned())));
    harness.run_steps(2);
    wait_until(harness, "never read", App::is_idle);
    harness.run_steps(3);
    assert!(harness.query_by_label(QUESTION).is_some(), "{:?}", harness.state().errors());
}

fn is_shown(harness: &Harness<'_, App>, words: &str) -> bool {
    harness.query_all_by_label_contains(words).next().is_some()
}

#[test]
fn opening_a_large_volume_asks_for_a_portion() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_large_volume(folder.path());
    let mut harness = low_memory_window();
    ask_about(&mut harness, &path);
    assert_eq!(harness.state().volume_name(), Some("chair"), "what is open stays");
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    for words in
        ["holds 64 × 64 × 64 voxels of uint8, 256.0 KiB", "400.0 KiB are free", "32 × 32 × 32 voxels, 41."]
    {
        assert!(is_shown(&harness, words), "{words}");
    }
    click(&mut harness, "Every second voxel");
    click(&mut harness, "Open this much");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("large"));
    wait_until_idle(&mut harness);
    harness.run_steps(3);
    assert!(harness.query_by_label(QUESTION).is_none());
    assert!(is_shown(&harness, "32×32×32"), "the title says how many are shown");
    assert_eq!(harness.state().errors(), [""; 0]);
}

#[test]
fn a_region_can_be_typed_and_cancelled() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_large_volume(folder.path());
    let mut harness = low_memory_window();
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
    assert!(is_shown(&harness, "20 × 24 × 16 voxels"), "its size is said at once");
    harness.key_press(Key::Enter);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("large"));
    wait_until_idle(&mut harness);
    harness.run_steps(3);
    assert!(is_shown(&harness, "20×24×16"));
    assert_eq!(harness.state().errors(), [""; 0]);
}
