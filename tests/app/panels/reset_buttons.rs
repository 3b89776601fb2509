//! Tests of the rows of the side panel: their reset buttons, and how their controls fit.

use chiaroscuro::app::App;
use chiaroscuro_scene::Settings;
use eframe::egui::{Event, Key, Rect, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{click, first_look_window, wait_until_idle, window};

fn settings<'h>(harness: &'h Harness<'_, App>) -> &'h Settings {
    harness.state().settings()
}

fn reset_button_count(harness: &Harness<'_, App>) -> usize {
    harness.query_all_by_role(Role::Button).filter(|node| is_reset_button(&label_of(node))).count()
}

fn label_of(node: &egui_kittest::Node<'_>) -> String {
    use egui_kittest::kittest::NodeT as _;
    node.accesskit_node().label().unwrap_or_default()
}

fn is_reset_button(label: &str) -> bool {
    label.starts_with("Reset ") && label != "Reset view"
}

fn set(harness: &mut Harness<'_, App>, name: &str, value: f64) {
    harness.get_by_role_and_label(Role::Slider, name).set_value_accesskit(value);
    harness.run_steps(3);
}

#[test]
fn untouched_settings_have_no_reset_button() {
    let mut harness = first_look_window();
    for light in ["Light Key, on", "Light Rim, on"] {
        click(&mut harness, light);
        assert_eq!(reset_button_count(&harness), 0, "{light}");
    }
    // An added light cannot be reset either.
    harness.get_all_by_label("Add light").last().expect("a button").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Reset Intensity").is_none());
    assert!(harness.query_by_label("Reset Density").is_none());
    wait_until_idle(&mut harness);
}

#[test]
fn arrows_of_fields_and_of_sections_put_back_the_first_look() {
    let mut harness = first_look_window();
    click(&mut harness, "Light Rim, on");
    let first = settings(&harness).lights.clone();
    let intensity = first[1].intensity;
    assert!(intensity < 0.9, "a rim light is another than what a new light is: {intensity}");
    for arrow in ["Reset Intensity", "Reset Lights"] {
        set(&mut harness, "Intensity", 0.77);
        assert_eq!(reset_button_count(&harness), 2, "one of the field, and one of the section");
        harness.get_by_label(arrow).hover();
        harness.run_steps(12);
        let said = if arrow == "Reset Lights" {
            "Reset Lights to the first look".to_owned()
        } else {
            format!("Reset to {intensity:.2}")
        };
        assert!(harness.query_by_label(&said).is_some(), "{said}");
        click(&mut harness, arrow);
        assert_eq!(settings(&harness).lights, first, "{arrow}");
        assert_eq!(reset_button_count(&harness), 0, "{arrow}");
    }
    wait_until_idle(&mut harness);
}

/// Rectangle of a widget in the window.
fn widget_rect(harness: &Harness<'_, App>, role: Role, label: &str) -> Rect {
    harness.get_by_role_and_label(role, label).rect()
}

#[test]
fn settings_of_a_light_are_indented_under_it_and_controls_stand_in_one_column() {
    let harness = window();
    let sign = widget_rect(&harness, Role::CheckBox, "Key on");
    let name = harness.get_by_role(Role::TextInput).rect();
    let kind = harness.get_by_label("Kind").rect();
    assert!(kind.left() > sign.left() + 8.0 && kind.top() > sign.bottom(), "{kind} under {sign}");
    let strength = widget_rect(&harness, Role::Slider, "Strength");
    for indented in [name, widget_rect(&harness, Role::Slider, "Intensity")] {
        assert!((indented.left() - strength.left()).abs() < 1.5, "{indented} over {strength}");
    }
    // The next light of the list follows.
    assert!(widget_rect(&harness, Role::CheckBox, "Rim on").top() > name.bottom());
}

#[test]
fn methods_of_shadows_stand_in_one_row_or_in_a_list() {
    let mut harness = window();
    let words = ["Splat", "Voxel", "Sample"];
    let tops: Vec<f32> = words.map(|word| harness.get_by_label(word).rect().top()).to_vec();
    assert!(tops.windows(2).all(|pair| pair[0] == pair[1]), "{tops:?}");
    // With wide letters in a narrow panel the choice is a list.
    harness.ctx.all_styles_mut(|style| {
        style.text_styles.values_mut().for_each(|font| font.size *= 1.5);
    });
    harness.run_steps(6);
    assert!(harness.query_by_label("Voxel").is_none());
    let list = widget_rect(&harness, Role::ComboBox, "Method");
    assert!(list.height() < 40.0 && list.right() < 760.0, "{list}");
    harness.get_by_role_and_label(Role::ComboBox, "Method").click();
    harness.run_steps(4);
    click(&mut harness, "Voxel");
    assert_eq!(settings(&harness).shadows.algorithm, chiaroscuro_scene::ShadowAlgorithm::Raycast);
    wait_until_idle(&mut harness);
}

#[test]
fn lengths_without_a_unit_are_said_in_voxels_everywhere() {
    use chiaroscuro::app::WindowOptions;
    use eframe::egui::Vec2;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scan.nrrd");
    let header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n";
    let voxels: Vec<u8> = (0..12 * 12 * 12).map(|at| (at % 251) as u8).collect();
    std::fs::write(&path, [header.as_bytes(), &voxels].concat()).expect("written");
    let options = WindowOptions {
        source: Some(path),
        adjust: Some(Box::new(|mut settings| {
            settings.shadows.keep_balanced = false;
            settings.layer_mut().opacity_unit = chiaroscuro_scene::OpacityLength::Mm(1.0);
            settings
        })),
        ..WindowOptions::default()
    };
    let mut harness = crate::harness::adjusted_window(options, Vec2::new(760.0, 1600.0));
    harness.key_press(Key::CloseBracket);
    click(&mut harness, "Data");
    harness.run_steps(8);
    let unit = harness.get_by_role_and_label(Role::ComboBox, "Unit of the opacity unit");
    unit.click();
    harness.run_steps(4);
    assert!(harness.query_by_role_and_label(Role::Button, "mm").is_none(), "nobody knows how long that is");
    assert!(harness.query_all_by_label("voxels").count() > 0);
    harness.event(Event::PointerGone);
    wait_until_idle(&mut harness);
}
