//! The export window and its worker: always full quality, whatever the preview shows.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use eframe::egui;

use super::work::Work;
use crate::data::{Bricks, Volume};
use crate::gpu::{Animation, Context, ExportError, RenderOptions, Renderer, export_png};
use crate::model::{PictureRecord, Record, Settings, VolumeRecord};

/// Longest edge of an exported picture, in pixels.
const MAX_EDGE: u32 = 16384;

/// What is to be exported, for the worker.
#[derive(Debug)]
pub(super) struct Subject {
    /// The window's device.
    pub context: Context,
    /// The open volume.
    pub volume: Arc<Volume>,
    /// Its bricks.
    pub bricks: Arc<Bricks>,
    /// The whole look.
    pub settings: Settings,
    /// What was opened.
    pub source: String,
    /// The light that turns, if one is to.
    pub selected_light: usize,
}

/// A renderer beside the window's device, so that the window stays alive.
pub(super) struct Worker {
    renderer: Renderer,
    adapter: String,
}

impl Worker {
    /// A renderer for a subject.
    pub(super) fn new(subject: &Subject) -> Result<Self, String> {
        let beside = subject.context.sibling().map_err(|err| err.to_string())?;
        let renderer = Renderer::new(&beside).map_err(|err| err.to_string())?;
        Ok(Self { renderer, adapter: beside.description() })
    }

    /// A picture of the subject with settings of one's own, as it is shown.
    pub(super) fn render(
        &mut self,
        subject: &Subject,
        settings: &Settings,
        size: [u32; 2],
        transparent: bool,
    ) -> Result<Vec<u8>, String> {
        let options = RenderOptions { transparent, ..RenderOptions::default() };
        let shown = self.renderer.render_shown(&subject.volume, &subject.bricks, settings, size, &options);
        shown.map_err(|err| err.to_string())
    }
}

/// Renders and writes one picture.
fn still(subject: &Subject, size: [u32; 2], transparent: bool, path: PathBuf) -> Result<Exported, String> {
    let mut worker = Worker::new(subject)?;
    let shown = worker.render(subject, &subject.settings, size, transparent)?;
    let volume = VolumeRecord::new(&subject.source, subject.volume.content_id(), path.parent());
    let how = PictureRecord::new(size, transparent, worker.adapter);
    let record = Record::text(&subject.settings, Some(&volume), Some(&how));
    export_png(size, &shown, transparent, Some(&record), &path).map_err(|err| err.to_string())?;
    Ok(Exported::File(path))
}

/// What an export ended with.
#[derive(Debug)]
pub(super) enum Exported {
    /// A file was written.
    File(PathBuf),
    /// A picture for the clipboard.
    Picture(egui::ColorImage),
    /// The user did not want it any more.
    Cancelled,
}

/// What is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// One picture.
    Still,
    /// A turn of the camera …
    Turntable,
    /// … or of the selected light.
    LightTurn,
}

/// What the window and its worker tell each other.
#[derive(Debug, Default)]
struct Progress {
    done: AtomicU32,
    cancelled: AtomicBool,
}

/// What the user asks of the export window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Request {
    /// Choose a file with a dialog.
    Choose,
    /// Render and write.
    Export,
}

/// The export window.
#[derive(Debug)]
pub(super) struct Export {
    open: bool,
    size: [u32; 2],
    transparent: bool,
    path: String,
    kind: Kind,
    frames: u32,
    rate: u16,
    progress: Arc<Progress>,
    work: Option<Work<Result<Exported, String>>>,
}

const KINDS: [(Kind, &str, &str); 3] = [
    (Kind::Still, "Picture", "What the window shows, at any size"),
    (Kind::Turntable, "Turntable", "The camera goes once around the volume; the light stays"),
    (Kind::LightTurn, "Turning light", "The selected light goes once around the vertical axis"),
];

impl Default for Export {
    fn default() -> Self {
        Self {
            open: false,
            size: [0, 0],
            transparent: false,
            path: "chiaroscuro.png".to_owned(),
            kind: Kind::Still,
            frames: 72,
            rate: 24,
            progress: Arc::default(),
            work: None,
        }
    }
}

impl Export {
    /// Shows the window, at first with the size of the viewport.
    pub(super) fn open(&mut self, viewport: [u32; 2]) {
        self.open = true;
        if self.size == [0, 0] {
            self.size = viewport;
        }
    }

    /// Where to write.
    pub(super) fn set_path(&mut self, path: &Path) {
        self.path = path.display().to_string();
        self.open = true;
    }

    /// How large.
    pub(super) fn set_size(&mut self, size: [u32; 2]) {
        self.size = size.map(|n| n.clamp(1, MAX_EDGE));
    }

    /// Whether a picture is being made.
    pub(super) fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// How the last export ended, once.
    pub(super) fn take(&mut self) -> Option<Result<Exported, String>> {
        let result = self.work.as_ref()?.take()?;
        self.work = None;
        Some(result.and_then(|result| result))
    }

    /// Starts to render and write.
    pub(super) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        let (size, transparent, path) = (self.size, self.transparent, PathBuf::from(self.path.trim()));
        let (frames, rate) = (self.frames, self.rate);
        self.progress = Arc::default();
        let progress = Arc::clone(&self.progress);
        let light = match self.kind {
            Kind::Still => return self.run(ctx, move || still(&subject, size, transparent, path)),
            Kind::Turntable => None,
            Kind::LightTurn => Some(subject.selected_light),
        };
        self.run(ctx, move || {
            let said = |err: ExportError| err.to_string();
            let mut worker = Worker::new(&subject)?;
            let mut file = Animation::create(&path, size, frames, transparent, rate).map_err(said)?;
            for frame in 0..frames {
                if progress.cancelled.load(Ordering::Relaxed) {
                    return Ok(Exported::Cancelled);
                }
                let settings = subject.settings.turned(light, f64::from(frame) / f64::from(frames));
                file.add(&worker.render(&subject, &settings, size, transparent)?).map_err(said)?;
                progress.done.store(frame + 1, Ordering::Relaxed);
            }
            file.finish().map_err(said)?;
            Ok(Exported::File(path))
        })
    }

    /// Starts to render for the clipboard, as large as the window's picture.
    pub(super) fn copy(
        &mut self,
        subject: Subject,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), String> {
        let transparent = self.transparent;
        self.run(ctx, move || {
            let shown = Worker::new(&subject)?.render(&subject, &subject.settings, size, transparent)?;
            let size = size.map(|n| n as usize);
            Ok(Exported::Picture(egui::ColorImage::from_rgba_unmultiplied(size, &shown)))
        })
    }

    fn run(
        &mut self,
        ctx: &egui::Context,
        task: impl FnOnce() -> Result<Exported, String> + Send + 'static,
    ) -> Result<(), String> {
        let work = Work::start("export", ctx, task);
        self.work = Some(work.map_err(|err| format!("no thread for the export: {err}"))?);
        Ok(())
    }

    /// Shows the window if it is open.
    pub(super) fn ui(&mut self, ctx: &egui::Context, viewport: [u32; 2]) -> Option<Request> {
        let mut request = None;
        let mut open = self.open;
        let window = egui::Window::new("Export picture").open(&mut open).collapsible(false).resizable(false);
        window.default_pos([160.0, 90.0]).show(ctx, |ui| {
            ui.horizontal(|ui| {
                for (kind, name, tip) in KINDS {
                    ui.selectable_value(&mut self.kind, kind, name).on_hover_text(tip);
                }
            });
            self.size_ui(ui, viewport);
            if self.kind != Kind::Still {
                self.turn_ui(ui);
            }
            ui.checkbox(&mut self.transparent, "Transparent background")
                .on_hover_text("Leaves the background out, for placing the picture on something else");
            ui.horizontal(|ui| {
                let label = ui.label("File");
                ui.add(egui::TextEdit::singleline(&mut self.path).desired_width(280.0)).labelled_by(label.id);
                if ui.button("Choose…").clicked() {
                    request = Some(Request::Choose);
                }
            });
            ui.horizontal(|ui| {
                let ready = !self.is_busy() && !self.path.trim().is_empty();
                if ui.add_enabled(ready, egui::Button::new("Export")).clicked() {
                    request = Some(Request::Export);
                }
                if self.is_busy() {
                    self.progress_ui(ui);
                }
            });
        });
        self.open = open;
        request
    }

    /// How many pictures a turn has, and how fast they go by.
    fn turn_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let field = egui::DragValue::new(&mut self.frames).range(2..=3600).suffix(" pictures");
            ui.name_inputs("Pictures of a turn", |ui| ui.add(field));
            let field = egui::DragValue::new(&mut self.rate).range(1..=120).suffix(" per second");
            ui.name_inputs("Pictures per second", |ui| ui.add(field));
            ui.weak("a PNG file that moves");
        });
    }

    fn progress_ui(&self, ui: &mut egui::Ui) {
        if self.kind == Kind::Still {
            ui.spinner();
            ui.label("rendering at full quality");
            return;
        }
        let done = self.progress.done.load(Ordering::Relaxed);
        let bar = egui::ProgressBar::new(done as f32 / self.frames.max(1) as f32).desired_width(120.0);
        ui.add(bar.text(format!("{done} of {}", self.frames)));
        if ui.button("Cancel").clicked() {
            self.progress.cancelled.store(true, Ordering::Relaxed);
        }
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
    }

    fn size_ui(&mut self, ui: &mut egui::Ui, viewport: [u32; 2]) {
        ui.horizontal(|ui| {
            ui.label("Size");
            for (edge, name) in self.size.iter_mut().zip(["Width", "Height"]) {
                let field = egui::DragValue::new(edge).range(1..=MAX_EDGE).suffix(" px");
                ui.name_inputs(name, |ui| ui.add(field));
            }
        });
        ui.horizontal(|ui| {
            let presets = [
                ("Window", viewport),
                ("2 × window", viewport.map(|n| n.saturating_mul(2))),
                ("1920 × 1080", [1920, 1080]),
                ("3840 × 2160", [3840, 2160]),
            ];
            for (name, size) in presets {
                if ui.selectable_label(self.size == size, name).clicked() {
                    self.set_size(size);
                }
            }
        });
    }
}
