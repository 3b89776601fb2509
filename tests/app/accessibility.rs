//! Accessibility tests: every widget in panels, menus and windows has a name for screen readers.

use chiaroscuro::app::App;
use eframe::egui::{self, Key, Modifiers, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{click, turn_wheel, wait_until, window};

/// Width of a window with all sections expanded, in points.
pub(crate) const EXPANDED_WIDTH: f32 = 700.0;

/// Expands all sections of a window, and makes it tall enough that nothing is scrolled out of view.
pub(crate) fn expand_sections(mut harness: Harness<'static, App>) -> Harness<'static, App> {
    // Zoomed out: in a picture that high, less has to be rendered.
    let (picture, _) = harness.state().viewport_rect().expect("a picture");
    harness.hover_at(picture.center());
    harness.step();
    turn_wheel(&harness, -4000.0);
    harness.run_steps(8);
    harness.remove_cursor();
    // Pictures of such a high window exceed the texture size that egui assumes to be safe.
    harness.input_mut().max_texture_side = Some(8192);
    harness.set_size(Vec2::new(EXPANDED_WIDTH, 3700.0));
    harness.run_steps(3);
    for section in ["Sky and scattering", "Shading", "Clipping", "Floor", "Camera", "Compare", "Data"] {
        click(&mut harness, section);
        harness.run_steps(8);
    }
    // A section that is expanded contains another one further down.
    for at in 0..harness.get_all_by_label("Advanced").count() {
        harness.get_all_by_label("Advanced").nth(at).expect("as many as before").click();
        harness.run_steps(8);
    }
    click(&mut harness, "Corrections");
    harness.run_steps(8);
    harness
}

/// Fails if a widget has no name, listing all of them.
fn check_names(harness: &Harness<'_, App>, place: &str) {
    let unnamed = harness.unnamed_widgets();
    assert!(unnamed.is_empty(), "{place}: {unnamed:#?}");
}

fn press(harness: &mut Harness<'_, App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(6);
}

/// Opens a menu; the menu bar comes first, since other buttons may have the same name.
fn open_menu(harness: &mut Harness<'_, App>, name: &str) {
    harness.get_all_by_label(name).next().expect("a menu").click();
    harness.run_steps(6);
}

#[test]
fn every_widget_has_a_name() {
    let mut harness = expand_sections(window());
    check_names(&harness, "the panels");
    for on in ["Crop box", "Clip plane", "Floor under the volume", "Compare two looks", "Spotlight"] {
        if harness.query_by_label(on).is_some() {
            click(&mut harness, on);
            harness.run_steps(4);
        }
    }
    harness.get_by_label("Positional").click();
    harness.hover_at(egui::pos2(300.0, 400.0));
    harness.run_steps(4);
    check_names(&harness, "the panels, with everything on");

    for menu in ["File", "Edit", "View", "Light", "Help"] {
        open_menu(&mut harness, menu);
        check_names(&harness, menu);
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
    for button in ["Presets", "Transfer function"] {
        click(&mut harness, button);
        harness.run_steps(4);
        check_names(&harness, button);
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
    for (modifiers, key, what) in [
        // Before dialogs that take letters as text.
        (Modifiers::NONE, Key::D, "slices"),
        (Modifiers::COMMAND, Key::E, "the export window"),
        (Modifiers::COMMAND, Key::L, "the window for a path"),
        (Modifiers::NONE, Key::F1, "keys and mouse"),
        (Modifiers::COMMAND, Key::P, "the palette"),
    ] {
        press(&mut harness, modifiers, key);
        check_names(&harness, what);
    }
    press(&mut harness, Modifiers::NONE, Key::Escape);
    for item in ["Try lights…", "Light volume…"] {
        open_menu(&mut harness, "Light");
        harness.get_by_label_contains(item).click();
        harness.run_steps(6);
        wait_until(&mut harness, item, App::is_idle);
        check_names(&harness, item);
    }
}

/// Guards the check itself: a button without a name is found.
#[test]
fn nameless_widgets_are_found() {
    let harness = Harness::builder().with_accessibility_check(false).build_ui(|ui| {
        ui.button("named").clicked();
        let area = ui.allocate_exact_size(Vec2::splat(20.0), egui::Sense::click());
        area.1.widget_info(|| egui::WidgetInfo::new(Role::Button));
    });
    assert_eq!(harness.unnamed_widgets().len(), 1, "{:?}", harness.unnamed_widgets());
}
