//! Snapshot tests: panels, editor and windows look unchanged, in the dark and in the light theme.
//!
//! The pictures are beside this file. With `UPDATE_SNAPSHOTS=1` in the environment they are written anew: look at
//! each before it is committed. After a failure the picture that was found is beside them as `NAME.found.png`.

mod sizes;

use std::path::{Path, PathBuf};

use chiaroscuro::app::App;
use eframe::egui::{Event, Key, Modifiers, Rect, Role, Theme, ThemePreference, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use image::{RgbaImage, imageops};

use crate::accessibility::expand_sections;
use crate::files::raw_import::{drop_and_analyse, write_scan};
use crate::files::start_screen::start_window;
use crate::harness::{sharp_window, wait_until_idle};
use crate::thresholds::{MAX_CHANNEL_STEPS, MAX_DIFFERENT_PIXELS};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/app/snapshots")
}

/// Compares a picture with its snapshot, up to differences that are not visible; an error says how they differ.
fn compare_with_snapshot(found: &RgbaImage, wanted: &RgbaImage) -> Result<(), String> {
    if found.dimensions() != wanted.dimensions() {
        return Err(format!("{:?} pixels, not {:?}", found.dimensions(), wanted.dimensions()));
    }
    let differ = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > MAX_CHANNEL_STEPS)
    };
    let count = found.pixels().zip(wanted.pixels()).filter(differ).count();
    if count > MAX_DIFFERENT_PIXELS {
        Err(format!("{count} pixels differ, {MAX_DIFFERENT_PIXELS} may"))
    } else {
        Ok(())
    }
}

/// Crops a picture of the window to an area, in whole pixels.
fn crop(window: &RgbaImage, area: Rect) -> RgbaImage {
    let [left, top] = [area.min.x, area.min.y].map(|at| at.max(0.0).round() as u32);
    let [width, height] = [area.width(), area.height()].map(|length| length.round() as u32);
    imageops::crop_imm(window, left, top, width, height).to_image()
}

/// Width of the dock beside the picture with its border, in points.
const DOCK_WIDTH: f32 = 480.0;

/// Compares a part of the window with its snapshot, or updates the snapshot.
fn check(window: &RgbaImage, area: Rect, name: &str, failures: &mut Vec<String>) {
    let found = crop(window, area);
    let path = folder().join(format!("{name}.png"));
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::create_dir_all(folder()).expect("a folder");
        found.save(&path).expect("written");
        return;
    }
    let wanted = image::open(&path).unwrap_or_else(|err| panic!("{}: {err}", path.display())).to_rgba8();
    if let Err(why) = compare_with_snapshot(&found, &wanted) {
        found.save(folder().join(format!("{name}.found.png"))).expect("written");
        failures.push(format!("{name}: {why}"));
    }
}

/// Themes, with the suffixes of their snapshots.
const THEMES: [(Theme, &str); 2] = [(Theme::Dark, "dark"), (Theme::Light, "light")];

fn in_theme(harness: &mut Harness<'_, App>, theme: Theme) -> RgbaImage {
    harness.ctx.set_theme(match theme {
        Theme::Dark => ThemePreference::Dark,
        Theme::Light => ThemePreference::Light,
    });
    // No widget is hovered, and nothing fades any more.
    harness.remove_cursor();
    harness.run_steps(12);
    harness.render().expect("the window")
}

/// Texts in an area of the window, and their rectangles.
fn words_in(harness: &Harness<'_, App>, area: Rect) -> Vec<(String, Rect)> {
    let labels = harness.get_all_by_role(Role::Label);
    let words = labels.filter_map(|node| Some((node.accesskit_node().value()?, node.rect())));
    words.filter(|(_, rect)| area.contains_rect(*rect)).collect()
}

/// Replaces each word by another word of the window, one at a time: each must be noticed, in a picture of an area
/// that is as large as its snapshot.
fn check_changed_words_detected(window: &RgbaImage, area: Rect, words: &[(String, Rect)]) {
    let right = crop(window, area);
    let mut changed = 0;
    for (old, new) in words.iter().zip(words.iter().cycle().skip(1)).filter(|(old, new)| old.0 != new.0) {
        let mut wrong = window.clone();
        let word = crop(window, new.1.expand(1.0));
        let [left, top] = [old.1.min.x, old.1.min.y].map(|at| (at - 1.0).round() as u32);
        let ground = *window.get_pixel(left - 1, top);
        let [width, height] = [old.1.width(), old.1.height()].map(|length| length.ceil() as u32 + 2);
        for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            wrong.put_pixel(left + x, top + y, ground);
        }
        imageops::replace(&mut wrong, &word, left.into(), top.into());
        let noticed = compare_with_snapshot(&crop(&wrong, area), &right);
        assert!(noticed.is_err(), "{:?} in the place of {:?} is not noticed", new.0, old.0);
        changed += 1;
    }
    assert!(changed > 40, "only {changed} words were changed");
}

#[test]
fn panels_and_editor() {
    let mut harness = expand_sections(sharp_window());
    wait_until_idle(&mut harness);
    let mut failures = Vec::new();
    for (theme, suffix) in THEMES {
        let window = in_theme(&mut harness, theme);
        let (picture, _) = harness.state().viewport_rect().expect("a picture");
        let [width, height] = [window.width(), window.height()].map(|n| n as f32);
        let side = Rect::from_min_max(pos2(picture.right(), picture.top()), pos2(width, picture.bottom()));
        check(&window, side, &format!("side-{suffix}"), &mut failures);
        check_changed_words_detected(&window, side, &words_in(&harness, side));
        let menu = Rect::from_min_max(pos2(0.0, 0.0), pos2(width, picture.top()));
        check(&window, menu, &format!("menu-{suffix}"), &mut failures);
        // Without the status bar, which shows the speed of this machine.
        let editor = Rect::from_min_max(pos2(0.0, picture.bottom()), pos2(width, height - 26.0));
        check(&window, editor, &format!("editor-{suffix}"), &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn windows_over_the_picture() {
    let mut harness = sharp_window();
    harness.set_size(eframe::egui::vec2(1100.0, 760.0));
    harness.run_steps(4);
    wait_until_idle(&mut harness);
    let mut failures = Vec::new();
    for (modifiers, key, name) in [
        (Modifiers::COMMAND, Key::E, "export"),
        (Modifiers::COMMAND, Key::L, "path"),
        (Modifiers::NONE, Key::F1, "keys"),
    ] {
        harness.key_press_modifiers(modifiers, key);
        harness.run_steps(6);
        if name == "export" {
            // The default folder depends on where the tests run.
            harness.get_by_role_and_label(Role::TextInput, "File").focus();
            harness.run_steps(2);
            harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
            harness.event(Event::Text("/pictures/chair.png".to_owned()));
            harness.run_steps(4);
        }
        for (theme, suffix) in THEMES {
            let window = in_theme(&mut harness, theme);
            // The export window is docked.
            let docked = Rect::from_min_max(pos2(0.0, 28.0), pos2(DOCK_WIDTH, 420.0));
            let area =
                if let Some(window) = harness.query_by_role(Role::Window) { window.rect() } else { docked };
            check(&window, area.shrink(2.0), &format!("{name}-{suffix}"), &mut failures);
        }
        let close = if name == "export" { "Close" } else { "Close window" };
        harness.get_by_label(close).click();
        harness.run_steps(6);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn start_screen() {
    let mut harness = start_window(None);
    let mut failures = Vec::new();
    for (theme, suffix) in THEMES {
        let window = in_theme(&mut harness, theme);
        // Without the status bar, which names the adapter.
        let area =
            Rect::from_min_max(pos2(0.0, 28.0), pos2(window.width() as f32, window.height() as f32 - 26.0));
        check(&window, area, &format!("start-{suffix}"), &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn import_of_raw_voxels() {
    let mut harness = sharp_window();
    harness.set_size(eframe::egui::vec2(1100.0, 760.0));
    harness.run_steps(4);
    wait_until_idle(&mut harness);
    let folder = tempfile::tempdir().expect("a folder");
    drop_and_analyse(&mut harness, &write_scan(folder.path()));
    // No text cursor blinks.
    harness.get_by_label("Cancel").focus();
    // The slices are read meanwhile.
    std::thread::sleep(std::time::Duration::from_millis(500));
    let mut failures = Vec::new();
    for (theme, suffix) in THEMES {
        let window = in_theme(&mut harness, theme);
        let area = harness.get_by_role(Role::Window).rect();
        check(&window, area.shrink(2.0), &format!("raw-{suffix}"), &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn other_pictures_are_noticed() {
    let plain = RgbaImage::from_pixel(50, 40, image::Rgba([30, 32, 38, 255]));
    assert!(compare_with_snapshot(&plain, &plain).is_ok());
    let mut rounded = plain.clone();
    rounded.pixels_mut().for_each(|pixel| pixel.0[0] += MAX_CHANNEL_STEPS);
    assert!(compare_with_snapshot(&rounded, &plain).is_ok());
    let with_pixels = |count: usize| {
        let mut changed = plain.clone();
        changed.pixels_mut().take(count).for_each(|pixel| pixel.0[1] += MAX_CHANNEL_STEPS + 1);
        changed
    };
    assert!(compare_with_snapshot(&with_pixels(MAX_DIFFERENT_PIXELS), &plain).is_ok());
    assert!(compare_with_snapshot(&with_pixels(MAX_DIFFERENT_PIXELS + 1), &plain).is_err());
    assert!(compare_with_snapshot(&RgbaImage::new(50, 41), &plain).is_err());
}
