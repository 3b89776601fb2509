//! Tests of the kept balance: it follows changes in the settings, the picture and the undo history.

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_render::measure_balance_fast;
use eframe::egui::{self, Modifiers, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{SCENE, adjusted_window, click, picture, render, second_renderer, wait_until_idle};

fn undo(harness: &mut Harness<'_, App>, modifiers: Modifiers) {
    harness.key_press_modifiers(modifiers, egui::Key::Z);
    harness.run_steps(3);
}

#[test]
fn a_balance_that_is_kept_follows_changes() {
    let options = WindowOptions {
        source: Some(SCENE.into()),
        adjust: Some(Box::new(|settings| settings)),
        ..WindowOptions::default()
    };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 1100.0));
    // Without overlays on the picture.
    harness.key_press(egui::Key::G);
    harness.run_steps(10);
    let first = harness.state().settings().clone();
    assert!(first.shadows.keep_balanced, "as a first look has it");
    assert!(harness.state().is_idle(), "and it is balanced");

    let refined = harness.state().full_quality_pictures();
    harness.get_by_role_and_label(Role::Slider, "Light opacity").set_value_accesskit(0.1);
    harness.run_steps(2);
    assert!(!harness.state().is_idle());
    wait_until_idle(&mut harness);
    let followed = harness.state().settings().clone();
    assert_eq!(followed.layer().lighting.scale, 0.1);
    assert_eq!(
        harness.state().full_quality_pictures(),
        refined + 1,
        "the balance was found before the picture was"
    );
    let (dataset, mut renderer) = second_renderer();
    let measured = measure_balance_fast(&mut renderer, &dataset, &followed).expect("a balance");
    assert_eq!(followed.shadows.balance.to_bits(), measured.to_bits());
    assert!(measured < 0.95 * first.shadows.balance, "{measured} after {}", first.shadows.balance);
    let (shown, size) = picture(&mut harness);
    assert_eq!(harness.state().settings(), &followed, "its own change is none");
    assert!(shown == render(&harness, size).display);

    // One undo step reverts the change and the balance, and no new measurement follows.
    undo(&mut harness, Modifiers::COMMAND);
    assert_eq!(harness.state().settings(), &first);
    wait_until_idle(&mut harness);
    harness.run_steps(10);
    assert_eq!(harness.state().settings(), &first);
    undo(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT));
    assert_eq!(harness.state().settings(), &followed);

    // A balance set by hand is kept.
    harness.get_by_role_and_label(Role::Slider, "Balance").set_value_accesskit(2.0);
    harness.run_steps(10);
    wait_until_idle(&mut harness);
    let by_hand = &harness.state().settings().shadows;
    assert_eq!((by_hand.balance, by_hand.keep_balanced), (2.0, false));
    click(&mut harness, "Keep balanced");
    wait_until_idle(&mut harness);
    let again = &harness.state().settings().shadows;
    assert!(again.keep_balanced);
    assert_eq!(again.balance.to_bits(), measured.to_bits());
    assert!(harness.state().errors().is_empty());
}
