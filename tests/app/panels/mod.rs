//! Tests of the controls in the panels, and of their effects on the picture.

mod bars;
mod environment_map;
mod labels;
mod layout;
mod materials;
mod menus;
mod presets;
mod render_modes;
mod reset_buttons;
mod side_panel;
mod slices;

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{LightGeometry, Projection};
use eframe::egui::{self, Modifiers, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{
    SCENE, adjusted_window, click, picture, render, wait_until, wait_until_idle, window_without_overlays,
};

#[test]
fn panels_change_settings() {
    let mut harness = window_without_overlays();
    click(&mut harness, "Positional");
    assert_eq!(harness.state().settings().lights[0].kind, LightGeometry::Perspective);
    click(&mut harness, "Directional");
    assert_eq!(harness.state().settings().lights[0].kind, LightGeometry::Parallel);
    // Makes space for the following sections.
    click(&mut harness, "Lights");
    click(&mut harness, "Camera");
    // The section opens with an animation.
    harness.run_steps(8);
    click(&mut harness, "Orthographic");
    assert_eq!(harness.state().settings().camera.projection, Projection::Orthographic);

    click(&mut harness, "Same opacity for light and eye");
    let settings = harness.state().settings();
    assert!(!settings.layer().lighting.linked);
    assert_eq!(
        settings.layer().lighting.curve,
        settings.layer().transfer,
        "a fresh curve starts as the eye's"
    );

    harness.get_by_role_and_label(Role::Slider, "Strength").set_value_accesskit(0.5);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().shadows.strength, 0.5);
    wait_until_idle(&mut harness);
    let (shown, size) = picture(&mut harness);
    assert!(shown == render(&harness, size).display);
}

#[test]
fn a_floor_takes_shadows() {
    let mut harness = window_without_overlays();
    let (bare, _) = picture(&mut harness);
    let fills = harness.state().light_rebuilds();
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::G);
    harness.run_steps(2);
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(harness.state().settings().floor.on);
    let (floor, size) = picture(&mut harness);
    assert!(floor != bare);
    assert!(floor == render(&harness, size).display);
    assert_eq!(harness.state().light_rebuilds(), fills, "the floor needs no light volume");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(picture(&mut harness).0 == bare);
}

#[test]
fn voxels_are_averaged_and_the_look_stays() {
    // So tall that the whole section is visible.
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 1600.0));
    harness.key_press(egui::Key::CloseBracket);
    click(&mut harness, "Data");
    let before = harness.state().settings().clone();
    let choose = |harness: &mut Harness<'_, App>, thinning: &str, voxels: &'static str| {
        harness.get_by_role_and_label(Role::ComboBox, "Subsample").click();
        harness.run_steps(4);
        // The open list is drawn over everything else, last.
        harness.get_all_by_label(thinning).last().expect("it is in the list").click();
        harness.run_steps(4);
        wait_until(harness, "never read again", App::is_idle);
        harness.run_steps(3);
        assert_eq!(harness.query_all_by_label_contains(voxels).count(), 1, "the title says {voxels}");
        assert_eq!(harness.state().errors(), [""; 0]);
    };
    choose(&mut harness, "Means of 2 × 2 × 2", "16×16×16");
    let after = harness.state().settings().clone();
    assert_eq!((&after.camera, &after.layer().transfer), (&before.camera, &before.layer().transfer));
    assert_eq!(after.lights, before.lights);
    // The opacity unit of the chair is in millimetres already.
    assert_eq!(after.layer().opacity_unit, before.layer().opacity_unit);
    harness.get_by_label("In file");
    choose(&mut harness, "Every second", "16×16×16");
    choose(&mut harness, "All", "32×32×32");
    assert!(harness.query_by_label("In file").is_none());
}

#[test]
fn volumes_are_treated_as_other_data_in_one_step() {
    // As tall as the section with a table of labels and the clipping section above it.
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 2600.0));
    click(&mut harness, "Data");
    harness.get_by_label("Scalar field");
    // Clipping, quality and background are not part of a first look.
    harness.key_press(egui::Key::K);
    harness.run_steps(3);
    let before = harness.state().settings().clone();
    assert!(before.cuts.crop.on);
    let treat = |harness: &mut Harness<'_, App>, kind: &str| {
        harness.get_by_role_and_label(Role::ComboBox, "Treat as").click();
        harness.run_steps(4);
        // The open list is drawn over everything else, last.
        harness.get_all_by_label(kind).last().expect("it is in the list").click();
        harness.run_steps(10);
        wait_until_idle(harness);
    };
    treat(&mut harness, "Mask");
    let mask = harness.state().settings().clone();
    assert_ne!(mask.layer().transfer, before.layer().transfer);
    assert_eq!((&mask.cuts, &mask.output.background), (&before.cuts, &before.output.background));
    assert!((mask.output.exposure / before.output.exposure - 1.0).abs() < 0.5, "near what it was");
    assert!((mask.shadows.balance / before.shadows.balance - 1.0).abs() < 0.5, "near what it was");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(10);
    assert_eq!(*harness.state().settings(), before, "one step back, lights that were sought included");
    harness.key_press(egui::Key::R);
    harness.run_steps(10);
    assert_eq!(harness.state().settings().camera, before.camera, "and what is reset to is as before");
    treat(&mut harness, "Labels");
    treat(&mut harness, "Automatic");
    assert_eq!(harness.state().settings().layer().transfer, before.layer().transfer);
    assert_eq!(harness.state().errors(), [""; 0]);
}
