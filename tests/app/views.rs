//! Tests of standard and kept views, and of two looks side by side.

use chiaroscuro::app::App;
use eframe::egui::{self, Modifiers, vec2};
use egui_kittest::Harness;

use crate::harness::{click_at, drag, picture, turn_wheel, wait_until_idle, window, window_without_overlays};

#[test]
fn views_are_found_kept_and_found_again() {
    let mut harness = window();
    let camera = |harness: &Harness<'_, App>| harness.state().settings().camera.clone();
    let first = camera(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), egui::Key::Num4);
    harness.run_steps(2);
    for (key, azimuth_deg, elevation_deg) in
        [(egui::Key::Num1, 270.0, 0.0), (egui::Key::Num3, 0.0, 0.0), (egui::Key::Num7, 270.0, 90.0)]
    {
        harness.key_press(key);
        harness.run_steps(2);
        let seen = camera(&harness);
        assert_eq!((seen.azimuth_deg, seen.elevation_deg), (azimuth_deg, elevation_deg));
    }
    harness.key_press(egui::Key::Num5);
    harness.run_steps(2);
    assert_ne!(camera(&harness).projection, first.projection);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Num4);
    harness.run_steps(2);
    assert_eq!(camera(&harness), first);

    // The wheel zooms towards the point under the pointer, which stays there.
    let (rect, _) = harness.state().viewport_rect().unwrap();
    harness.hover_at(rect.center() + vec2(60.0, 40.0));
    harness.step();
    turn_wheel(&harness, 80.0);
    harness.run_steps(6);
    let nearer = camera(&harness);
    assert!(nearer.distance < first.distance && nearer.target != first.target, "{nearer:?}");
    harness.key_press(egui::Key::F);
    harness.run_steps(2);
    assert_eq!(camera(&harness), first, "all of it, from the same side");

    // A double click makes the point under the pointer the camera's target.
    let at = rect.center() + vec2(0.0, 30.0);
    click_at(&mut harness, at, 2);
    assert_ne!(camera(&harness).target, first.target, "there is something there");
    wait_until_idle(&mut harness);
}

#[test]
fn two_looks_share_the_picture() {
    let mut harness = window_without_overlays();
    let (rect, size) = harness.state().viewport_rect().expect("a picture");
    let (before, _) = picture(&mut harness);
    let fills = harness.state().light_rebuilds();
    harness.key_press(egui::Key::C);
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().light_rebuilds(), fills, "the same camera needs no new light");
    let (both, _) = picture(&mut harness);
    // The left part is the current look, the right one the look without shadows; divider and labels are between them.
    let [width, height] = size.map(|n| n as usize);
    let differs = |from: f64, to: f64| {
        let columns = (width as f64 * from) as usize..(width as f64 * to) as usize;
        let rows = height / 8..height * 7 / 8;
        rows.flat_map(|row| columns.clone().map(move |column| (row * width + column) * 4))
            .filter(|&at| before[at..at + 3] != both[at..at + 3])
            .count()
    };
    assert_eq!(differs(0.02, 0.46), 0, "left of the line");
    assert!(differs(0.54, 0.98) > 100, "right of the line");
    // Dragging the divider shows more of the left look, and does not turn the camera.
    let camera = harness.state().settings().camera.clone();
    drag(&mut harness, rect.center() + vec2(0.0, rect.height() / 4.0), vec2(0.44 * rect.width(), 0.0));
    assert_eq!(harness.state().settings().camera, camera);
    let (dragged, _) = picture(&mut harness);
    let columns = (width as f64 * 0.54) as usize..(width as f64 * 0.85) as usize;
    let same = (height / 8..height * 7 / 8).all(|row| {
        columns.clone().all(|column| {
            let at = (row * width + column) * 4;
            before[at..at + 3] == dragged[at..at + 3]
        })
    });
    assert!(same, "what the line has passed shows the left look");
    harness.key_press(egui::Key::C);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness).0 == before, "one look again");
}
