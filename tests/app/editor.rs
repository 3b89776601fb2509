//! Tests of the transfer function editor: points, selection, colour maps and freehand drawing.

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{ControlPoint, Easing, Settings, TransferFunction};
use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, Role, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{SCENE, adjusted_window, click, drag, turn_wheel, wait_until_idle, window};

#[test]
fn the_transfer_function_is_edited_in_its_plot() {
    let mut harness = window();
    let before = harness.state().settings().layer().transfer.clone();
    let point = harness.get_by_label("Eye point 2").rect().center();
    drag(&mut harness, point, vec2(14.0, -12.0));
    let after = harness.state().settings().layer().transfer.clone();
    assert_eq!(after.points.len(), before.points.len());
    assert!(
        after.points[1].value > before.points[1].value && after.points[1].opacity > before.points[1].opacity
    );
    assert_eq!(after.points[0], before.points[0]);

    // A click on the empty plot adds a point; Delete removes it.
    let plot = harness.get_by_label("Transfer function plot").rect();
    // Between the ends of the curve, above it.
    let empty = plot.center_top() + vec2(10.0, 12.0);
    drag(&mut harness, empty, Vec2::ZERO);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().layer().transfer.points.len(), before.points.len() + 1);
    harness.key_press(egui::Key::Delete);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().layer().transfer.points.len(), before.points.len());
    wait_until_idle(&mut harness);
}

/// A point added beyond the ends of the curve leaves the look of other values unchanged, and one undo step removes
/// all that was added with it.
#[test]
fn a_point_beyond_the_ends_of_the_curve_brings_one_that_holds_the_rest() {
    let adjust = |mut settings: Settings| {
        settings.shadows.keep_balanced = false;
        let (first, last) =
            (settings.layer().transfer.points[0], *settings.layer().transfer.points.last().expect("a point"));
        let span = last.value - first.value;
        let point = |share: f64, opacity| ControlPoint::new(first.value + share * span, [1.0; 3], opacity);
        settings.layer_mut().transfer.points = vec![point(0.4, 0.0), point(0.5, 0.8), point(0.6, 0.0)];
        settings
    };
    let options = WindowOptions {
        source: Some(SCENE.into()),
        adjust: Some(Box::new(adjust)),
        ..WindowOptions::default()
    };
    let mut harness = adjusted_window(options, Vec2::new(760.0, 1140.0));
    let transfer = |harness: &Harness<'_, App>| harness.state().settings().layer().transfer.clone();
    let before = transfer(&harness);
    let (first, last) = (before.points[0].value, before.points[2].value);
    let plot = harness.get_by_label("Transfer function plot").rect();
    for (share, beyond) in [(0.2, first - 2.6 * (last - first)), (0.8, last + 2.6 * (last - first))] {
        drag(&mut harness, plot.left_top() + vec2(share * plot.width(), 20.0), Vec2::ZERO);
        harness.run_steps(12);
        let after = transfer(&harness);
        assert_eq!(after.points.len(), 5, "{:?}", after.points);
        let added = after.points.iter().filter(|point| !before.points.contains(point)).collect::<Vec<_>>();
        assert!(added.iter().any(|point| point.opacity > 0.5), "{added:?}");
        assert!(added.iter().any(|point| point.opacity == 0.0), "{added:?}");
        assert!(after.opacity_at(beyond) < 1e-9, "{:?}", after.points);
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(4);
        assert_eq!(transfer(&harness), before, "one step");
        harness.run_steps(8);
    }
    wait_until_idle(&mut harness);
}

/// The link button gives light a curve of its own, and links it again.
#[test]
fn a_chain_links_the_curves() {
    let mut harness = window();
    let is_linked = |harness: &Harness<'_, App>| harness.state().settings().layer().lighting.linked;
    assert!(is_linked(&harness));
    for wanted in [false, true] {
        click(&mut harness, "Link the curves of eye and light");
        assert_eq!(is_linked(&harness), wanted);
    }
    wait_until_idle(&mut harness);
}

#[test]
fn the_whole_curve_is_colored_moved_and_replaced() {
    let mut harness = window();
    let transfer = |harness: &Harness<'_, App>| harness.state().settings().layer().transfer.clone();
    let first = transfer(&harness);
    click(&mut harness, "Transfer function");
    click(&mut harness, "Viridis");
    let colored = transfer(&harness);
    assert!(colored.points.len() > first.points.len());
    let last = |function: &TransferFunction| function.points.last().expect("a point").color;
    assert!(last(&colored) != last(&first));

    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(transfer(&harness), first);
    click(&mut harness, "Presets");
    click(&mut harness, "Lobster");
    let preset = transfer(&harness);
    assert!(preset != first && preset != colored);
    click(&mut harness, "Shape");
    click(&mut harness, "Bump");
    assert!(transfer(&harness).points.len() >= preset.points.len() + 8);

    // The wheel zooms in, and points outside the range do not interfere.
    let plot = harness.get_by_label("Transfer function plot").rect();
    harness.hover_at(plot.left_center() + vec2(30.0, 0.0));
    harness.step();
    turn_wheel(&harness, 400.0);
    harness.run_steps(8);
    click(&mut harness, "Show all");
    assert!(harness.query_by_label("Show all").is_none());
    wait_until_idle(&mut harness);
}

#[test]
fn points_are_selected_and_changed_together() {
    let mut harness = window();
    let points = |harness: &Harness<'_, App>| harness.state().settings().layer().transfer.points.clone();
    let before = points(&harness);
    assert!(before.len() >= 4);
    let place = |harness: &Harness<'_, App>, number: usize| {
        harness.get_by_label(&format!("Eye point {number}")).rect().center()
    };
    // A rubber band around the second and third point, from top to bottom.
    let plot = harness.get_by_label("Transfer function plot").rect();
    let (second, third) = (place(&harness, 2), place(&harness, 3));
    let from = Pos2::new(second.x - 6.0, plot.min.y + 3.0);
    drag(&mut harness, from, Pos2::new(third.x + 6.0, plot.max.y - 2.0) - from);
    harness.run_steps(2);
    assert!(harness.query_by_label("2 points").is_some());
    assert_eq!(points(&harness), before, "a frame changes nothing");

    drag(&mut harness, second, vec2(5.0, 4.0));
    harness.run_steps(2);
    let moved = points(&harness);
    let by = |index: usize| moved[index].value - before[index].value;
    assert!(by(1) > 0.0 && (by(1) - by(2)).abs() < 1e-9, "{} and {}", by(1), by(2));
    assert_eq!((moved[0], moved[3]), (before[0], before[3]));

    // Opening the colour menu changes nothing; a step to the right changes the hue of both points.
    let colors = |harness: &Harness<'_, App>| points(harness).iter().map(|p| p.color).collect::<Vec<_>>();
    let plain = colors(&harness);
    click(&mut harness, "OKLCH…");
    harness.run_steps(3);
    assert_eq!(colors(&harness), plain);
    harness.get_by_role_and_label(Role::Slider, "Hue").focus();
    harness.run_steps(2);
    harness.key_press(egui::Key::ArrowRight);
    harness.run_steps(3);
    let turned = colors(&harness);
    assert!(turned[1] == turned[2] && turned[1] != plain[1], "{turned:?}");
    assert_eq!((turned[0], turned[3]), (plain[0], plain[3]));
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);

    // The interpolation to the next point, for both; and one more point with Shift.
    click(&mut harness, "Linear");
    click(&mut harness, "Smooth");
    let eased = points(&harness).iter().map(|point| point.easing).collect::<Vec<_>>();
    assert_eq!(eased[..4], [Easing::Linear, Easing::Smooth, Easing::Smooth, Easing::Linear]);
    let first = place(&harness, 1);
    harness.hover_at(first);
    for pressed in [true, false] {
        harness.event_modifiers(
            Event::PointerButton {
                pos: first,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::SHIFT,
            },
            Modifiers::SHIFT,
        );
    }
    harness.run_steps(2);
    assert!(harness.query_by_label("3 points").is_some());
    harness.key_press(egui::Key::Delete);
    harness.run_steps(2);
    assert_eq!(points(&harness).len(), before.len() - 3);
    // Ctrl+A over the plot selects all points; Escape clears the selection.
    harness.hover_at(plot.center());
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::A);
    harness.run_steps(2);
    assert!(harness.query_by_label(&format!("{} points", before.len() - 3)).is_some());
    harness.key_press(egui::Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("Level").is_some());
    click(&mut harness, "Shape");
    click(&mut harness, "Box");
    assert_eq!(points(&harness).len(), before.len());
    // A selection is cleared when the curve is replaced.
    harness.hover_at(plot.center());
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::A);
    harness.run_steps(2);
    click(&mut harness, "Transfer function");
    click(&mut harness, "Viridis");
    harness.run_steps(3);
    assert!(harness.query_by_label("Level").is_some(), "nothing is selected");
    wait_until_idle(&mut harness);
}

#[test]
fn a_curve_is_drawn_by_hand() {
    let mut harness = window();
    let before = harness.state().settings().layer().transfer.clone();
    click(&mut harness, "Draw");
    let plot = harness.get_by_label("Transfer function plot").rect();
    let from = plot.left_center() + vec2(120.0, 30.0);
    drag(&mut harness, from, vec2(260.0, -50.0));
    let drawn = harness.state().settings().layer().transfer.clone();
    assert!(drawn != before && drawn.points.len() <= before.points.len() + 20, "{drawn:?}");
    // One undo step; Escape ends freehand drawing.
    harness.run_steps(8);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().layer().transfer, before);
    harness.hover_at(plot.center());
    harness.step();
    harness.key_press(egui::Key::Escape);
    harness.run_steps(2);
    // Between the ends of the curve, above it.
    let empty = plot.center_top() + vec2(10.0, 12.0);
    drag(&mut harness, empty, Vec2::ZERO);
    harness.run_steps(2);
    assert_eq!(
        harness.state().settings().layer().transfer.points.len(),
        before.points.len() + 1,
        "points are added again"
    );
    wait_until_idle(&mut harness);
}
