//! Tests of the dialog that asks how much of a large volume to load.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{LevelRule, synthetic};
use chiaroscuro_volume_io::LoadOptions;
use chiaroscuro_volume_io::write::{ExportVolume, VolumeFormat, write_volume};
use eframe::egui::{Key, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    DroppedFile, SCENE, adjusted_window, click, picture, sharp_window_with, wait_until, wait_until_idle,
};

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

/// Window of a file whose finest level counts as too large, near the object.
fn window_beside_pages(path: &Path, finer_levels: bool) -> Harness<'static, App> {
    let load = LoadOptions { level: LevelRule::AlwaysBesidePages(1 << 24), ..LoadOptions::default() };
    let adjust = move |mut settings: Settings| {
        settings.sampling.finer_levels = finer_levels;
        settings.camera.distance *= 0.4;
        settings
    };
    let options = WindowOptions {
        source: Some(path.to_owned()),
        load,
        adjust: Some(Box::new(adjust)),
        ..WindowOptions::default()
    };
    sharp_window_with(options, Vec2::new(900.0, 700.0))
}

#[test]
fn parts_of_finer_levels_arrive_in_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("chair.ome.zarr");
    let chair = synthetic::builtin("chair", Some(160)).expect("a volume");
    write_volume(&path, VolumeFormat::OmeZarr, &ExportVolume::new(&chair), true).expect("written");
    let mut coarse = window_beside_pages(&path, false);
    assert!(is_shown(&coarse, "80×80×80"), "the finest level is not in memory");
    let alone = picture(&mut coarse);
    drop(coarse);
    let mut harness = window_beside_pages(&path, true);
    let is_complete = |harness: &Harness<'_, App>| harness.query_by_label("Level 0").is_some();
    for _ in 0..600 {
        if is_complete(&harness) {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
        harness.run_steps(1);
    }
    assert!(is_complete(&harness), "{:?}", harness.state().errors());
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness) != alone, "the finest level shows more");
    // Parts that were read stay while the camera moves.
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(3);
    wait_until_idle(&mut harness);
    for section_or_row in ["Data", "Finer levels"] {
        harness.get_by_label(section_or_row).scroll_to_me();
        harness.run_steps(8);
        click(&mut harness, section_or_row);
        harness.run_steps(8);
    }
    wait_until_idle(&mut harness);
    harness.run_steps(3);
    assert!(!is_complete(&harness), "the level in memory is shown alone");
    assert_eq!(harness.state().errors(), [""; 0]);
}
