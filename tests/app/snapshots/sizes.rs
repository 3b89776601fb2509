//! Snapshots of the whole window without its picture: at three sizes, with the longest texts, and with wider letters,
//! like translations that are longer.

use chiaroscuro::app::{App, WindowOptions};
use chiaroscuro_scene::{SavedEntry, Settings, SkyMode};
use eframe::egui::{Rect, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use image::RgbaImage;

use super::{THEMES, check, in_theme};
use crate::accessibility::{EXPANDED_WIDTH, expand_sections};
use crate::harness::{SCENE, sharp_window, sharp_window_with, wait_until_idle};

/// Factor by which translations are longer than English.
const TRANSLATION_LENGTH_FACTOR: f32 = 1.4;

/// Smallest margin between a panel's contents and the window's edge, in points.
const MARGIN: f32 = 3.0;

/// Height of the status bar, in points, which shows the speed of this machine.
const STATUS_BAR_HEIGHT: f32 = 26.0;

fn window_of(change: fn(&mut Settings), size: Vec2) -> Harness<'static, App> {
    let adjust = Box::new(move |mut settings: Settings| {
        settings.shadows.keep_balanced = false;
        change(&mut settings);
        settings
    });
    sharp_window_with(
        WindowOptions { source: Some(SCENE.into()), adjust: Some(adjust), ..WindowOptions::default() },
        size,
    )
}

/// Sets names of some two hundred letters, wherever there are names.
fn with_long_names(settings: &mut Settings) {
    let name = "Überlänge ".repeat(20);
    settings.lights.iter_mut().for_each(|light| light.name.clone_from(&name));
    settings.sky.mode = SkyMode::Picture;
    settings.sky.picture.name = "panorama_".repeat(22);
    let camera = settings.camera.clone();
    settings.kept = vec![SavedEntry::view(name, &camera)];
}

fn enlarge_letters(harness: &mut Harness<'_, App>) {
    harness.ctx.all_styles_mut(|style| {
        style.text_styles.values_mut().for_each(|font| font.size *= TRANSLATION_LENGTH_FACTOR);
    });
    harness.run_steps(6);
    wait_until_idle(harness);
}

/// Blanks out the picture and the status bar.
fn without_picture(mut window: RgbaImage, picture: Rect) -> RgbaImage {
    let status = window.height() as f32 - STATUS_BAR_HEIGHT;
    for (x, y, pixel) in window.enumerate_pixels_mut() {
        let at = eframe::egui::pos2(x as f32 + 0.5, y as f32 + 0.5);
        if picture.contains(at) || at.y > status {
            *pixel = image::Rgba([90, 90, 90, 255]);
        }
    }
    window
}

fn check_window(harness: &mut Harness<'_, App>, name: &str, failures: &mut Vec<String>) {
    for (theme, suffix) in THEMES {
        let window = in_theme(harness, theme);
        let (picture, _) = harness.state().viewport_rect().expect("a picture");
        let whole = Rect::from_min_size(
            eframe::egui::Pos2::ZERO,
            Vec2::new(window.width() as f32, window.height() as f32),
        );
        check(&without_picture(window, picture), whole, &format!("{name}-{suffix}"), failures);
    }
}

#[test]
fn windows_of_three_sizes() {
    let mut failures = Vec::new();
    let mut harness = window_of(|_| {}, Vec2::new(640.0, 400.0));
    for (name, size) in [("small", [640.0, 400.0]), ("middle", [1280.0, 800.0]), ("large", [1920.0, 1080.0])]
    {
        harness.set_size(size.into());
        harness.run_steps(8);
        wait_until_idle(&mut harness);
        check_window(&mut harness, name, &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Letters as wide as those of longer languages are not cut off in the side panel.
#[test]
fn wide_letters_are_not_cut_off() {
    let mut harness = expand_sections(sharp_window());
    enlarge_letters(&mut harness);
    let mut beyond = Vec::new();
    for role in [
        Role::Button,
        Role::CheckBox,
        Role::RadioButton,
        Role::ComboBox,
        Role::Slider,
        Role::SpinButton,
        Role::TextInput,
    ] {
        let cut =
            harness.query_all_by_role(role).filter(|node| node.rect().right() > EXPANDED_WIDTH - MARGIN);
        beyond.extend(cut.map(|node| (node.accesskit_node().label(), node.rect())));
    }
    assert!(beyond.is_empty(), "{beyond:#?}");
}

/// Long names and wide letters leave the picture as wide as short ones do.
#[test]
fn windows_with_long_names_and_wide_letters() {
    let size = Vec2::new(1280.0, 800.0);
    let mut failures = Vec::new();
    let usual = window_of(|_| {}, size).state().viewport_rect().expect("a picture").0;
    let mut harness = window_of(with_long_names, size);
    check_window(&mut harness, "names", &mut failures);
    let named = harness.state().viewport_rect().expect("a picture").0;
    assert_eq!(named.x_range(), usual.x_range());
    enlarge_letters(&mut harness);
    check_window(&mut harness, "letters", &mut failures);
    let enlarged = harness.state().viewport_rect().expect("a picture").0;
    assert_eq!(enlarged.x_range(), usual.x_range());
    assert!(failures.is_empty(), "{failures:#?}");
}
