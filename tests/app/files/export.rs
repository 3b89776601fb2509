//! Tests of pictures and animations that the window exports.

use std::path::PathBuf;

use chiaroscuro_media::{PicturePixels, export_png, read_picture};
use chiaroscuro_render::RenderOptions;
use chiaroscuro_scene::{ImageSpec, PixelFormat};
use eframe::egui::{self, Modifiers};
use egui_kittest::kittest::Queryable as _;

use crate::harness::{click, render, render_with, second_renderer, wait_until, window};

#[test]
fn exports_are_what_the_renderer_makes() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let (exported, expected): (PathBuf, PathBuf) =
        (folder.path().join("window.png"), folder.path().join("own.png"));
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&exported, [200, 150], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    export_png([200, 150], &render(&harness, [200, 150]).display, false, None, &expected).unwrap();
    let pixels = |path: &PathBuf| image::open(path).expect("a picture").to_rgba8().into_raw();
    assert!(pixels(&exported) == pixels(&expected));

    // The open export window, with its box ticked.
    click(&mut harness, "Transparent background");
    let before = std::fs::read(&exported).unwrap();
    click(&mut harness, "Export");
    harness.run_steps(2);
    assert!(harness.query_by_label("window.png already exists. Replace it?").is_some());
    assert!(!harness.state().is_exporting() && std::fs::read(&exported).unwrap() == before);
    click(&mut harness, "Replace");
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let image_spec = ImageSpec { transparent: true, ..ImageSpec::new([200, 150]) };
    let options = RenderOptions::for_image(&image_spec, harness.state().settings());
    export_png([200, 150], &render_with(&harness, [200, 150], &options).display, true, None, &expected)
        .unwrap();
    assert!(pixels(&exported) == pixels(&expected));
    assert!(harness.state().errors().is_empty());
}

#[test]
fn fine_pictures_come_from_the_window() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fine.png");
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&path, [60, 45], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    for (depth, ending, label) in
        [(PixelFormat::Sixteen, "png", "PNG, 16 bit"), (PixelFormat::Linear, "exr", "EXR")]
    {
        click(&mut harness, label);
        click(&mut harness, "4 samples per pixel");
        click(&mut harness, "Export");
        if path.with_extension(ending).exists() {
            click(&mut harness, "Replace");
        }
        wait_until(&mut harness, "never exported", |app| !app.is_exporting());
        let app = harness.state();
        let (dataset, mut renderer) = second_renderer();
        let image_spec = ImageSpec { samples: 2, depth, ..ImageSpec::new([60, 45]) };
        let expected = renderer.bands(&dataset, app.settings(), &image_spec).all().unwrap();
        let found = read_picture(&path.with_extension(ending)).unwrap();
        let expected = PicturePixels { size: [60, 45], rows: expected.after_round_trip(&image_spec) };
        assert!(found == expected, "{label}");
    }
    assert!(harness.state().errors().is_empty());
}

#[test]
fn turntables_and_copies_come_from_the_window() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.png");
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&path, [24, 18], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    click(&mut harness, "Turntable");
    click(&mut harness, "Export");
    click(&mut harness, "Replace");
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(std::fs::read(&path).unwrap()));
    let frames = image::AnimationDecoder::into_frames(decoder.unwrap().apng().unwrap());
    assert_eq!(frames.count(), 72);
    // File format and file name follow each other.
    click(&mut harness, "GIF");
    click(&mut harness, "Export");
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let gif = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(
        std::fs::read(path.with_extension("gif")).unwrap(),
    ));
    assert_eq!(image::AnimationDecoder::into_frames(gif.unwrap()).count(), 72);
    click(&mut harness, "Image sequence");
    // So large that the test cannot wait for all frames.
    click(&mut harness, "1920 × 1080");
    click(&mut harness, "Export");
    let is_picture =
        |name: &std::ffi::OsStr| std::path::Path::new(name).extension().is_some_and(|end| end == "png");
    let made = || {
        let all = std::fs::read_dir(path.with_extension("")).into_iter().flatten().flatten();
        all.filter(|entry| is_picture(&entry.file_name())).count()
    };
    wait_until(&mut harness, "never made one", |_| made() > 0);
    // The window is closed, and the export continues.
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("Export picture or turntable").is_none());
    assert!(harness.query_by_label_contains("Exporting").is_some(), "the status bar says so");
    click(&mut harness, "Cancel");
    wait_until(&mut harness, "never cancelled", |app| !app.is_exporting());
    let made = made();
    assert!((1..72).contains(&made), "{made} were made after all");
    // An existing file is not replaced without asking.
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::E);
    harness.run_steps(3);
    click(&mut harness, "Export");
    harness.run_steps(3);
    assert!(harness.query_by_label("Replace").is_some() && !harness.state().is_exporting());
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);

    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), egui::Key::C);
    harness.run_steps(2);
    wait_until(&mut harness, "never copied", |app| !app.is_exporting());
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("on the clipboard").is_some());
    assert!(harness.state().errors().is_empty());
}
