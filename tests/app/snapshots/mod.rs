//! Panels, editor and windows look as they did, in the dark and in the light theme.
//!
//! The pictures lie beside this file. With `UPDATE_SNAPSHOTS=1` in the environment they are written anew: look
//! at each before it is committed. What was found lies beside it as `NAME.found.png` after a failure.

use std::path::{Path, PathBuf};

use chiaroscuro::app::App;
use eframe::egui::{Key, Modifiers, Rect, Theme, ThemePreference, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use image::{RgbaImage, imageops};

use crate::harness::{wait_until_idle, window};
use crate::names::unfolded;

/// Steps of 255 by which a channel may differ without being seen: adapters round blended edges differently.
const STEPS: u8 = 24;

/// Pixels that may differ by more, of a thousand: edges of letters that fall between two pixels.
const PER_THOUSAND: usize = 2;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/app/snapshots")
}

/// Whether a picture shows the same as another, for somebody who looks at it.
fn looks_like(found: &RgbaImage, wanted: &RgbaImage) -> Result<(), String> {
    if found.dimensions() != wanted.dimensions() {
        return Err(format!("{:?} pixels, not {:?}", found.dimensions(), wanted.dimensions()));
    }
    let differ = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > STEPS)
    };
    let count = found.pixels().zip(wanted.pixels()).filter(differ).count();
    let allowed = found.pixels().len() * PER_THOUSAND / 1000;
    if count > allowed { Err(format!("{count} pixels differ, {allowed} may")) } else { Ok(()) }
}

/// Compares a part of the window with its snapshot.
fn check(window: &RgbaImage, area: Rect, name: &str, failures: &mut Vec<String>) {
    let [left, top] = [area.min.x, area.min.y].map(|at| at.max(0.0).round() as u32);
    let [width, height] = [area.width(), area.height()].map(|length| length.round() as u32);
    let found = imageops::crop_imm(window, left, top, width, height).to_image();
    let path = folder().join(format!("{name}.png"));
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::create_dir_all(folder()).expect("a folder");
        found.save(&path).expect("written");
        return;
    }
    let wanted = image::open(&path).unwrap_or_else(|err| panic!("{}: {err}", path.display())).to_rgba8();
    if let Err(why) = looks_like(&found, &wanted) {
        found.save(folder().join(format!("{name}.found.png"))).expect("written");
        failures.push(format!("{name}: {why}"));
    }
}

/// The two themes, by the names that their snapshots have.
const THEMES: [(Theme, &str); 2] = [(Theme::Dark, "dark"), (Theme::Light, "light")];

fn in_theme(harness: &mut Harness<'_, App>, theme: Theme) -> RgbaImage {
    harness.ctx.set_theme(match theme {
        Theme::Dark => ThemePreference::Dark,
        Theme::Light => ThemePreference::Light,
    });
    // Nothing is hovered, and nothing fades any more.
    harness.remove_cursor();
    harness.run_steps(12);
    harness.render().expect("the window")
}

#[test]
fn panels_and_editor() {
    let mut harness = unfolded(900.0);
    wait_until_idle(&mut harness);
    let mut failures = Vec::new();
    for (theme, suffix) in THEMES {
        let window = in_theme(&mut harness, theme);
        let (picture, _) = harness.state().viewport_rect().expect("a picture");
        let [width, height] = [window.width(), window.height()].map(|n| n as f32);
        let side = Rect::from_min_max(pos2(picture.right(), picture.top()), pos2(width, picture.bottom()));
        check(&window, side, &format!("side-{suffix}"), &mut failures);
        let menu = Rect::from_min_max(pos2(0.0, 0.0), pos2(width, picture.top()));
        check(&window, menu, &format!("menu-{suffix}"), &mut failures);
        // Without the status bar, which says how fast this machine is.
        let editor = Rect::from_min_max(pos2(0.0, picture.bottom()), pos2(width, height - 26.0));
        check(&window, editor, &format!("editor-{suffix}"), &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn windows_over_the_picture() {
    let mut harness = window();
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
        for (theme, suffix) in THEMES {
            let window = in_theme(&mut harness, theme);
            let area = harness.get_by_role(eframe::egui::Role::Window).rect();
            check(&window, area.shrink(2.0), &format!("{name}-{suffix}"), &mut failures);
        }
        harness.get_by_label("Close window").click();
        harness.run_steps(6);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn other_pictures_are_noticed() {
    let plain = RgbaImage::from_pixel(50, 40, image::Rgba([30, 32, 38, 255]));
    assert!(looks_like(&plain, &plain).is_ok());
    let mut rounded = plain.clone();
    rounded.pixels_mut().for_each(|pixel| pixel.0[0] += STEPS);
    assert!(looks_like(&rounded, &plain).is_ok());
    // A word that is missing: five pixels in 2000.
    let mut changed = plain.clone();
    (10..15).for_each(|x| changed.put_pixel(x, 7, image::Rgba([212, 216, 224, 255])));
    assert!(looks_like(&changed, &plain).is_err());
    assert!(looks_like(&RgbaImage::new(50, 41), &plain).is_err());
}
