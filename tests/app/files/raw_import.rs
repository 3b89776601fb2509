//! Tests of the raw import dialog, which asks how a file of bare voxels is stored.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use chiaroscuro::app::App;
use chiaroscuro_volume::LoadControl;
use chiaroscuro_volume_io::{LoadOptions, open};
use eframe::egui::{Key, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{DroppedFile, WAIT_TIMEOUT, click, wait_until, wait_until_idle, window};

/// Writes a volume of 40 × 32 × 24 voxels of 16 bits behind a header that describes nothing.
pub(crate) fn write_scan(folder: &Path) -> PathBuf {
    let volume =
        open("builtin:chair:40", &LoadOptions::default(), &LoadControl::new()).expect("a built-in volume");
    let mut bytes = vec![b'#'; 512];
    for (z, y, x) in (8..32).flat_map(|z| (4..36).flat_map(move |y| (0..40).map(move |x| (z, y, x)))) {
        let value = volume.density_at([x, y, z]).unwrap_or_default() * 4000.0;
        bytes.extend((value as u16).to_le_bytes());
    }
    let path = folder.join("scan.raw");
    std::fs::write(&path, bytes).expect("written");
    path
}

/// Drops a file on the window, and waits until the import dialog has analysed it.
pub(crate) fn drop_and_analyse(harness: &mut Harness<'_, App>, path: &Path) {
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(path.to_owned())));
    let start = Instant::now();
    while harness.query_by_label("Import raw volume").is_none()
        || harness.query_by_label_contains("Comparing neighbouring").is_some()
    {
        harness.step();
        assert!(start.elapsed() < WAIT_TIMEOUT, "never asked: {:?}", harness.state().errors());
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    harness.run_steps(3);
}

fn set_number(harness: &mut Harness<'_, App>, name: &str, n: f64) {
    harness.get_by_role_and_label(Role::SpinButton, name).set_value_accesskit(n);
    harness.run_steps(2);
}

fn is_open(harness: &Harness<'_, App>) -> bool {
    harness.query_by_label("Import raw volume").is_some()
}

#[test]
fn proposals_fill_the_form_and_enter_opens() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scan(folder.path());
    let mut harness = window();
    drop_and_analyse(&mut harness, &path);
    assert_eq!(harness.state().volume_name(), Some("chair"), "what is open stays");
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    assert!(harness.query_by_label("40 × 32 × 24, uint16, little-endian, header of 512 bytes").is_some());
    assert!(harness.query_by_label_contains("Bytes fit").is_some());
    harness.key_press(Key::Enter);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("scan"));
    wait_until_idle(&mut harness);
    assert!(!is_open(&harness) && harness.state().errors().is_empty());
    let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(files.len(), 1, "nothing is written that nobody asked for");
}

#[test]
fn numbers_are_checked_and_mended() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scan(folder.path());
    let mut harness = window();
    drop_and_analyse(&mut harness, &path);
    set_number(&mut harness, "Voxels along z", 30.0);
    assert!(harness.query_by_label_contains("bytes missing").is_some());
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(is_open(&harness), "what does not fit is not opened");
    click(&mut harness, "Make it 24 slices");
    assert!(harness.query_by_label_contains("Bytes fit").is_some());
    set_number(&mut harness, "Bytes before the first voxel", 0.0);
    assert!(harness.query_by_label_contains("512 bytes too many").is_some());
    click(&mut harness, "Skip them as a header");
    assert!(harness.query_by_label_contains("Bytes fit").is_some());
    set_number(&mut harness, "Voxels along x", 20.0);
    harness.get_by_label("40 × 32 × 24, uint16, little-endian, header of 512 bytes").click();
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("Bytes fit").is_some(), "a proposal fills in all numbers");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(!is_open(&harness));
    assert_eq!(harness.state().volume_name(), Some("chair"));
}

#[test]
fn numbers_can_be_typed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.raw");
    // Constant bytes give no proposal.
    std::fs::write(&path, vec![7; 9 * 8 * 10]).unwrap();
    let mut harness = window();
    drop_and_analyse(&mut harness, &path);
    for digits in ["9", "8", "10"] {
        harness.event(eframe::egui::Event::Text(digits.to_owned()));
        harness.run_steps(2);
        if digits != "10" {
            harness.key_press(Key::Tab);
            harness.run_steps(2);
        }
    }
    harness.key_press(Key::Enter);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("scan"));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn headers_are_written_when_asked_for_and_can_be_rewritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scan(folder.path());
    let header = folder.path().join("scan.nhdr");
    let mut harness = window();
    drop_and_analyse(&mut harness, &path);
    set_number(&mut harness, "Voxels along x", 80.0);
    set_number(&mut harness, "Voxels along y", 16.0);
    click(&mut harness, "Also write scan.nhdr beside the file");
    harness.key_press(Key::Enter);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("scan"));
    wait_until_idle(&mut harness);
    let wrong = std::fs::read_to_string(&header).expect("written");
    assert!(wrong.contains("sizes: 80 16 24") && wrong.contains("byte skip: 512"), "{wrong}");
    assert!(!wrong.contains("spacings"), "nobody has said how large the voxels are: {wrong}");

    drop_and_analyse(&mut harness, &path);
    click(&mut harness, "Rewrite scan.nhdr, which lies beside the file");
    click(&mut harness, "Open");
    let start = Instant::now();
    while !std::fs::read_to_string(&header).unwrap().contains("sizes: 40 32 24") {
        harness.step();
        assert!(start.elapsed() < WAIT_TIMEOUT, "never rewritten: {:?}", harness.state().errors());
    }
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn another_file_takes_the_place_of_the_question() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scan(folder.path());
    let empty = folder.path().join("empty.raw");
    std::fs::write(&empty, []).unwrap();
    let mut harness = window();
    drop_and_analyse(&mut harness, &path);
    harness.input_mut().dropped_files.push(Arc::new(DroppedFile(empty)));
    wait_until(&mut harness, "no error", |app| app.errors().iter().any(|error| error.contains("is empty")));
    harness.run_steps(2);
    assert!(!is_open(&harness), "neither is asked about any more");
    assert!(harness.query_by_label_contains("is empty").is_some());
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:sphere:16", &ctx);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("is empty").is_none(), "it was said of the file before");
}
