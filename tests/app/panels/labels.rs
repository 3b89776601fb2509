//! Tests of the table of labels, and of its effects on the picture.

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::{self, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{adjusted_window, click, click_at as press_at, picture, wait_until_idle};

/// Number of voxels along each edge of the label map.
const EDGE_VOXELS: usize = 24;

/// Creates a window with a label map: slabs of these labels along x, with a margin of label 0.
fn label_map_window(labels: &[u8]) -> (Harness<'static, App>, tempfile::TempDir) {
    let header = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: {EDGE_VOXELS} {EDGE_VOXELS} {EDGE_VOXELS}\nencoding: raw\nmodality:=SEG\n\
         Segment0_Name:=Left lung\nSegment0_LabelValue:=9\n\n"
    );
    let inner = EDGE_VOXELS - 4;
    let value = |at: usize| {
        let place = [at % EDGE_VOXELS, at / EDGE_VOXELS % EDGE_VOXELS, at / EDGE_VOXELS / EDGE_VOXELS];
        let is_inside = place.iter().all(|c| (2..EDGE_VOXELS - 2).contains(c));
        if is_inside { labels[(place[0] - 2) * labels.len() / inner] } else { 0 }
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("labels.nrrd");
    let file: Vec<u8> =
        header.bytes().chain((0..EDGE_VOXELS * EDGE_VOXELS * EDGE_VOXELS).map(value)).collect();
    std::fs::write(&path, file).expect("a file");
    let options = WindowOptions { source: Some(path), ..WindowOptions::default() };
    (adjusted_window(options, Vec2::new(760.0, 1300.0)), folder)
}

/// Numbers of the labels that are visible.
fn visible_labels(harness: &Harness<'_, App>) -> Vec<i64> {
    let labels = &harness.state().settings().layer().labels;
    labels.iter().filter(|(_, look)| look.visible).map(|(number, _)| number).collect()
}

fn press(harness: &mut Harness<'_, App>, label: &str) {
    click(harness, label);
    wait_until_idle(harness);
    harness.run_steps(2);
}

#[test]
fn labels_are_hidden_and_shown_by_their_rows() {
    let (mut harness, _folder) = label_map_window(&[3, 9, 200]);
    assert_eq!(visible_labels(&harness), [3, 9, 200]);
    let unnamed = harness.unnamed_widgets();
    assert!(unnamed.is_empty(), "{unnamed:#?}");
    let (all, _) = picture(&mut harness);
    press(&mut harness, "Show label 9");
    assert_eq!(visible_labels(&harness), [3, 200]);
    let (two, _) = picture(&mut harness);
    assert!(two != all, "one is gone");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(visible_labels(&harness), [3, 9, 200], "one step back");
    assert!(picture(&mut harness).0 == all);
    press(&mut harness, "Only label 200");
    assert_eq!(visible_labels(&harness), [200]);
    harness.get_by_label("Name of label 200").focus();
    harness.get_by_label("Name of label 200").type_text("Rib");
    harness.run_steps(3);
    assert_eq!(
        harness.state().settings().layer().labels.get(200).map(|look| look.name.as_str()),
        Some("Rib")
    );
    press(&mut harness, "Show listed");
    assert_eq!(visible_labels(&harness), [3, 9, 200], "but not what is around them");
    press(&mut harness, "Hide listed");
    assert_eq!(visible_labels(&harness), [0; 0]);
    assert_eq!(harness.state().errors(), [""; 0]);
}

/// The table is below the picture, with a header over its columns, and the probe names the label under the pointer.
#[test]
fn the_table_is_below_the_picture_and_the_probe_names_labels() {
    let (mut harness, _folder) = label_map_window(&[9, 9, 9]);
    let (picture, _) = harness.state().viewport_rect().expect("a picture");
    let row = harness.get_by_label("Show label 9").rect();
    assert!(row.top() > picture.bottom() && row.left() < picture.center().x, "{row} below {picture}");
    for column in ["Show", "Colour", "Label", "Name", "Voxels", "Opacity"] {
        // The side panel also has names and colours.
        let mut heads = harness.query_all_by_label(column).map(|node| node.rect());
        let is_over = heads.any(|head| head.bottom() <= row.top() && head.top() > picture.bottom());
        assert!(is_over, "{column}");
    }
    assert!(harness.query_by_label("Go to Labels").is_none(), "there is one table");
    harness.key_press(egui::Key::I);
    harness.run_steps(2);
    harness.hover_at(picture.center());
    harness.run_steps(3);
    harness.get_by_label("Label 9: Left lung");
    press_at(&mut harness, picture.center(), 1);
    harness.run_steps(3);
    harness.get_by_label("Label 9: Left lung");
    harness.get_by_label_contains(" %\nvoxel ");
    harness.key_press(egui::Key::D);
    harness.run_steps(3);
    harness.get_by_label("9 · Left lung");
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().errors(), [""; 0]);
}

#[test]
fn a_curve_takes_the_place_of_the_table_and_gives_it_back() {
    let (mut harness, _folder) = label_map_window(&[3, 9, 200]);
    let table = harness.state().settings().layer().labels.clone();
    assert_eq!(table.get(9).map(|look| look.name.as_str()), Some("Left lung"));
    assert!(harness.query_by_label("Transfer function plot").is_none(), "there is no curve");
    press(&mut harness, "Use a curve");
    assert!(harness.state().settings().layer().labels.is_empty());
    assert!(harness.query_by_label("Transfer function plot").is_some());
    assert!(harness.query_by_label("Show label 9").is_none());
    press(&mut harness, "Automatic");
    assert_eq!(harness.state().settings().layer().labels, table);
    assert_eq!(harness.state().errors(), [""; 0]);
}

#[test]
fn long_tables_are_filtered_and_scrolled() {
    let labels: Vec<u8> = (1..=20).collect();
    let (mut harness, _folder) = label_map_window(&labels);
    assert!(harness.query_by_label("Show label 3").is_some());
    assert!(harness.query_by_label("Show label 20").is_none(), "it is further down");
    for (words, hidden) in [("lung", 9), ("20", 20)] {
        let field = harness.get_by_label("Filter labels");
        field.focus();
        field.type_text(words);
        harness.run_steps(3);
        assert!(harness.query_by_label("Show label 3").is_none(), "{words}");
        press(&mut harness, &format!("Show label {hidden}"));
        assert!(!visible_labels(&harness).contains(&hidden), "{words}");
        harness.get_by_label("Filter labels").focus();
        harness.run_steps(1);
        harness.key_press(egui::Key::Escape);
        harness.run_steps(3);
        assert!(harness.query_by_label("Show label 3").is_some(), "Escape empties the filter");
    }
    assert_eq!(visible_labels(&harness).len(), 18);
}
