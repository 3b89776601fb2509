//! A window without a display: ways to make it, to wait for it, to press and drag in it, and to see its picture.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use chiaroscuro::app::{App, Options, wgpu_setup};
use chiaroscuro::data::Dataset;
use chiaroscuro::data::load::{LoadControl, LoadOptions};
use chiaroscuro::data::{ValueRanges, open};
use chiaroscuro::gpu::{Context, Picture, RenderOptions, Renderer};
use chiaroscuro::model::{Record, Settings};
use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// A minute: software adapters on shared cores are slow.
pub(crate) const PATIENCE: Duration = Duration::from_mins(1);

pub(crate) const SCENE: &str = "builtin:chair:32";

/// The window of the tests. It is taller than wide panels need, so that nothing is scrolled away.
pub(crate) fn window() -> Harness<'static, App> {
    let options = Options { source: Some(SCENE.into()), ..Options::default() };
    window_with(options, Vec2::new(760.0, 1140.0))
}

/// A window of some size, in points. Unless the options say something of the first look, its balance is not kept:
/// settings change when the test changes them, and only then.
pub(crate) fn window_with(options: Options, size: Vec2) -> Harness<'static, App> {
    paced_window_with(options, size, QUICK_FRAME_S)
}

/// A window of some size whose frames take 0.3 s, by its clock.
pub(crate) fn slow_window(size: Vec2) -> Harness<'static, App> {
    paced_window_with(Options { source: Some(SCENE.into()), ..Options::default() }, size, 0.3)
}

/// Seconds that a frame takes by the window's clock.
const QUICK_FRAME_S: f32 = 0.1;

fn paced_window_with(mut options: Options, size: Vec2, frame_s: f32) -> Harness<'static, App> {
    options.adjust.get_or_insert_with(|| {
        Box::new(|mut settings| {
            settings.shadows.keep_balanced = false;
            settings
        })
    });
    let mut harness = untouched_window_of(options, size, frame_s);
    wait_until_idle(&mut harness);
    harness
}

/// A window that does with the first look all that it does by itself; its picture is not there yet.
pub(crate) fn untouched_window(options: Options) -> Harness<'static, App> {
    untouched_window_of(options, Vec2::new(760.0, 1140.0), QUICK_FRAME_S)
}

fn untouched_window_of(options: Options, size: Vec2, frame_s: f32) -> Harness<'static, App> {
    let mut setup = wgpu_setup();
    // As the tests of the renderer: the first adapter that there is, software included.
    setup.power_preference = wgpu::PowerPreference::None;
    Harness::builder()
        .with_size(size)
        .with_step_dt(frame_s)
        .wgpu_setup(setup.into())
        .build_eframe(|cc| App::new(cc, options).expect("a window"))
}

/// A window without marks over the picture, whose bytes can be compared.
pub(crate) fn bare_window() -> Harness<'static, App> {
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

/// Gives the window in one frame what hands do while a slow one is drawn, and then as many frames as it needs for it.
pub(crate) fn in_one_frame(harness: &mut Harness<'_, App>, events: Vec<Event>) {
    harness.input_mut().events.extend(events);
    harness.run_steps(20);
}

/// Grabs what is at a place and throws it, as somebody does who is quicker than a frame.
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

/// What a keyboard sends for a text of letters, digits and stops.
pub(crate) fn keys_of(text: &str) -> Vec<Event> {
    let sign = |sign: char| {
        let name = match sign {
            '.' => "Period".to_owned(),
            '/' => "Slash".to_owned(),
            ':' => "Colon".to_owned(),
            _ => sign.to_uppercase().to_string(),
        };
        let key = egui::Key::from_name(&name).expect("a key");
        let [down, up] = stroke(key, Modifiers::NONE);
        [down, Event::Text(sign.to_string()), up]
    };
    text.chars().flat_map(sign).collect()
}

/// A key that is struck: down and up.
pub(crate) fn stroke(key: egui::Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers })
}

/// Turns the wheel by so many points, upwards if positive, where the pointer is.
pub(crate) fn turn_wheel(harness: &Harness<'_, App>, points: f32) {
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: Vec2::new(0.0, points),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
}

/// Presses and releases the pointer where it is, so many times.
pub(crate) fn press(harness: &mut Harness<'_, App>, at: Pos2, times: usize) {
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false].repeat(times) {
        let button = PointerButton::Primary;
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
        harness.step();
    }
}

/// Bytes and size of the picture in the window, without anything over it that goes by itself.
pub(crate) fn picture(harness: &mut Harness<'_, App>) -> (Vec<u8>, [u32; 2]) {
    // Handles fade out when the pointer is gone.
    harness.remove_cursor();
    harness.run_steps(12);
    // How many frames pass until the picture is there depends on the machine; a note lasts for some seconds of them.
    wait_until(harness, "a note stays", |app| app.is_idle() && !app.shows_note());
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
pub(crate) fn render(harness: &Harness<'_, App>, size: [u32; 2]) -> Picture {
    render_with(harness, size, &RenderOptions::default())
}

pub(crate) fn render_with(harness: &Harness<'_, App>, size: [u32; 2], options: &RenderOptions) -> Picture {
    let (dataset, mut renderer) = beside();
    let settings = harness.state().settings();
    renderer.render(&dataset, settings, size, options).expect("a picture")
}

/// The window's volume, and a renderer on a device of its own.
pub(crate) fn beside() -> (Dataset, Renderer) {
    let volume = open(SCENE, &LoadOptions::default(), &LoadControl::new()).expect("a built-in volume");
    let context = Context::headless().expect("an adapter");
    (Dataset::new(volume), Renderer::new(&context).expect("a renderer"))
}

pub(crate) fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// A file that the mouse has brought.
#[derive(Debug)]
pub(crate) struct Dropped(pub(crate) PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|err| err.to_string())
    }
}

/// The look that the latest run has kept in a folder.
pub(crate) fn kept_look(folder: &std::path::Path) -> Option<Settings> {
    let files = std::fs::read_dir(folder.join("runs")).ok()?.map(|file| file.expect("an entry").path());
    let latest = files.filter(|file| file.extension().is_some_and(|ending| ending == "json")).max()?;
    let record = Record::read(&std::fs::read_to_string(latest).expect("a text")).expect("a record");
    Some(record.apply(&Settings::default(), &ValueRanges::UNIT).expect("settings").0)
}
