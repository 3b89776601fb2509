//! Tests of the menu bar and status bar: long names, and the state of the renderer.

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::{Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{adjusted_window, click, wait_until_idle, window};

/// Text of the first label that contains a string.
fn words(harness: &Harness<'_, App>, part: &str) -> String {
    let labels = harness.get_all_by_role(Role::Label);
    labels
        .filter_map(|node| node.accesskit_node().value())
        .find(|words| words.contains(part))
        .unwrap_or_default()
}

#[test]
fn long_names_of_files_leave_room_for_what_is_said_of_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = "subject_0042_session_03_acquisition_high_resolution_run_17_T1w_defaced";
    let path = folder.path().join(format!("{name}.nrrd"));
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 8 9 10\n\
                  space directions: (0.5,0,0) (0,0.5,0) (0,0,1.25)\nspace origin: (0,0,0)\nencoding: raw\n\n";
    let voxels: Vec<u8> = (0..720).map(|at| (at % 200) as u8).collect();
    std::fs::write(&path, [header.as_bytes(), &voxels].concat()).expect("written");
    let options = WindowOptions { source: Some(path), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, Vec2::new(640.0, 400.0));
    let facts = "8×9×10 · 0.500×0.500×1.250 mm";
    let title = words(&harness, facts);
    assert!(title.starts_with("subject") && title.contains('…') && title.ends_with(facts), "{title}");
    assert!(title.contains("defaced · 8×9×10"), "the end of the name stays: {title}");
    let shown = harness.get_by_label(&title).rect();
    assert!(shown.right() <= 640.0 && shown.left() > 180.0, "{shown}");
    // In a wide window nothing is elided.
    harness.set_size(Vec2::new(1280.0, 800.0));
    harness.run_steps(4);
    assert!(words(&harness, facts).starts_with(name));
    wait_until_idle(&mut harness);
}

#[test]
fn the_status_bar_says_what_is_waited_for_and_the_rest_behind_a_click() {
    let mut harness = window();
    assert!(harness.query_by_label("Sharp").is_some());
    let is_shown =
        |harness: &Harness<'_, App>, part: &str| harness.query_all_by_label_contains(part).next().is_some();
    for jargon in [" ms", "cached", "filled", "MiB ·"] {
        assert!(!is_shown(&harness, jargon), "{jargon}");
    }
    click(&mut harness, "Performance");
    for known in ["Light volumes", "Graphics memory", "Graphics device", "Driver"] {
        assert!(is_shown(&harness, known), "{known}");
    }
    assert!(is_shown(&harness, " ms"));
    harness.key_press(eframe::egui::Key::Escape);
    harness.run_steps(3);
    assert!(!is_shown(&harness, "Graphics memory"));
}
