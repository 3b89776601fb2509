//! Tests of the crop box and clip plane dragged in the picture, and of the slices beside it.

use std::time::Instant;

use chiaroscuro::app::App;
use chiaroscuro_scene::{ClipEffect, CutAction, CutShape, ShapeCut};
use eframe::egui::{self, Event, Modifiers, PointerButton, Role, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::accessibility::expand_sections;
use crate::harness::{
    WAIT_TIMEOUT, click, click_at, drag, picture, picture_with_pointer, turn_wheel, wait_until_idle, window,
    window_without_overlays,
};

#[test]
fn box_and_plane_are_dragged_in_the_picture() {
    let mut harness = window_without_overlays();
    let (whole, _) = picture(&mut harness);
    let (rect, _) = harness.state().viewport_rect().unwrap();
    let camera = harness.state().settings().camera.clone();
    harness.hover_at(rect.center());
    harness.key_press(egui::Key::K);
    harness.run_steps(3);
    let place = |harness: &Harness<'_, App>, name: &str| harness.get_by_label(name).rect().center();
    let (top, bottom) = (place(&harness, "Crop box, side +z"), place(&harness, "Crop box, side −z"));
    drag(&mut harness, top, (bottom - top) * 0.4);
    harness.run_steps(2);
    let crop = harness.state().settings().cuts.crop.clone();
    assert!(crop.on && (0.5..0.7).contains(&crop.high[2]), "{crop:?}");
    assert_eq!((crop.low, crop.high[0], crop.high[1]), ([0.0; 3], 1.0, 1.0));
    assert!(place(&harness, "Crop box, side +z").distance(top + (bottom - top) * 0.4) < 3.0);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness).0 != whole);

    harness.key_press(egui::Key::K);
    harness.key_press(egui::Key::X);
    harness.run_steps(3);
    let (middle, tip) = (place(&harness, "Clip plane, position"), place(&harness, "Clip plane, direction"));
    drag(&mut harness, middle, (tip - middle) * 0.5);
    let moved = harness.state().settings().cuts.plane.clone();
    assert!(moved.on && moved.offset > 0.1 && moved.normal == [0.0, -1.0, 0.0], "{moved:?}");
    harness.run_steps(2);
    // The drag is as long as the arrow appears, so that its tip can follow at any magnification.
    let (middle, tip) = (place(&harness, "Clip plane, position"), place(&harness, "Clip plane, direction"));
    let by = vec2(-0.6, -0.8) * 0.6 * (tip - middle).length();
    drag(&mut harness, tip, by);
    let turned = harness.state().settings().cuts.plane.clone();
    assert!(turned.normal[2] > 0.2 && turned.normal != moved.normal, "{turned:?}");
    harness.run_steps(2);
    assert!(place(&harness, "Clip plane, direction").distance(tip + by) < 3.0);
    let middle = place(&harness, "Clip plane, position");
    harness.hover_at(middle);
    harness.run_steps(2);
    turn_wheel(&harness, 50.0);
    harness.run_steps(30);
    let wheeled = harness.state().settings().cuts.plane.clone();
    assert!(wheeled.offset > turned.offset + 0.005, "{wheeled:?}");
    assert_eq!(harness.state().settings().camera, camera, "neither drags nor wheel reached the camera");

    // Across the line of sight; then all changes are undone step by step.
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::X);
    harness.run_steps(3);
    let plane = &harness.state().settings().cuts.plane;
    assert!(plane.unit_normal().dot(camera.scene_from_view().z_axis) > 0.999, "{plane:?}");
    wait_until_idle(&mut harness);
    for _ in 0..12 {
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(2);
    }
    assert_eq!(harness.state().settings().cuts, chiaroscuro_scene::Clipping::default());
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(picture(&mut harness).0 == whole, "as it was");
}

#[test]
fn slices_and_picture_share_a_cursor() {
    let mut harness = window();
    let camera = harness.state().settings().camera.clone();
    harness.key_press(egui::Key::D);
    harness.run_steps(4);
    assert!(harness.query_by_label("16, 16, 16").is_some(), "in the middle");
    let slice = harness.get_by_label("Slice across z").rect();
    let (at, by) = (slice.center(), vec2(slice.width() / 4.0, -slice.height() / 4.0));
    drag(&mut harness, at, by);
    harness.run_steps(2);
    assert!(harness.query_by_label("24, 24, 16").is_some(), "a quarter to the right and up");
    harness.hover_at(at);
    harness.step();
    // A notch of the wheel is 50 points.
    turn_wheel(&harness, 110.0);
    harness.run_steps(30);
    assert!(harness.query_by_label("24, 24, 18").is_some(), "two slices further");
    click(&mut harness, "As in the picture");

    // The slices go to the point that is seen under the pointer; the seat is below the window with the slices.
    let (rect, _) = harness.state().viewport_rect().expect("a picture");
    let seat = rect.center() + vec2(20.0, 30.0);
    harness.get_by_label("Slices").rect();
    let title = harness.get_by_label("Slices").rect().center();
    drag(&mut harness, title, vec2(0.0, rect.height() / 2.0 + 60.0));
    click_at(&mut harness, seat, 1);
    harness.run_steps(3);
    assert!(harness.query_by_label("24, 24, 18").is_none(), "the cursor went where the picture was clicked");
    assert_eq!(harness.state().settings().camera, camera);
}

#[test]
fn parts_are_cut_away_in_the_picture() {
    let mut harness = window_without_overlays();
    let (whole, _) = picture(&mut harness);
    let camera = harness.state().settings().camera.clone();
    let (rect, _) = harness.state().viewport_rect().unwrap();
    let key = |pressed| Event::Key {
        key: egui::Key::Q,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    harness.hover_at(rect.center());
    harness.event(key(true));
    harness.step();
    // A square around the middle, of a quarter of the height.
    let edge = 0.25 * rect.height();
    let corner = rect.center() - Vec2::splat(0.5 * edge);
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.hover_at(corner);
    harness.step();
    harness.event(button(corner, true));
    harness.step();
    for (x, y) in [(0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        harness.hover_at(corner + edge * vec2(x, y));
        harness.step();
    }
    harness.event(button(corner + vec2(0.0, edge), false));
    harness.step();
    harness.event(key(false));
    harness.run_steps(2);
    let settings = harness.state().settings();
    assert_eq!(settings.camera, camera, "the drag did not turn the view");
    let [cut] = &settings.cuts.shapes[..] else { panic!("{:?}", settings.cuts) };
    let CutShape::Outline(outline) = &cut.shape else { panic!("{cut:?}") };
    assert_eq!((cut.action, outline.camera == camera), (CutAction::Hide, true));
    let heights = outline.points.iter().map(|[_, y]| y);
    assert!(heights.clone().all(|y| (0.37..0.63).contains(y)), "{outline:?}");
    wait_until_idle(&mut harness);
    let (cut_picture, _) = picture(&mut harness);
    assert!(cut_picture != whole);

    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert!(harness.state().settings().cuts.shapes.is_empty());
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(picture(&mut harness).0 == whole, "undone");

    // A click with Q hides the part that is clicked: all of the chair.
    let at = rect.center() + vec2(0.0, 0.05 * rect.height());
    harness.hover_at(at);
    harness.event(key(true));
    harness.step();
    let (plain, _) = picture_with_pointer(&mut harness);
    // Once the pointer rests, the part is outlined.
    let start = Instant::now();
    loop {
        harness.run_steps(10);
        let (now, _) = picture_with_pointer(&mut harness);
        let changed = now.chunks_exact(4).zip(plain.chunks_exact(4)).filter(|(a, b)| a != b).count();
        if changed > 500 {
            break;
        }
        assert!(start.elapsed() < WAIT_TIMEOUT, "{changed} pixels differ");
    }
    click_at(&mut harness, at, 1);
    harness.event(key(false));
    harness.run_steps(2);
    let shapes = &harness.state().settings().cuts.shapes;
    assert!(matches!(&shapes[..], [ShapeCut { shape: CutShape::Component(_), .. }]), "{shapes:?}");
    wait_until_idle(&mut harness);
    harness.get_by_label_contains("No part of the volume is visible: it is ");
}

#[test]
fn the_near_corner_is_cut_moved_and_shown_again() {
    let mut harness = expand_sections(window_without_overlays());
    wait_until_idle(&mut harness);
    let (whole, _) = picture(&mut harness);
    click(&mut harness, "Corner");
    let bounds = |harness: &Harness<'_, App>| match harness.state().settings().cuts.shapes.as_slice() {
        [ShapeCut { on: true, action: CutAction::Hide, shape: CutShape::Box(bounds), .. }] => *bounds,
        other => panic!("a box: {other:?}"),
    };
    // The camera of a first look is in front, above, and on one side.
    let (cut, eye) = (bounds(&harness), harness.state().settings().camera.position());
    let is_high = [0, 1, 2].map(|axis| cut.low[axis] == 0.5);
    assert_eq!(is_high, [eye.x > 0.0, eye.y > 0.0, eye.z > 0.0], "{cut:?}");
    wait_until_idle(&mut harness);
    let (without, _) = picture(&mut harness);
    assert!(without != whole, "the corner is hidden");
    // With the shadow of the corner, the cut faces are darker.
    let effect = |harness: &Harness<'_, App>| harness.state().settings().cuts.shapes[0].effect;
    click(&mut harness, "Inside: effect");
    click(&mut harness, "Hidden, shadow stays");
    assert_eq!(effect(&harness), ClipEffect::Hidden);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness).0 != without, "the shadow of the corner");
    harness.run_steps(20);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(effect(&harness), ClipEffect::Removed);
    // A side is moved by its number.
    let side = harness.get_by_label("Corner z from").rect().center();
    drag(&mut harness, side, vec2(24.0, 0.0));
    harness.run_steps(3);
    let moved = bounds(&harness);
    assert!(moved.low[2] > cut.low[2] && moved.high == cut.high, "{moved:?}");
    harness.run_steps(20);
    for _ in 0..2 {
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
    }
    assert!(harness.state().settings().cuts.shapes.is_empty());
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness).0 == whole, "no voxel was changed");
    // The half that faces the camera, and the place of its plane.
    click(&mut harness, "Near half");
    let half = |harness: &Harness<'_, App>| match harness.state().settings().cuts.shapes.as_slice() {
        [ShapeCut { on: true, action: CutAction::Hide, shape: CutShape::HalfSpace(plane), .. }] => *plane,
        other => panic!("a half-space: {other:?}"),
    };
    let eye = harness.state().settings().camera.position();
    assert!(half(&harness).unit_normal().dot(eye.normalize()) > 0.999, "{:?}", half(&harness));
    wait_until_idle(&mut harness);
    let (behind, _) = picture(&mut harness);
    assert!(behind != whole && behind != without, "half of the chair");
    harness.get_by_role_and_label(Role::Slider, "Plane at").set_value_accesskit(16.0);
    harness.run_steps(3);
    // The chair is 128 mm high, two units of the scene.
    assert!((half(&harness).offset - 0.25).abs() < 1e-3, "{:?}", half(&harness));
}
