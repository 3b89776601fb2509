//! Tests of the slices window on scans of bodies: orientation on the screen, and grey window.

use std::path::{Path, PathBuf};

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::{Key, PointerButton, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{adjusted_window, click, drag, drag_with, wait_until_idle, window};

/// Number of voxels along each edge.
const EDGE_VOXELS: usize = 24;

/// Writes a scan of 16-bit numbers of a ball, with grid axes in these anatomical directions.
fn write_body_scan(folder: &Path, directions: &str) -> PathBuf {
    let header = format!(
        "NRRD0005\ntype: int16\ndimension: 3\nsizes: {EDGE_VOXELS} {EDGE_VOXELS} {EDGE_VOXELS}\nendian: little\nencoding: raw\n\
         space: left-posterior-superior\nspace directions: {directions}\nspace origin: (-100,-50,20)\n\n"
    );
    let value = |at: usize| {
        let away = [at % EDGE_VOXELS, at / EDGE_VOXELS % EDGE_VOXELS, at / EDGE_VOXELS / EDGE_VOXELS]
            .map(|place| place as f64 - 11.5);
        let radius = away.iter().map(|c| c * c).sum::<f64>().sqrt();
        if radius < 8.0 { 700 + (at % 97) as i16 } else { (at % 13) as i16 }
    };
    let path = folder.join("scan.nrrd");
    let voxels = (0..EDGE_VOXELS.pow(3)).flat_map(|at| value(at).to_le_bytes());
    std::fs::write(&path, header.bytes().chain(voxels).collect::<Vec<u8>>()).expect("a file");
    path
}

fn slices_window(source: PathBuf) -> Harness<'static, App> {
    let options = WindowOptions { source: Some(source), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, vec2(1100.0, 900.0));
    harness.key_press(Key::D);
    harness.run_steps(4);
    harness
}

/// Number that a field shows.
fn field_value(harness: &Harness<'_, App>, name: &str) -> String {
    let fields = harness.get_all_by_role_and_label(Role::SpinButton, name);
    // The transfer function editor, further down, has fields of the same names.
    let field = fields.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).expect("a field");
    field.accesskit_node().value().expect("a number")
}

#[test]
fn slices_of_bodies_name_their_sides_and_their_space() {
    let folder = tempfile::tempdir().expect("a folder");
    // As scanners store them, in left-posterior-superior space.
    let mut harness = slices_window(write_body_scan(folder.path(), "(2,0,0) (0,2,0) (0,0,2)"));
    for (axis, sides) in
        [("z", "L right, R left, A top, P bottom"), ("y", "L right, R left, S top, I bottom")]
    {
        harness.get_by_label(&format!("Slice across {axis}: {sides}"));
    }
    harness.get_by_label("Slice across x: P right, A left, S top, I bottom");
    for plane in ["Axial · z = 12", "Coronal · y = 12", "Sagittal · x = 12"] {
        harness.get_by_label(plane);
    }
    // The file's left and posterior millimetres, converted to right and anterior.
    harness.get_by_label("mm RAS");
    harness.get_by_label("76.0, 26.0, 44.0");
    // A quarter to the right is towards the body's left, where x grows; upwards is its front, where y falls.
    let slice = harness.get_by_label_contains("Slice across z").rect();
    let by = vec2(slice.width() / 4.0, -slice.height() / 4.0);
    drag(&mut harness, slice.center(), by);
    harness.run_steps(2);
    harness.get_by_label("18, 6, 12");
    click(&mut harness, "Neurological");
    harness.get_by_label("Slice across z: R right, L left, A top, P bottom");
    drag(&mut harness, slice.center(), by);
    harness.run_steps(2);
    harness.get_by_label("6, 6, 12");
    assert_eq!(harness.state().errors(), [""; 0]);
    wait_until_idle(&mut harness);
}

#[test]
fn planes_are_named_by_the_body_and_not_by_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    // Sagittal slices: x of the file runs to the back, y to the feet, z to the left.
    let mut harness = slices_window(write_body_scan(folder.path(), "(0,2,0) (0,0,-2) (2,0,0)"));
    for plane in ["Axial · y = 12", "Coronal · x = 12", "Sagittal · z = 12"] {
        harness.get_by_label(plane);
    }
    harness.get_by_label("Slice across y: L right, R left, A top, P bottom");
    wait_until_idle(&mut harness);
}

#[test]
fn grey_levels_have_a_window_and_a_level_in_whole_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = slices_window(write_body_scan(folder.path(), "(2,0,0) (0,2,0) (0,0,2)"));
    let [level, width] = ["Level", "Window"].map(|name| field_value(&harness, name));
    let whole = |text: &str| text.parse::<i64>().unwrap_or_else(|_| panic!("{text} is no whole number"));
    assert!((380..420).contains(&whole(&level)) && (760..830).contains(&whole(&width)), "{level} {width}");
    // The right button drags both: up for a lower level, to the right for a wider window.
    let slice = harness.get_by_label_contains("Slice across z").rect();
    drag_with(&mut harness, PointerButton::Secondary, slice.center(), vec2(30.0, -30.0));
    harness.run_steps(2);
    assert!(whole(&field_value(&harness, "Level")) < whole(&level) - 50);
    assert!(whole(&field_value(&harness, "Window")) > whole(&width) + 50);
    wait_until_idle(&mut harness);
}

#[test]
fn slices_of_other_data_name_no_sides() {
    let mut harness = window();
    harness.key_press(Key::D);
    harness.run_steps(4);
    harness.get_by_label("Slice across z");
    harness.get_by_label("xy · z = 16");
    assert!(harness.query_by_label("Radiological").is_none() && harness.query_by_label("mm").is_some());
    wait_until_idle(&mut harness);
}
