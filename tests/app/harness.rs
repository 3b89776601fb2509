//! Headless test harness of the window: creating it, waiting, pointer and key events, and reading its picture.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, WindowOptions, wgpu_setup};
use chiaroscuro_render::{RenderOptions, RenderedPicture, Renderer, pooled_library};
use chiaroscuro_scene::{ImageSpec, LightSimplification, LookRecord, Settings, SkyMode};
use chiaroscuro_volume::{Dataset, LoadControl, ValueRanges};
use chiaroscuro_volume_io::{LoadOptions, open};
use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// Longest wait for a condition: a minute, because software adapters on shared cores are slow.
pub(crate) const WAIT_TIMEOUT: Duration = Duration::from_mins(1);

pub(crate) const SCENE: &str = "builtin:chair:32";

/// Creates the usual test window, taller than wide panels need, so that nothing is scrolled out of view.
pub(crate) fn window() -> Harness<'static, App> {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    adjusted_window(options, Vec2::new(760.0, 1140.0))
}

/// Creates the usual test window with the complete light of a first look.
pub(crate) fn first_look_window() -> Harness<'static, App> {
    let adjust = |mut settings: Settings| {
        settings.shadows.keep_balanced = false;
        settings
    };
    let options = WindowOptions {
        source: Some(SCENE.into()),
        adjust: Some(Box::new(adjust)),
        ..WindowOptions::default()
    };
    adjusted_window(options, Vec2::new(760.0, 1140.0))
}

/// Creates a window of some size, in points. Unless the options adjust the first look, the balance is not kept, so
/// that settings change only when the test changes them.
pub(crate) fn adjusted_window(options: WindowOptions, size: Vec2) -> Harness<'static, App> {
    paced_window_with(options, size, FRAME_S, PIXELS_PER_POINT)
}

/// Creates the usual test window with a pixel for each point, as snapshots have.
pub(crate) fn sharp_window() -> Harness<'static, App> {
    let options = WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() };
    sharp_window_with(options, Vec2::new(760.0, 1140.0))
}

/// Creates a window as [`adjusted_window`] does, with a pixel for each point.
pub(crate) fn sharp_window_with(options: WindowOptions, size: Vec2) -> Harness<'static, App> {
    paced_window_with(options, size, FRAME_S, 1.0)
}

/// Creates a window of some size whose frames take 0.3 s of simulated time.
pub(crate) fn slow_window(size: Vec2) -> Harness<'static, App> {
    paced_window_with(
        WindowOptions { source: Some(SCENE.into()), ..WindowOptions::default() },
        size,
        0.3,
        PIXELS_PER_POINT,
    )
}

/// Duration of a frame in simulated time, in seconds.
const FRAME_S: f32 = 0.1;

/// Pixels per point of test windows: few tests are about pixels, and a quarter of them is drawn in a quarter of the
/// time.
const PIXELS_PER_POINT: f32 = 0.5;

fn paced_window_with(
    mut options: WindowOptions,
    size: Vec2,
    frame_s: f32,
    pixels_per_point: f32,
) -> Harness<'static, App> {
    options.adjust.get_or_insert_with(|| {
        Box::new(|settings| {
            // Soft light takes several times as long, and few tests are about it.
            let mut settings = LightSimplification::ALL.apply(&settings);
            settings.sky.mode = SkyMode::Off;
            settings.shadows.keep_balanced = false;
            settings
        })
    });
    let mut harness = automatic_window_with(options, size, frame_s, pixels_per_point);
    wait_until_idle(&mut harness);
    harness
}

/// Creates a window with the automatic steps of a first look enabled, before its picture is finished.
pub(crate) fn automatic_window(options: WindowOptions) -> Harness<'static, App> {
    automatic_window_with(options, Vec2::new(760.0, 1140.0), FRAME_S, PIXELS_PER_POINT)
}

fn automatic_window_with(
    mut options: WindowOptions,
    size: Vec2,
    frame_s: f32,
    pixels_per_point: f32,
) -> Harness<'static, App> {
    // Simulated time runs ahead of the search.
    options.light_search_limit_s.get_or_insert(f64::INFINITY);
    options.pipelines = Some(pooled_library().expect("an adapter"));
    let mut setup = wgpu_setup();
    // Uses the first adapter like the tests of the renderer, software included.
    setup.power_preference = wgpu::PowerPreference::None;
    Harness::builder()
        .with_size(size)
        .with_step_dt(frame_s)
        .with_pixels_per_point(pixels_per_point)
        .wgpu_setup(setup.into())
        .build_eframe(|cc| App::new(cc, options).expect("a window"))
}

/// Creates a window without overlays on the picture, whose bytes can be compared.
pub(crate) fn window_without_overlays() -> Harness<'static, App> {
    let mut harness = window();
    harness.key_press(egui::Key::G);
    harness.run_steps(3);
    harness
}

/// Runs frames until a condition holds; fails after [`WAIT_TIMEOUT`].
pub(crate) fn wait_until(harness: &mut Harness<'_, App>, what: &str, condition: impl Fn(&App) -> bool) {
    let start = Instant::now();
    loop {
        harness.step();
        if condition(harness.state()) {
            return;
        }
        assert!(start.elapsed() < WAIT_TIMEOUT, "{what}: errors {:?}", harness.state().errors());
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Keeps files from being read until the guard is dropped. One test at a time does so: injected faults belong to the
/// process, in which tests run beside each other.
pub(crate) fn block_file_tasks() -> impl Sized {
    static TURN: Mutex<()> = Mutex::new(());
    let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    // Fields are dropped in their order: files are read again before the next test has its turn.
    (App::block_file_tasks(), turn)
}

pub(crate) fn wait_until_idle(harness: &mut Harness<'_, App>) {
    wait_until(harness, "never idle", App::is_idle);
}

/// Drags with the primary button: presses, moves in steps and releases, running a frame after each.
pub(crate) fn drag(harness: &mut Harness<'_, App>, from: Pos2, by: Vec2) {
    drag_with(harness, PointerButton::Primary, from, by);
}

pub(crate) fn drag_with(harness: &mut Harness<'_, App>, button: PointerButton, from: Pos2, by: Vec2) {
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

/// Sends events to the window in one frame, as if they arrived during a slow frame, and runs frames until they are
/// handled.
pub(crate) fn send_in_one_frame(harness: &mut Harness<'_, App>, events: Vec<Event>) {
    harness.input_mut().events.extend(events);
    harness.run_steps(20);
}

/// Events of a press, move and release within one frame, faster than the window draws.
pub(crate) fn flick(from: Pos2, by: Vec2) -> Vec<Event> {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let mut events = vec![Event::PointerMoved(from), button(from, true)];
    events.extend((1..=4).map(|step| Event::PointerMoved(from + by * (step as f32 / 4.0))));
    events.push(button(from + by, false));
    events
}

/// Keyboard events for a text of letters, digits and punctuation.
pub(crate) fn key_events(text: &str) -> Vec<Event> {
    let sign = |sign: char| {
        let name = match sign {
            '.' => "Period".to_owned(),
            '/' => "Slash".to_owned(),
            ':' => "Colon".to_owned(),
            _ => sign.to_uppercase().to_string(),
        };
        let key = egui::Key::from_name(&name).expect("a key");
        let [down, up] = key_stroke(key, Modifiers::NONE);
        [down, Event::Text(sign.to_string()), up]
    };
    text.chars().flat_map(sign).collect()
}

/// Events of a key stroke: press and release.
pub(crate) fn key_stroke(key: egui::Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers })
}

/// Turns the wheel by a distance in points, upwards if positive, at the pointer.
pub(crate) fn turn_wheel(harness: &Harness<'_, App>, points: f32) {
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: Vec2::new(0.0, points),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
}

/// Presses and releases the primary button at a position, a number of times.
pub(crate) fn click_at(harness: &mut Harness<'_, App>, at: Pos2, times: usize) {
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false].repeat(times) {
        let button = PointerButton::Primary;
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
        harness.step();
    }
}

/// Bytes and size of the picture in the window, without overlays that disappear automatically.
pub(crate) fn picture(harness: &mut Harness<'_, App>) -> (Vec<u8>, [u32; 2]) {
    // Handles fade out when the pointer has left.
    harness.remove_cursor();
    harness.run_steps(12);
    // The number of frames until the picture is finished depends on the machine; a note lasts for some seconds.
    wait_until(harness, "a note stays", |app| app.is_idle() && !app.shows_note());
    picture_with_pointer(harness)
}

/// Bytes and size of the picture in the window as it is, with the pointer where it is.
pub(crate) fn picture_with_pointer(harness: &mut Harness<'_, App>) -> (Vec<u8>, [u32; 2]) {
    let (rect, size) = harness.state().viewport_rect().expect("a picture");
    let image = harness.render().expect("a picture of the window");
    let [x, y] = [rect.min.x, rect.min.y].map(|at| (at * harness.ctx.pixels_per_point()).round() as u32);
    let mut bytes = Vec::new();
    for row in 0..size[1] {
        for column in 0..size[0] {
            bytes.extend(image.get_pixel(x + column, y + row).0);
        }
    }
    (bytes, size)
}

/// Renders the window's settings with a renderer on another device, as in an export.
pub(crate) fn render(harness: &Harness<'_, App>, size: [u32; 2]) -> RenderedPicture {
    render_with(harness, size, &RenderOptions::for_image(&ImageSpec::new(size), harness.state().settings()))
}

pub(crate) fn render_with(
    harness: &Harness<'_, App>,
    size: [u32; 2],
    options: &RenderOptions,
) -> RenderedPicture {
    let (dataset, mut renderer) = second_renderer();
    let settings = harness.state().settings();
    renderer.render(&dataset, settings, size, options).expect("a picture")
}

/// Volume of the window, and another renderer.
pub(crate) fn second_renderer() -> (Dataset, Renderer) {
    let volume = open(SCENE, &LoadOptions::default(), &LoadControl::new()).expect("a built-in volume");
    let shaders = pooled_library().expect("an adapter");
    (Dataset::new(volume), Renderer::with_shaders(&shaders.context().clone(), shaders).expect("a renderer"))
}

pub(crate) fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// File dropped on the window.
#[derive(Debug)]
pub(crate) struct DroppedFile(pub(crate) PathBuf);

impl egui::DroppedFile for DroppedFile {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|err| err.to_string())
    }
}

/// Look that the latest run has autosaved in a folder.
pub(crate) fn autosaved_look(folder: &std::path::Path) -> Option<Settings> {
    let files = std::fs::read_dir(folder.join("runs")).ok()?.map(|file| file.expect("an entry").path());
    let latest = files.filter(|file| file.extension().is_some_and(|ending| ending == "json")).max()?;
    let record = LookRecord::parse(&std::fs::read_to_string(latest).expect("a text")).expect("a record");
    Some(record.apply(&Settings::default(), &ValueRanges::UNIT).expect("settings").settings)
}
