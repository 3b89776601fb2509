//! Tests of the side panel: no content makes it wider, and settings that are searched for are revealed in it.

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{Settings, SkyMode};
use eframe::egui::{Event, Key, Modifiers, Rect, Role, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::accessibility::expand_sections;
use crate::harness::{SCENE, adjusted_window, drag, slow_window, wait_until_idle};

/// Creates a window whose first look is changed.
fn window(change: fn(&mut Settings)) -> Harness<'static, App> {
    let adjust = Box::new(move |mut settings: Settings| {
        settings.shadows.keep_balanced = false;
        change(&mut settings);
        settings
    });
    let options =
        WindowOptions { source: Some(SCENE.into()), adjust: Some(adjust), ..WindowOptions::default() };
    adjusted_window(options, Vec2::new(760.0, 1140.0))
}

fn picture_rect(harness: &Harness<'_, App>) -> Rect {
    harness.state().viewport_rect().expect("a picture").0
}

#[test]
fn names_of_any_length_leave_the_picture_as_wide_as_it_is() {
    let usual = picture_rect(&window(|_| {}));
    let long = window(|settings| {
        for light in &mut settings.lights {
            light.name = "Überlänge ".repeat(20);
        }
        settings.sky.mode = SkyMode::Picture;
        settings.sky.picture.name = "panorama_".repeat(22);
    });
    assert_eq!(picture_rect(&long), usual);
}

#[test]
fn the_side_panel_is_as_wide_as_it_is_dragged() {
    let mut harness = window(|_| {});
    let before = picture_rect(&harness);
    // The border is just beyond the picture; a drag in the picture would orbit.
    drag(&mut harness, pos2(before.right() + 2.0, before.center().y), vec2(-80.0, 0.0));
    wait_until_idle(&mut harness);
    let after = picture_rect(&harness);
    assert!((before.right() - after.right() - 80.0).abs() < 6.0, "{before:?} {after:?}");
    assert_eq!(after.left(), before.left());
}

/// A feature switched on by a key is shown in its section, and a setting found by a word in its row.
#[test]
fn sections_open_where_something_is_switched_on_or_sought() {
    let mut harness = window(|_| {});
    assert!(harness.query_by_label("Towards the eye").is_none(), "the section of cuts is folded");
    harness.key_press(Key::X);
    harness.run_steps(12);
    assert!(harness.state().settings().cuts.plane.on);
    assert!(harness.query_by_label("Towards the eye").is_some());
    wait_until_idle(&mut harness);

    assert!(harness.query_by_label("Precision").is_none(), "it is folded away");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("memory precision".to_owned()));
    harness.run_steps(3);
    harness.key_press(Key::Enter);
    harness.run_steps(12);
    let row = harness.get_by_label("16 bits").rect();
    assert!(row.top() > 0.0 && row.bottom() < 1140.0, "{row:?}");
    wait_until_idle(&mut harness);
}

/// Icons above the sections open them and scroll to them, also to those that are open already.
#[test]
fn icons_open_sections() {
    let mut harness = window(|_| {});
    harness.set_size(Vec2::new(760.0, 600.0));
    harness.run_steps(4);
    assert!(harness.query_by_label("Corrections").is_none(), "the section of the data is folded");
    for (section, row) in [("Data", "Corrections"), ("Lights", "Add light")] {
        harness.get_by_label(&format!("Go to {section}")).click();
        harness.run_steps(12);
        let row = harness.get_by_label(row).rect();
        assert!(row.top() > 0.0 && row.bottom() < 600.0, "{section}: {row:?}");
    }
    wait_until_idle(&mut harness);
}

/// An icon scrolls the title of its section to the top of the panel, or the panel to its end, however slow frames
/// are, and whether the section was open or not.
#[test]
fn icons_scroll_to_section_titles() {
    let mut harness = slow_window(Vec2::new(760.0, 600.0));
    let sections = [
        "Data",
        "Shading",
        "Lights",
        "Camera",
        "Sky and scattering",
        "Clipping",
        "Compare",
        "Shadows",
        "Floor",
    ];
    for again in [false, true] {
        for section in sections {
            let drawing = harness.get_by_label(&format!("Go to {section}")).rect();
            harness.get_by_label(&format!("Go to {section}")).click();
            harness.run_steps(14);
            let panel = picture_rect(&harness).right();
            let mut titles = harness.get_all_by_label(section).map(|node| node.rect());
            let title = titles.find(|rect| rect.left() >= panel).expect("a title in the panel");
            let below = title.top() - drawing.bottom();
            let is_at_end = panel_bottom(&harness) <= 600.0;
            assert!(
                (0.0..24.0).contains(&below) || below > 0.0 && is_at_end,
                "{section} ({again}): {title:?}"
            );
        }
    }
    wait_until_idle(&mut harness);
}

/// Bottom of the last section, in points of the window.
fn panel_bottom(harness: &Harness<'_, App>) -> f32 {
    harness
        .get_by_label("Data")
        .rect()
        .bottom()
        .max(harness.query_by_label("Corrections").map_or(0.0, |row| row.rect().bottom()))
}

/// Undo and redo steps are named by their change.
#[test]
fn steps_of_the_history_have_names() {
    let mut harness = window(|_| {});
    harness.key_press_modifiers(Modifiers::SHIFT, Key::G);
    harness.run_steps(12);
    wait_until_idle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().latest_note(), Some("Undone: switch on floor"));
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().latest_note(), Some("Redone: switch on floor"));
    wait_until_idle(&mut harness);
}

/// Tooltips state the measured cost of soft light at other resolutions before one is chosen.
#[test]
fn tips_say_what_other_resolutions_of_soft_light_take() {
    let mut harness = expand_sections(crate::harness::window());
    let mut tips = Vec::new();
    for on in ["White", "Bounces"] {
        match on {
            "Bounces" => harness.get_by_role_and_label(Role::Slider, on).set_value_accesskit(1.0),
            _ => harness.get_by_label(on).click(),
        }
        harness.run_steps(4);
        wait_until_idle(&mut harness);
    }
    // Sections that were switched off could not be expanded.
    for at in 0..harness.get_all_by_label("Advanced").count() {
        harness.get_all_by_label("Advanced").nth(at).expect("as many as before").click();
        harness.run_steps(8);
    }
    // The first look has a quarter of the resolution for some of them, and half of it for others.
    for resolution in ["Quarter", "Half"] {
        for at in 0..harness.get_all_by_label(resolution).count() {
            let place = harness.get_all_by_label(resolution).nth(at).expect("as many as before").rect();
            harness.hover_at(place.center());
            harness.run_steps(12);
            tips.extend(harness.query_all_by_label_contains(" about ").map(|tip| format!("{tip:?}")));
        }
    }
    let saying = |words: &str| tips.iter().filter(|tip| tip.contains(words)).count();
    assert!(saying("Each light volume takes about ") >= 1, "{tips:#?}");
    assert!(saying("Takes about ") >= 2, "of the sky, and of bounces: {tips:#?}");
}
