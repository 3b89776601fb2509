//! The real window, driven without a display: pointer, keys and widgets by their names.

mod names;
mod snapshots;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, Options, wgpu_setup};
use chiaroscuro::data::load::{LoadControl, LoadOptions, open};
use chiaroscuro::data::{Bricks, Volume};
use chiaroscuro::export::{export_png, read_picture};
use chiaroscuro::gpu::{Context, Picture, RenderOptions, Renderer};
use chiaroscuro::model::{Depth, Easing, LightKind, Projection, Shot, TransferFunction};
use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, Role, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// A minute: software adapters on shared cores are slow.
const PATIENCE: Duration = Duration::from_mins(1);

const SCENE: &str = "builtin:chair:32";

/// The window of the tests. It is taller than wide panels need, so that nothing is scrolled away.
pub(crate) fn window() -> Harness<'static, App> {
    let options = Options { source: Some(SCENE.to_owned()), ..Options::default() };
    window_with(options, Vec2::new(760.0, 1100.0))
}

/// A window of some size, in points.
fn window_with(options: Options, size: Vec2) -> Harness<'static, App> {
    let mut setup = wgpu_setup();
    // As the tests of the renderer: the first adapter that there is, software included.
    setup.power_preference = wgpu::PowerPreference::None;
    let mut harness = Harness::builder()
        .with_size(size)
        .with_step_dt(0.1)
        .wgpu_setup(setup.into())
        .build_eframe(|cc| App::new(cc, options).expect("a window"));
    wait_until_idle(&mut harness);
    harness
}

/// The same without marks over the picture, whose bytes can be compared.
fn bare_window() -> Harness<'static, App> {
    let mut harness = window();
    harness.key_press(egui::Key::G);
    harness.run_steps(3);
    harness
}

/// Lets frames pass until a condition holds.
pub(crate) fn wait_until(harness: &mut Harness<'_, App>, what: &str, condition: impl Fn(&App) -> bool) {
    let start = Instant::now();
    loop {
        harness.step();
        if condition(harness.state()) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "{what}: errors {:?}", harness.state().errors());
        std::thread::sleep(Duration::from_millis(2));
    }
}

pub(crate) fn wait_until_idle(harness: &mut Harness<'_, App>) {
    wait_until(harness, "never idle", App::is_idle);
}

/// Presses, moves in steps and releases, with the window running.
fn drag(harness: &mut Harness<'_, App>, from: Pos2, by: Vec2) {
    drag_with(harness, PointerButton::Primary, from, by);
}

fn drag_with(harness: &mut Harness<'_, App>, button: PointerButton, from: Pos2, by: Vec2) {
    let button = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE };
    harness.hover_at(from);
    harness.step();
    harness.event(button(from, true));
    harness.step();
    for i in 1..=4 {
        harness.hover_at(from + by * (i as f32 / 4.0));
        harness.step();
    }
    harness.event(button(from + by, false));
    harness.step();
}

/// The bytes of the picture in the window, and its size.
fn picture(harness: &mut Harness<'_, App>) -> (Vec<u8>, [u32; 2]) {
    // Handles fade out when the pointer is gone.
    harness.remove_cursor();
    harness.run_steps(12);
    wait_until_idle(harness);
    let (rect, size) = harness.state().viewport_rect().expect("a picture");
    let image = harness.render().expect("a picture of the window");
    let (x, y) = (rect.min.x.round() as u32, rect.min.y.round() as u32);
    let mut bytes = Vec::new();
    for row in 0..size[1] {
        for column in 0..size[0] {
            bytes.extend(image.get_pixel(x + column, y + row).0);
        }
    }
    (bytes, size)
}

/// What the renderer makes of the window's settings, on a device of its own.
fn render(harness: &Harness<'_, App>, size: [u32; 2]) -> Picture {
    render_with(harness, size, &RenderOptions::default())
}

fn render_with(harness: &Harness<'_, App>, size: [u32; 2], options: &RenderOptions) -> Picture {
    let (volume, bricks, mut renderer) = beside();
    let settings = harness.state().settings();
    renderer.render(&volume, &bricks, settings, size, options).expect("a picture")
}

/// The window's volume, and a renderer on a device of its own.
fn beside() -> (Arc<Volume>, Arc<Bricks>, Renderer) {
    let volume = open(SCENE, &LoadOptions::default(), &LoadControl::new()).expect("a built-in volume");
    let bricks = Arc::new(Bricks::of(&volume));
    let context = Context::headless().expect("an adapter");
    (Arc::new(volume), bricks, Renderer::new(&context).expect("a renderer"))
}

pub(crate) fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

#[test]
fn the_window_shows_what_the_renderer_makes() {
    let mut harness = bare_window();
    assert_eq!(harness.state().volume_name(), Some("chair"));
    harness.check_accessibility();
    let (shown, size) = picture(&mut harness);
    assert!(shown == render(&harness, size).shown, "the window shows other bytes than the renderer makes");
}

#[test]
fn lights_and_camera_follow_the_mouse() {
    let mut harness = bare_window();
    let (before, _) = picture(&mut harness);
    let rebuilds = harness.state().light_rebuilds();

    // Orbit: nothing is refilled.
    let settings = harness.state().settings().clone();
    let (rect, _) = harness.state().viewport_rect().unwrap();
    drag(&mut harness, rect.left_bottom() + vec2(40.0, -30.0), vec2(60.0, -25.0));
    wait_until_idle(&mut harness);
    let orbited = harness.state().settings().clone();
    assert_ne!(orbited.camera, settings.camera);
    assert_eq!(orbited.lights, settings.lights);
    assert_eq!(harness.state().light_rebuilds(), rebuilds, "orbiting refilled a light volume");
    let (turned, size) = picture(&mut harness);
    assert!(turned != before);
    assert!(turned == render(&harness, size).shown, "after an orbit");

    // The key light's handle.
    harness.hover_at(rect.center());
    harness.run_steps(2);
    let handle = harness.state().light_handle_positions()[0];
    let to_middle = (rect.center() - handle).normalized() * 60.0;
    drag(&mut harness, handle, to_middle);
    wait_until_idle(&mut harness);
    let moved = harness.state().settings().clone();
    assert_ne!(moved.lights[0].position, orbited.lights[0].position);
    assert_eq!(moved.camera, orbited.camera, "the light's drag turned the camera too");
    assert!(harness.state().light_rebuilds() > rebuilds);
    let (lit, size) = picture(&mut harness);
    assert!(lit != turned);
    assert!(lit == render(&harness, size).shown, "after a light drag");

    // Undo puts the light back.
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights[0].position, orbited.lights[0].position);
}

/// A finger or a pen comes from nowhere: it is never above a handle before it presses it.
#[test]
fn handles_are_taken_without_hovering() {
    let mut harness = window();
    harness.remove_cursor();
    harness.run_steps(12);
    let before = harness.state().settings().clone();
    let handle = harness.state().light_handle_positions()[0];
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(handle));
    harness.event(button(handle, true));
    harness.step();
    let to = handle + vec2(-40.0, 30.0);
    harness.event(Event::PointerMoved(to));
    harness.step();
    harness.event(button(to, false));
    harness.event(Event::PointerGone);
    harness.run_steps(2);
    let after = harness.state().settings();
    assert_ne!(after.lights[0].position, before.lights[0].position);
    assert_eq!(after.camera, before.camera);
}

#[test]
fn the_transfer_function_is_edited_in_its_plot() {
    let mut harness = window();
    let before = harness.state().settings().transfer.clone();
    let point = harness.get_by_label("Eye point 2").rect().center();
    drag(&mut harness, point, vec2(14.0, -12.0));
    let after = harness.state().settings().transfer.clone();
    assert_eq!(after.points.len(), before.points.len());
    assert!(
        after.points[1].value > before.points[1].value && after.points[1].opacity > before.points[1].opacity
    );
    assert_eq!(after.points[0], before.points[0]);

    // A click on the empty plot adds a point, Delete removes it.
    let plot = harness.get_by_label("Transfer function").rect();
    let empty = plot.left_top() + vec2(30.0, 30.0);
    drag(&mut harness, empty, Vec2::ZERO);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().transfer.points.len(), before.points.len() + 1);
    harness.key_press(egui::Key::Delete);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().transfer.points.len(), before.points.len());
    wait_until_idle(&mut harness);
}

#[test]
fn panels_change_settings() {
    let mut harness = bare_window();
    click(&mut harness, "Perspective");
    assert_eq!(harness.state().settings().lights[0].kind, LightKind::Perspective);
    click(&mut harness, "Parallel");
    assert_eq!(harness.state().settings().lights[0].kind, LightKind::Parallel);
    click(&mut harness, "Camera");
    // The section slides open.
    harness.run_steps(8);
    click(&mut harness, "Orthographic");
    assert_eq!(harness.state().settings().camera.projection, Projection::Orthographic);

    click(&mut harness, "Light opacity follows the eye's");
    let settings = harness.state().settings();
    assert!(!settings.lighting.linked);
    assert_eq!(settings.lighting.curve, settings.transfer, "a fresh curve starts as the eye's");

    harness.get_by_role_and_label(Role::Slider, "Strength").set_value_accesskit(0.5);
    harness.run_steps(2);
    assert_eq!(harness.state().settings().shadows.strength, 0.5);
    wait_until_idle(&mut harness);
    let (shown, size) = picture(&mut harness);
    assert!(shown == render(&harness, size).shown);
}

#[test]
fn exports_are_what_the_renderer_makes() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let (exported, expected): (PathBuf, PathBuf) =
        (folder.path().join("window.png"), folder.path().join("own.png"));
    let ctx = harness.ctx.clone();
    harness.state_mut().export(&exported, [200, 150], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    export_png([200, 150], &render(&harness, [200, 150]).shown, false, None, &expected).unwrap();
    let pixels = |path: &PathBuf| image::open(path).expect("a picture").to_rgba8().into_raw();
    assert!(pixels(&exported) == pixels(&expected));

    // The open export window, with its box ticked.
    click(&mut harness, "Transparent background");
    click(&mut harness, "Export");
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let options = RenderOptions { transparent: true, ..RenderOptions::default() };
    export_png([200, 150], &render_with(&harness, [200, 150], &options).shown, true, None, &expected)
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
    for (depth, ending, label) in [(Depth::Sixteen, "png", "PNG, 16 bit"), (Depth::Linear, "exr", "EXR")] {
        click(&mut harness, label);
        click(&mut harness, "4 samples per pixel");
        click(&mut harness, "Export");
        wait_until(&mut harness, "never exported", |app| !app.is_exporting());
        let app = harness.state();
        let (volume, bricks, mut renderer) = beside();
        let shot = Shot { samples: 2, depth, ..Shot::new([60, 45]) };
        let expected = renderer.bands(&volume, &bricks, app.settings(), &shot).all().unwrap();
        let found = read_picture(&path.with_extension(ending)).unwrap();
        assert!(found == ([60, 45], expected.as_written(&shot)), "{label}");
    }
    assert!(harness.state().errors().is_empty());
}

#[test]
fn a_dropped_picture_brings_its_look_back() {
    let mut harness = bare_window();
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first.png"), folder.path().join("second.png"));
    let ctx = harness.ctx.clone();
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    harness.state_mut().export(&first, [120, 90], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let before = harness.state().settings().clone();

    // Another look at another volume.
    harness.state_mut().open("builtin:sphere:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("sphere"));
    wait_until_idle(&mut harness);
    assert_ne!(harness.state().settings(), &before);

    // What is opened last counts: no look is laid over another volume.
    harness.state_mut().open(&first.display().to_string(), &ctx);
    harness.state_mut().open("builtin:box:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box"));
    assert_ne!(harness.state().settings().lights, before.lights);

    harness.input_mut().dropped_files.push(Arc::new(Dropped(first.clone())));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair"));
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().settings(), &before);
    harness.state_mut().export(&second, [120, 90], &ctx);
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    assert!(std::fs::read(&first).unwrap() == std::fs::read(&second).unwrap(), "all bytes, record included");
    assert!(harness.state().errors().is_empty());
}

#[test]
fn box_and_plane_are_dragged_in_the_picture() {
    let mut harness = bare_window();
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
    let (middle, tip) = (place(&harness, "Clip plane, place"), place(&harness, "Clip plane, direction"));
    drag(&mut harness, middle, (tip - middle) * 0.5);
    let moved = harness.state().settings().cuts.plane.clone();
    assert!(moved.on && moved.offset > 0.1 && moved.normal == [0.0, -1.0, 0.0], "{moved:?}");
    harness.run_steps(2);
    let tip = place(&harness, "Clip plane, direction");
    drag(&mut harness, tip, vec2(-30.0, -40.0));
    let turned = harness.state().settings().cuts.plane.clone();
    assert!(turned.normal[2] > 0.2 && turned.normal != moved.normal, "{turned:?}");
    harness.run_steps(2);
    assert!(place(&harness, "Clip plane, direction").distance(tip + vec2(-30.0, -40.0)) < 6.0);
    let middle = place(&harness, "Clip plane, place");
    harness.hover_at(middle);
    harness.run_steps(2);
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 50.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    let wheeled = harness.state().settings().cuts.plane.clone();
    assert!(wheeled.offset > turned.offset + 0.005, "{wheeled:?}");
    assert_eq!(harness.state().settings().camera, camera, "neither drags nor wheel reached the camera");

    // Across the line of sight, and all of it undone step by step.
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::X);
    harness.run_steps(3);
    let plane = &harness.state().settings().cuts.plane;
    assert!(plane.unit_normal().dot(camera.scene_from_view().z_axis) > 0.999, "{plane:?}");
    wait_until_idle(&mut harness);
    for _ in 0..12 {
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(2);
    }
    assert_eq!(harness.state().settings().cuts, chiaroscuro::model::Cuts::default());
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
    // 50 points to a notch.
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 110.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    assert!(harness.query_by_label("24, 24, 18").is_some(), "two slices further");
    click(&mut harness, "As in the picture");

    // What the picture shows under the pointer; the seat is below the window with the slices.
    let (rect, _) = harness.state().viewport_rect().expect("a picture");
    let seat = rect.center() + vec2(20.0, 30.0);
    harness.get_by_label("Slices").rect();
    let title = harness.get_by_label("Slices").rect().center();
    drag(&mut harness, title, vec2(0.0, rect.height() / 2.0 + 60.0));
    harness.hover_at(seat);
    harness.step();
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos: seat,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.step();
    }
    harness.run_steps(3);
    assert!(harness.query_by_label("24, 24, 18").is_none(), "the cursor went where the picture was clicked");
    assert_eq!(harness.state().settings().camera, camera);
}

#[test]
fn a_floor_takes_shadows() {
    let mut harness = bare_window();
    let (bare, _) = picture(&mut harness);
    let fills = harness.state().light_rebuilds();
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::G);
    harness.run_steps(2);
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(harness.state().settings().floor.on);
    let (floor, size) = picture(&mut harness);
    assert!(floor != bare);
    assert!(floor == render(&harness, size).shown);
    assert_eq!(harness.state().light_rebuilds(), fills, "the floor needs no light volume");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    wait_until_idle(&mut harness);
    harness.run_steps(20);
    assert!(picture(&mut harness).0 == bare);
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
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(std::fs::read(&path).unwrap()));
    let frames = image::AnimationDecoder::into_frames(decoder.unwrap().apng().unwrap());
    assert_eq!(frames.count(), 72);
    // The kind of file and its name follow each other.
    click(&mut harness, "GIF");
    click(&mut harness, "Export");
    wait_until(&mut harness, "never exported", |app| !app.is_exporting());
    let gif = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(
        std::fs::read(path.with_extension("gif")).unwrap(),
    ));
    assert_eq!(image::AnimationDecoder::into_frames(gif.unwrap()).count(), 72);
    click(&mut harness, "One file per picture");
    // So large that nobody waits for all of them.
    click(&mut harness, "1920 × 1080");
    click(&mut harness, "Export");
    harness.run_steps(3);
    click(&mut harness, "Cancel");
    wait_until(&mut harness, "never cancelled", |app| !app.is_exporting());
    let made = std::fs::read_dir(path.with_extension("")).unwrap().count();
    assert!(made < 72, "{made} were made after all");

    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), egui::Key::C);
    harness.run_steps(2);
    wait_until(&mut harness, "never copied", |app| !app.is_exporting());
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("on the clipboard").is_some());
    assert!(harness.state().errors().is_empty());
}

#[test]
fn lights_are_tried_on_the_volume() {
    let mut harness = window();
    let before = harness.state().settings().lights.clone();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("try lights".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    let begin = Instant::now();
    while harness.query_by_label("From above").is_none() {
        assert!(begin.elapsed() < PATIENCE, "no pictures");
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(harness.query_all_by_label_contains("o'clock").count() % 6, 0);
    click(&mut harness, "Use From above");
    let lights = harness.state().settings().lights.clone();
    assert_ne!(lights, before);
    assert_eq!(lights[0].name, "Sun");
    wait_until_idle(&mut harness);
}

#[test]
fn presets_are_tried_on_the_volume() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    click(&mut harness, "Presets");
    click(&mut harness, "Try presets…");
    let begin = Instant::now();
    while harness.query_by_label("Simulation: Cloud").is_none() {
        assert!(begin.elapsed() < PATIENCE, "no pictures");
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    // The window grows around them.
    harness.run_steps(5);
    assert!(harness.query_all_by_label_contains("CT: ").count() >= 4);
    assert_eq!(harness.state().settings(), &before, "trying changes nothing");
    click(&mut harness, "Use Paper: Lobster");
    assert_ne!(harness.state().settings().transfer, before.transfer);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings(), &before);
    wait_until_idle(&mut harness);
}

#[test]
fn the_next_file_can_have_the_look_of_this_one() {
    let mut harness = window();
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let lights = harness.state().settings().lights.clone();
    let open_sphere = |harness: &mut Harness<'_, App>, n: usize| {
        let ctx = harness.ctx.clone();
        harness.state_mut().open(&format!("builtin:sphere:{n}"), &ctx);
        let other = move |app: &App| app.volume_name() == Some("sphere") && app.is_idle();
        wait_until(harness, "never opened", other);
    };
    open_sphere(&mut harness, 16);
    assert_ne!(harness.state().settings().lights, lights, "a first look of its own");
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("keep this look".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let lights = harness.state().settings().lights.clone();
    let height = harness.state().settings().floor.height;
    let ctx = harness.ctx.clone();
    harness.state_mut().open("builtin:box:16", &ctx);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("box") && app.is_idle());
    assert_eq!(harness.state().settings().lights, lights);
    assert_ne!(harness.state().settings().floor.height, height, "the floor lies under the other object");
}

#[test]
fn voxels_are_averaged_and_the_look_stays() {
    // So tall that the whole section can be seen.
    let options = Options { source: Some(SCENE.to_owned()), ..Options::default() };
    let mut harness = window_with(options, Vec2::new(760.0, 1600.0));
    harness.key_press(egui::Key::CloseBracket);
    click(&mut harness, "Data");
    let before = harness.state().settings().clone();
    let choose = |harness: &mut Harness<'_, App>, block: &str, voxels: &'static str| {
        click(harness, block);
        wait_until(harness, "never read again", App::is_idle);
        harness.run_steps(3);
        assert_eq!(harness.query_all_by_label_contains(voxels).count(), 1, "the title says {voxels}");
        assert_eq!(harness.state().errors(), [""; 0]);
    };
    choose(&mut harness, "2 × 2 × 2", "16×16×16");
    let after = harness.state().settings().clone();
    assert_eq!((&after.camera, &after.transfer), (&before.camera, &before.transfer));
    assert_eq!(after.lights, before.lights);
    // The chair has a unit in millimetres already.
    assert_eq!(after.opacity_unit, before.opacity_unit);
    harness.get_by_label("Averaged from");
    choose(&mut harness, "None", "32×32×32");
    assert!(harness.query_by_label("Averaged from").is_none());
}

#[test]
fn the_first_run_has_hints_and_the_next_remembers() {
    let folder = tempfile::tempdir().unwrap();
    let start = |source: Option<&str>| {
        let options = Options {
            source: source.map(str::to_owned),
            storage: Some(folder.path().to_owned()),
            ..Options::default()
        };
        window_with(options, Vec2::new(760.0, 900.0))
    };
    let mut harness = start(Some(SCENE));
    assert!(harness.query_by_label("Close the hints").is_some());
    harness.key_press(egui::Key::CloseBracket);
    harness.run_steps(2);
    let (rect, _) = harness.state().viewport_rect().unwrap();
    drag(&mut harness, rect.left_center() + vec2(30.0, 60.0), vec2(30.0, 0.0));
    harness.run_steps(20);
    assert!(harness.query_by_label("Close the hints").is_none(), "gone with the first drag");
    wait_until_idle(&mut harness);
    // The look is kept some seconds after it was kept last.
    let kept = folder.path().join("now.json");
    let begin = Instant::now();
    let wanted = harness.state().settings().clone();
    while !std::fs::read_to_string(&kept).is_ok_and(|text| {
        let read = chiaroscuro::model::Record::read(&text).expect("a record");
        read.apply(&wanted, (0.0, 1.0)).expect("settings").0 == wanted
            && text.contains("builtin:chair")
            && read.apply(&chiaroscuro::model::Settings::default(), (0.0, 1.0)).expect("settings").0 == wanted
    }) {
        assert!(begin.elapsed() < PATIENCE, "the look was not kept");
        harness.step();
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(harness);

    let mut harness = start(Some("builtin:sphere:16"));
    assert!(harness.query_by_label("Close the hints").is_none());
    click(&mut harness, "File");
    harness.get_by_label_contains("Go on where").click();
    harness.run_steps(3);
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("chair") && app.is_idle());
    assert_eq!(harness.state().settings(), &wanted);
}

#[test]
fn lights_are_set_by_the_keyboard() {
    let mut harness = window();
    let lights = |harness: &Harness<'_, App>| harness.state().settings().lights.clone();
    let before = lights(&harness);
    let press = |harness: &mut Harness<'_, App>, key| {
        harness.key_press(key);
        harness.run_steps(2);
    };
    press(&mut harness, egui::Key::ArrowRight);
    let turned = lights(&harness);
    let angle = glam::DVec3::from(before[0].position).angle_between(turned[0].position.into()).to_degrees();
    assert!(angle > 0.1 && angle < 1.001, "one degree about the axis, {angle} between directions");
    assert_eq!(turned[1], before[1]);
    harness.key_press_modifiers(Modifiers::SHIFT, egui::Key::ArrowUp);
    harness.run_steps(2);
    let far = lights(&harness);
    let angle = glam::DVec3::from(turned[0].position).angle_between(far[0].position.into()).to_degrees();
    assert!(angle > 2.0, "ten degrees about the axis, {angle} between directions");

    press(&mut harness, egui::Key::Period);
    press(&mut harness, egui::Key::CloseBracket);
    assert!(lights(&harness)[1].intensity > before[1].intensity, "the fill is selected and brighter");
    press(&mut harness, egui::Key::S);
    assert_eq!(lights(&harness).iter().map(|light| light.on).collect::<Vec<_>>(), [false, true]);
    press(&mut harness, egui::Key::M);
    assert!(!lights(&harness)[1].on);

    // The chip selects, as its handle would.
    click(&mut harness, "Light Key, off");
    press(&mut harness, egui::Key::M);
    assert!(lights(&harness)[0].on);
    wait_until_idle(&mut harness);
}

#[test]
fn the_whole_curve_is_colored_moved_and_replaced() {
    let mut harness = window();
    let transfer = |harness: &Harness<'_, App>| harness.state().settings().transfer.clone();
    let first = transfer(&harness);
    click(&mut harness, "Colours");
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

    // The wheel shows fewer values, and points beyond are not in the way.
    let plot = harness.get_by_label("Transfer function").rect();
    harness.hover_at(plot.left_center() + vec2(30.0, 0.0));
    harness.step();
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 400.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(8);
    click(&mut harness, "Show all");
    assert!(harness.query_by_label("Show all").is_none());
    wait_until_idle(&mut harness);
}

#[test]
fn level_and_window_are_dragged_in_the_picture() {
    let mut harness = window();
    let ends = |harness: &Harness<'_, App>| {
        let points = &harness.state().settings().transfer.points;
        (points.first().expect("a point").value, points.last().expect("a point").value)
    };
    let (before, camera) = (ends(&harness), harness.state().settings().camera.clone());
    let center = harness.get_by_label("Picture").rect().center() + vec2(0.0, 60.0);
    drag_with(&mut harness, PointerButton::Secondary, center, vec2(0.0, 40.0));
    harness.run_steps(2);
    let shifted = ends(&harness);
    assert!(shifted.0 > before.0, "down means higher values");
    assert!((shifted.1 - shifted.0 - before.1 + before.0).abs() < 1e-9);
    drag_with(&mut harness, PointerButton::Secondary, center, vec2(40.0, 0.0));
    harness.run_steps(2);
    let spread = ends(&harness);
    assert!(spread.1 - spread.0 > shifted.1 - shifted.0);
    assert!((spread.0 + spread.1 - shifted.0 - shifted.1).abs() < 1e-6, "about the middle");
    assert_eq!(harness.state().settings().camera, camera);
    for _ in 0..2 {
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
    }
    assert_eq!(ends(&harness), before, "each drag is a step");
    wait_until_idle(&mut harness);
}

#[test]
fn hoods_are_opened_by_their_rim() {
    let mut harness = window();
    click(&mut harness, "Perspective");
    click(&mut harness, "Hood");
    harness.run_steps(3);
    let angle = |harness: &Harness<'_, App>| harness.state().settings().lights[0].hood.half_angle_deg;
    let before = angle(&harness);
    // Where the handle is depends on what the picture shows of the cone.
    let mut changes = Vec::new();
    for by in [vec2(24.0, 0.0), vec2(-24.0, 0.0), vec2(0.0, 24.0), vec2(0.0, -24.0)] {
        let handle = harness.get_by_label("Hood handle Key").rect().center();
        drag(&mut harness, handle, by);
        harness.run_steps(2);
        changes.push(angle(&harness) - before);
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
        harness.run_steps(3);
        assert_eq!(angle(&harness), before, "a drag is a step");
    }
    assert!(changes.iter().any(|&change| change > 0.5), "{changes:?}");
    assert!(changes.iter().any(|&change| change < -0.5), "{changes:?}");
    wait_until_idle(&mut harness);
}

#[test]
fn points_are_selected_and_changed_together() {
    let mut harness = window();
    let points = |harness: &Harness<'_, App>| harness.state().settings().transfer.points.clone();
    let before = points(&harness);
    assert!(before.len() >= 4);
    let place = |harness: &Harness<'_, App>, number: usize| {
        harness.get_by_label(&format!("Eye point {number}")).rect().center()
    };
    // A frame around the second and the third, from above to below.
    let plot = harness.get_by_label("Transfer function").rect();
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

    // Looking at the colour changes nothing; a step to the right changes that of both.
    let colors = |harness: &Harness<'_, App>| points(harness).iter().map(|p| p.color).collect::<Vec<_>>();
    let plain = colors(&harness);
    click(&mut harness, "As seen");
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

    // The way to the next point, for both; and one more with Shift.
    click(&mut harness, "Straight");
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
    // All of them with Ctrl+A over the plot; Escape leaves them.
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
    // A selection does not outlive the points that it meant.
    harness.hover_at(plot.center());
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::A);
    harness.run_steps(2);
    click(&mut harness, "Colours");
    click(&mut harness, "Viridis");
    harness.run_steps(3);
    assert!(harness.query_by_label("Level").is_some(), "nothing is selected");
    wait_until_idle(&mut harness);
}

#[test]
fn views_are_found_kept_and_found_again() {
    let mut harness = window();
    let camera = |harness: &Harness<'_, App>| harness.state().settings().camera.clone();
    let first = camera(&harness);
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), egui::Key::Num4);
    harness.run_steps(2);
    for (key, azimuth_deg, elevation_deg) in
        [(egui::Key::Num1, 270.0, 0.0), (egui::Key::Num3, 0.0, 0.0), (egui::Key::Num7, 270.0, 90.0)]
    {
        harness.key_press(key);
        harness.run_steps(2);
        let seen = camera(&harness);
        assert_eq!((seen.azimuth_deg, seen.elevation_deg), (azimuth_deg, elevation_deg));
    }
    harness.key_press(egui::Key::Num5);
    harness.run_steps(2);
    assert_ne!(camera(&harness).projection, first.projection);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Num4);
    harness.run_steps(2);
    assert_eq!(camera(&harness), first);

    // The pointer stays on what it is on while the wheel brings it nearer.
    let (rect, _) = harness.state().viewport_rect().unwrap();
    harness.hover_at(rect.center() + vec2(60.0, 40.0));
    harness.step();
    let scroll = Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 80.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    };
    harness.event(scroll);
    harness.run_steps(6);
    let nearer = camera(&harness);
    assert!(nearer.distance < first.distance && nearer.target != first.target, "{nearer:?}");
    harness.key_press(egui::Key::F);
    harness.run_steps(2);
    assert_eq!(camera(&harness), first, "all of it, from the same side");

    // A double click makes what is there the middle.
    let at = rect.center() + vec2(0.0, 30.0);
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false, true, false] {
        harness.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.step();
    }
    assert_ne!(camera(&harness).target, first.target, "there is something there");
    wait_until_idle(&mut harness);
}

#[test]
fn commands_are_found_by_name() {
    let mut harness = window();
    let lights = harness.state().settings().lights.len();
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(Event::Text("key fill back".to_owned()));
    harness.run_steps(3);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights.len(), lights + 1, "three lights instead of two");
    assert!(harness.query_by_label("Find a command").is_none(), "it has closed");
    wait_until_idle(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().settings().lights.len(), lights);
    wait_until_idle(&mut harness);
}

#[test]
fn the_probe_says_what_light_arrives() {
    let mut harness = bare_window();
    let (before, _) = picture(&mut harness);
    harness.key_press(egui::Key::I);
    let (rect, _) = harness.state().viewport_rect().unwrap();
    harness.hover_at(rect.center());
    harness.run_steps(3);
    let shown = harness.render().expect("a picture of the window");
    harness.key_press(egui::Key::I);
    harness.run_steps(3);
    let hidden = harness.render().expect("a picture of the window");
    assert!(shown.as_raw() != hidden.as_raw(), "the answer is painted over the picture");
    let (after, _) = picture(&mut harness);
    assert!(before == after, "and gone again");
}

/// A file that the mouse has brought.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|err| err.to_string())
    }
}

#[test]
fn a_dropped_file_opens() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ramp_8x9x10_uint8.raw");
    std::fs::write(&path, (0..720).map(|i| (i / 3) as u8).collect::<Vec<_>>()).unwrap();
    harness.input_mut().dropped_files.push(Arc::new(Dropped(path)));
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("ramp"));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
}

#[test]
fn bare_voxels_are_asked_about() {
    let mut harness = window();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.raw");
    std::fs::write(&path, (0..720 + 16).map(|i| (i / 3) as u8).collect::<Vec<_>>()).unwrap();
    harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    let start = Instant::now();
    while harness.query_by_label("How is it stored?").is_none() {
        harness.step();
        assert!(start.elapsed() < PATIENCE, "never asked: {:?}", harness.state().errors());
    }
    harness.run_steps(2);
    assert_eq!(harness.state().volume_name(), Some("chair"), "what is open stays");
    assert!(harness.unnamed_widgets().is_empty(), "{:?}", harness.unnamed_widgets());
    assert!(harness.query_by_label_contains("are missing").is_some());
    for (axis, n) in [("x", 8.0), ("y", 9.0), ("z", 10.0)] {
        let name = format!("Voxels along {axis}");
        harness.get_by_role_and_label(Role::SpinButton, &name).set_value_accesskit(n);
        harness.run_steps(2);
    }
    assert!(harness.query_by_label_contains("16 bytes longer").is_some());
    click(&mut harness, "They are a header");
    assert!(harness.query_by_label_contains("736 bytes").is_some());
    click(&mut harness, "Open");
    wait_until(&mut harness, "never opened", |app| app.volume_name() == Some("scan"));
    wait_until_idle(&mut harness);
    assert!(harness.state().errors().is_empty());
    let header = std::fs::read_to_string(folder.path().join("scan.nhdr")).expect("remembered");
    assert!(header.contains("sizes: 8 9 10") && header.contains("byte skip: 16"), "{header}");
}

#[test]
fn a_missing_file_leaves_the_volume_alone() {
    let mut harness = window();
    let before = harness.state().settings().clone();
    let ctx = harness.ctx.clone();
    harness.state_mut().open("/no/such/volume.nrrd", &ctx);
    wait_until(&mut harness, "no error", |app| !app.errors().is_empty());
    assert!(harness.query_by_label_contains("there is no such file").is_some());
    assert_eq!(harness.state().volume_name(), Some("chair"));
    assert_eq!(harness.state().settings(), &before);
    wait_until_idle(&mut harness);
}

#[test]
fn two_looks_share_the_picture() {
    let mut harness = bare_window();
    let (rect, size) = harness.state().viewport_rect().expect("a picture");
    let (before, _) = picture(&mut harness);
    let fills = harness.state().light_rebuilds();
    harness.key_press(egui::Key::C);
    wait_until_idle(&mut harness);
    assert_eq!(harness.state().light_rebuilds(), fills, "the same camera needs no new light");
    let (both, _) = picture(&mut harness);
    // The left part is this look, the right one that without shadows; the line and labels lie between.
    let [width, height] = size.map(|n| n as usize);
    let differs = |from: f64, to: f64| {
        let columns = (width as f64 * from) as usize..(width as f64 * to) as usize;
        let rows = height / 8..height * 7 / 8;
        rows.flat_map(|row| columns.clone().map(move |column| (row * width + column) * 4))
            .filter(|&at| before[at..at + 3] != both[at..at + 3])
            .count()
    };
    assert_eq!(differs(0.02, 0.46), 0, "left of the line");
    assert!(differs(0.54, 0.98) > 100, "right of the line");
    // Dragging the line shows more of the left look, and does not turn the camera.
    let camera = harness.state().settings().camera.clone();
    drag(&mut harness, rect.center() + vec2(0.0, rect.height() / 4.0), vec2(0.44 * rect.width(), 0.0));
    assert_eq!(harness.state().settings().camera, camera);
    let (dragged, _) = picture(&mut harness);
    let columns = (width as f64 * 0.54) as usize..(width as f64 * 0.85) as usize;
    let same = (height / 8..height * 7 / 8).all(|row| {
        columns.clone().all(|column| {
            let at = (row * width + column) * 4;
            before[at..at + 3] == dragged[at..at + 3]
        })
    });
    assert!(same, "what the line has passed shows the left look");
    harness.key_press(egui::Key::C);
    wait_until_idle(&mut harness);
    assert!(picture(&mut harness).0 == before, "one look again");
}
