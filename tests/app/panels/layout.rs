//! Tests of the window's layout: picture only, docked tools, the strip of kept views, undo history, and messages.

use chiaroscuro::app::App;
use chiaroscuro_scene::{SavedEntry, Settings};
use eframe::egui::{Key, Modifiers, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{click, click_at, drag, wait_until, wait_until_idle, window};

fn picture_rect(harness: &Harness<'_, App>) -> Rect {
    harness.state().viewport_rect().expect("a picture").0
}

fn settings(harness: &Harness<'_, App>) -> Settings {
    harness.state().settings().clone()
}

/// Switching a feature on by a key opens its section, also if the panel is hidden.
#[test]
fn keys_reveal_the_section_they_switch_on() {
    let mut harness = window();
    harness.key_press(Key::N);
    harness.run_steps(4);
    assert!(harness.query_by_label("Crop box").is_none());
    harness.key_press(Key::K);
    harness.run_steps(8);
    assert!(harness.query_by_label("Crop box").is_some());
    harness.key_press(Key::N);
    harness.key_press(Key::K);
    harness.run_steps(8);
    assert!(harness.query_by_label("Crop box").is_none(), "what is switched off leaves it hidden");
}

#[test]
fn the_picture_can_be_alone() {
    let mut harness = window();
    let usual = picture_rect(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Backslash);
    harness.run_steps(3);
    let alone = picture_rect(&harness);
    assert_eq!(alone, harness.ctx.content_rect(), "nothing else is there");
    assert!(harness.query_by_label("File").is_none());
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(picture_rect(&harness), usual);
    // Each panel can be hidden separately.
    harness.key_press_modifiers(Modifiers::SHIFT, Key::N);
    harness.run_steps(12);
    let higher = picture_rect(&harness);
    assert!(higher.height() > usual.height() + 100.0 && higher.width() == usual.width(), "{higher}");
    wait_until_idle(&mut harness);
}

#[test]
fn tools_are_docked_beside_the_picture_and_float_again() {
    let mut harness = window();
    let usual = picture_rect(&harness);
    harness.key_press(Key::D);
    harness.run_steps(4);
    assert_eq!(picture_rect(&harness), usual, "a window hides, and takes no room");
    click(&mut harness, "Dock Slices beside the picture");
    harness.run_steps(4);
    let beside = picture_rect(&harness);
    assert!(beside.left() > usual.left() + 200.0 && beside.right() == usual.right(), "{beside}");
    let slice = harness.get_by_label("Slice across z").rect();
    assert!(slice.right() <= beside.left(), "{slice} beside {beside}");
    // Picture-only mode hides the tool as well.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Backslash);
    harness.run_steps(3);
    assert!(harness.query_by_label("Slice across z").is_none());
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert_eq!(picture_rect(&harness), beside);
    // Escape closes the tool under the pointer.
    harness.hover_at(picture_rect(&harness).center());
    harness.step();
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(picture_rect(&harness), beside, "over the picture it is for the picture");
    let slice = harness.get_by_label("Slice across z").rect();
    harness.hover_at(slice.center());
    harness.step();
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert_eq!(picture_rect(&harness), usual);
    harness.key_press(Key::D);
    harness.run_steps(4);
    assert_eq!(picture_rect(&harness), beside, "where it was");
    click(&mut harness, "Make Slices a window");
    harness.run_steps(4);
    assert_eq!(picture_rect(&harness), usual);
    assert!(harness.query_by_label("Slice across z").is_some(), "and it is still open");
    wait_until_idle(&mut harness);
}

#[test]
fn views_and_looks_are_kept_named_moved_and_compared() {
    let mut harness = window();
    let first = settings(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Num4);
    harness.run_steps(4);
    assert!(harness.query_by_label("Go to View 4").is_some(), "the strip is there");
    click(&mut harness, "+ Look");
    harness.key_press_modifiers(Modifiers::SHIFT, Key::G);
    harness.key_press(Key::Num7);
    wait_until_idle(&mut harness);
    let turned = settings(&harness);
    assert!(turned.floor.on != first.floor.on && turned.camera != first.camera);
    click(&mut harness, "+ Look");
    let names = |harness: &Harness<'_, App>| {
        settings(harness).kept.iter().map(|kept| kept.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&harness), ["View 4", "Look 1", "Look 2"]);
    // Applying a look keeps the view, and applying a view keeps the look.
    click(&mut harness, "Go to Look 1");
    let back = settings(&harness);
    assert_eq!((back.floor.on, &back.camera), (first.floor.on, &turned.camera));
    click(&mut harness, "Go to View 4");
    assert_eq!(settings(&harness).camera, first.camera);
    assert_eq!(settings(&harness).kept.len(), 3, "what is kept stays");
    // Two marked looks are compared.
    for look in ["Go to Look 1", "Go to Look 2"] {
        harness.get_by_label(look).click_modifiers(Modifiers::COMMAND);
        harness.run_steps(3);
    }
    harness.run_steps(4);
    wait_until_idle(&mut harness);
    assert!(harness.query_by_label("Difference").is_some() || harness.query_by_label("Divider").is_some());
    // A view and a look are compared as well, each centred in its half: no overlay covers both.
    assert!(!harness.state().light_handle_positions().is_empty());
    harness.get_by_label("Go to View 4").click_modifiers(Modifiers::COMMAND);
    harness.run_steps(4);
    wait_until_idle(&mut harness);
    assert!(harness.state().light_handle_positions().is_empty());
    harness.get_by_label("Go to View 4").click_modifiers(Modifiers::COMMAND);
    harness.key_press(Key::C);
    wait_until_idle(&mut harness);
    // The last one is dragged to the front, which can be undone.
    let from = harness.get_by_label("Go to Look 2").rect().center();
    let to = harness.get_by_label("Go to View 4").rect().left_center();
    drag(&mut harness, from, to - from);
    harness.run_steps(4);
    assert_eq!(names(&harness), ["Look 2", "View 4", "Look 1"]);
    harness.run_steps(8);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(names(&harness), ["View 4", "Look 1", "Look 2"]);
    assert!(settings(&harness).kept.iter().filter_map(SavedEntry::as_look).count() == 2);
    wait_until_idle(&mut harness);
    // The kept items remain for the next volume, with new thumbnails.
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:sphere:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("sphere") && app.is_idle());
    assert_eq!(names(&harness), ["View 4", "Look 1", "Look 2"]);
    harness.run_steps(4);
    assert!(harness.query_by_label("Go to Look 2").is_some());
}

#[test]
fn steps_are_listed_and_gone_to() {
    let mut harness = window();
    let first = settings(&harness);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::G);
    harness.run_steps(12);
    harness.key_press(Key::Num7);
    wait_until_idle(&mut harness);
    harness.run_steps(12);
    let last = settings(&harness);
    click(&mut harness, "Edit");
    harness.get_by_label_contains("History of steps").click();
    harness.run_steps(4);
    click(&mut harness, "Start");
    harness.run_steps(4);
    let start = settings(&harness);
    assert_eq!((start.floor.on, &start.camera), (first.floor.on, &first.camera));
    // The undone step is shown in the status bar until the next change, and never over the picture.
    let said = harness.get_by_label("Undone: switch on floor").rect();
    assert!(said.top() > picture_rect(&harness).bottom(), "{said:?}");
    assert!(harness.query_by_label_contains(" message").is_none(), "a step is no message");
    click(&mut harness, "2  Turn camera");
    harness.run_steps(4);
    assert_eq!(settings(&harness).camera, last.camera);
    assert_eq!(settings(&harness).floor.on, last.floor.on);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("Start").is_none());
    wait_until_idle(&mut harness);
}

#[test]
fn messages_are_listed_after_they_disappear() {
    let mut harness = window();
    let ctx = harness.ctx.clone();
    harness.state_mut().open("/no/such/volume.nrrd", &ctx);
    wait_until(&mut harness, "no error", |app| !app.errors().is_empty());
    harness.run_steps(4);
    click(&mut harness, "Dismiss");
    harness.run_steps(3);
    assert!(harness.query_by_label("Dismiss").is_none());
    harness.get_by_label_contains(" message").click();
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("there is no such file").is_some());
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("there is no such file").is_none());
    assert!(harness.query_by_label_contains(" message").is_none(), "they have been read");
}

#[test]
fn the_probe_names_a_cause_offers_cures_and_measures() {
    let mut harness = window();
    let first = settings(&harness);
    harness.key_press(Key::I);
    let middle = picture_rect(&harness).center();
    harness.hover_at(middle);
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("Click for remedies").is_some());
    click_at(&mut harness, middle, 1);
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("Click for remedies").is_none(), "it was clicked");
    assert_eq!(settings(&harness), first, "asking changes nothing");
    // A second point, a little further away: their distance is shown.
    let other = middle + vec2(-24.0, -10.0);
    click_at(&mut harness, other, 1);
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("from the previous point").is_some());
    harness.key_press(Key::Escape);
    harness.remove_cursor();
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("from the previous point").is_none());
    // Without light there is a cause and a remedy.
    harness.key_press(Key::M);
    harness.run_steps(2);
    for light in 0..harness.state().settings().lights.len() {
        if harness.state().settings().lights[light].on {
            harness.key_press(Key::Period);
            harness.key_press(Key::M);
            harness.run_steps(2);
        }
    }
    click_at(&mut harness, middle, 1);
    harness.run_steps(4);
    assert!(harness.query_by_label("Dark: no light is on").is_some());
    click(&mut harness, "Switch it on");
    assert!(settings(&harness).lights[0].on);
    harness.key_press(Key::I);
    wait_until_idle(&mut harness);
}

#[test]
fn a_section_says_that_it_is_on_and_is_put_back() {
    let mut harness = window();
    let first = settings(&harness);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::G);
    harness.run_steps(12);
    assert_ne!(settings(&harness).floor, first.floor);
    click(&mut harness, "Reset Floor");
    assert_eq!(settings(&harness).floor, first.floor);
    assert!(harness.query_by_label("Reset Floor").is_none(), "there is nothing more to put back");
    wait_until_idle(&mut harness);
}

#[test]
fn views_from_the_sides_show_all_of_the_object() {
    let mut harness = window();
    let outline = |harness: &Harness<'_, App>| {
        let (dataset, _) = crate::harness::second_renderer();
        chiaroscuro_scene::first_look::ObjectOutline::from_settings(
            harness.state().settings(),
            dataset.volume(),
        )
    };
    let object = outline(&harness);
    for key in [Key::Num1, Key::Num3, Key::Num7, Key::Num9] {
        // From as near as the user may have zoomed.
        harness.state_mut();
        let middle = picture_rect(&harness).center();
        harness.hover_at(middle);
        harness.step();
        crate::harness::turn_wheel(&harness, 400.0);
        harness.run_steps(6);
        let before = settings(&harness).camera;
        harness.key_press(key);
        wait_until(&mut harness, "never turned", |app| app.settings().camera != before);
        let camera = settings(&harness).camera;
        assert!(camera.distance >= object.least_distance(&camera), "{key:?}: {camera:?}");
    }
    // Orbiting a framed object keeps it in the frame.
    let middle = picture_rect(&harness).center();
    drag(&mut harness, middle, vec2(160.0, 90.0));
    let camera = settings(&harness).camera;
    assert!(camera.distance * 1.001 >= object.least_distance(&camera), "{camera:?}");
    wait_until_idle(&mut harness);
}

#[test]
fn small_and_large_windows_have_a_picture_and_all_panels() {
    let mut harness = window();
    harness.key_press_modifiers(Modifiers::SHIFT, Key::V);
    // The last two are a screen of 1920 × 1080 pixels at scales 1 and 2.
    for (size, scale) in [
        ([640.0, 400.0], 0.5),
        ([1280.0, 800.0], 0.5),
        ([3840.0, 2160.0], 0.5),
        ([1920.0, 1080.0], 1.0),
        ([960.0, 540.0], 2.0),
    ] {
        harness.input_mut().max_texture_side = Some(8192);
        harness.set_pixels_per_point(scale);
        harness.set_size(size.into());
        harness.run_steps(8);
        wait_until_idle(&mut harness);
        let window = Rect::from_min_size(eframe::egui::Pos2::ZERO, size.into());
        let (picture, pixels) = harness.state().viewport_rect().expect("a picture");
        assert!(window.contains_rect(picture), "{size:?}: {picture}");
        assert!(picture.width() > 0.4 * size[0] && picture.height() > 0.1 * size[1], "{size:?}: {picture}");
        assert_eq!(pixels[0], (scale * picture.width()).round() as u32, "{size:?}: as fine as the screen");
        for label in ["File", "Help", "Eye", "+ View"] {
            let part = harness.get_by_label(label).rect();
            assert!(window.contains_rect(part), "{size:?}: {label} at {part}");
        }
    }
}
