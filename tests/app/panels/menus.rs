//! Tests of menus in low windows: they end within the window, and all of their rows can be reached.

use chiaroscuro::app::App;
use eframe::egui::{Key, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::harness::{turn_wheel, wait_until_idle, window};

/// Sizes of a small laptop's window, and of the smallest useful window.
const SIZES: [Vec2; 2] = [Vec2::new(1280.0, 680.0), Vec2::new(640.0, 400.0)];

/// Opens a menu: of the menu bar, which comes first, or of the editor.
fn open_menu(harness: &mut Harness<'_, App>, menu: &str) {
    harness.get_all_by_label(menu).next().expect("a menu").click();
    harness.run_steps(6);
}

/// Rectangle of the menu row whose text contains a string. Menus are drawn over everything else, so it is the last
/// match.
fn menu_row_rect(harness: &Harness<'_, App>, row: &str) -> Rect {
    harness.get_all_by_label_contains(row).last().expect("it is in the menu").rect()
}

fn menu_row_bottom(harness: &Harness<'_, App>, row: &str) -> f32 {
    menu_row_rect(harness, row).bottom()
}

#[test]
fn all_rows_of_menus_are_reached_in_low_windows() {
    let mut harness = window();
    for size in SIZES {
        harness.set_size(size);
        harness.run_steps(6);
        for (menu, last) in [("File", "Quit"), ("View", "Theme"), ("Light", "Rim"), ("Presets", "Chair")] {
            open_menu(&mut harness, menu);
            if menu_row_bottom(&harness, last) > size.y {
                let rows = menu_row_rect(&harness, last);
                harness.hover_at(rows.center() - Vec2::new(0.0, rows.center().y - 0.5 * size.y));
                for _ in 0..4 {
                    turn_wheel(&harness, -400.0);
                    harness.run_steps(12);
                }
            }
            let at = menu_row_bottom(&harness, last);
            assert!(at > 0.0 && at <= size.y, "{menu} at {size}: {last} at {at}");
            harness.key_press(Key::Escape);
            harness.run_steps(4);
        }
    }
    wait_until_idle(&mut harness);
}

/// Keyboard focus scrolls rows into view.
#[test]
fn menus_scroll_to_the_row_that_has_the_focus() {
    let mut harness = window();
    harness.set_size(SIZES[1]);
    harness.run_steps(6);
    open_menu(&mut harness, "View");
    let find =
        |harness: &Harness<'_, App>| harness.get_all_by_label("Theme").last().expect("a row").is_focused();
    for _ in 0..60 {
        if find(&harness) {
            break;
        }
        harness.key_press(Key::ArrowDown);
        harness.run_steps(2);
    }
    assert!(find(&harness), "arrow keys lead to the last row");
    harness.run_steps(12);
    let at = menu_row_bottom(&harness, "Theme");
    assert!(at > 0.0 && at <= SIZES[1].y, "{at}");
    wait_until_idle(&mut harness);
}
