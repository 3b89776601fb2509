//! Tests of the menu of presets, and of the marks of those in use.

use chiaroscuro::app::{App, WindowOptions};
use eframe::egui::accesskit::Toggled;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{SCENE, adjusted_window, click, wait_until_idle};

fn is_marked(harness: &Harness<'_, App>, preset: &str) -> bool {
    harness.get_by_label(preset).accesskit_node().toggled() == Some(Toggled::True)
}

#[test]
fn presets_have_one_name_each_and_the_one_in_use_is_marked() {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    // As high as all presets need.
    let mut harness = adjusted_window(options, vec2(900.0, 1500.0));
    click(&mut harness, "Presets");
    harness.run_steps(4);
    for title in ["CT angiography", "MR angiography", "Spray", "Fuel injection", "Vapour", "Sunlit cloud"] {
        assert!(!is_marked(&harness, title), "{title}");
    }
    assert!(harness.unnamed_widgets().is_empty());
    let before = harness.state().settings().layer().transfer.clone();
    click(&mut harness, "Lobster");
    assert_ne!(harness.state().settings().layer().transfer, before);
    harness.run_steps(4);
    click(&mut harness, "Presets");
    harness.run_steps(4);
    assert!(is_marked(&harness, "Lobster") && !is_marked(&harness, "Fuel injection"));
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(4);
    click(&mut harness, "Presets");
    harness.run_steps(4);
    assert!(!is_marked(&harness, "Lobster"));
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    wait_until_idle(&mut harness);
}
