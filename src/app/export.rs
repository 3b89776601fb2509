//! The export window and its worker: always full quality, whatever the preview shows.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use super::work::Work;
use crate::data::{Bricks, Volume};
use crate::gpu::{Context, RenderOptions, Renderer, export_png};
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
    work: Option<Work<Result<PathBuf, String>>>,
}

impl Default for Export {
    fn default() -> Self {
        Self { open: false, size: [0, 0], transparent: false, path: "chiaroscuro.png".to_owned(), work: None }
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
    pub(super) fn take(&mut self) -> Option<Result<PathBuf, String>> {
        let result = self.work.as_ref()?.take()?;
        self.work = None;
        Some(result.and_then(|result| result))
    }

    /// Starts to render and write.
    pub(super) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        let (size, transparent, path) = (self.size, self.transparent, PathBuf::from(self.path.trim()));
        let task = move || {
            let options = RenderOptions { transparent, ..RenderOptions::default() };
            // Beside the window's device, so that the window stays alive.
            let beside = subject.context.sibling().map_err(|err| err.to_string())?;
            let mut renderer = Renderer::new(&beside).map_err(|err| err.to_string())?;
            let picture = renderer
                .render(&subject.volume, &subject.bricks, &subject.settings, size, &options)
                .map_err(|err| err.to_string())?;
            let volume = VolumeRecord::new(&subject.source, subject.volume.content_id(), path.parent());
            let how = PictureRecord {
                size,
                transparent,
                version: env!("CARGO_PKG_VERSION").to_owned(),
                adapter: beside.description(),
            };
            let record = Record::text(&subject.settings, Some(&volume), Some(&how));
            export_png(&picture, transparent, Some(&record), &path).map_err(|err| err.to_string())?;
            Ok(path)
        };
        self.work =
            Some(Work::start("export", ctx, task).map_err(|err| format!("no thread for the export: {err}"))?);
        Ok(())
    }

    /// Shows the window if it is open.
    pub(super) fn ui(&mut self, ctx: &egui::Context, viewport: [u32; 2]) -> Option<Request> {
        let mut request = None;
        let mut open = self.open;
        let window = egui::Window::new("Export picture").open(&mut open).collapsible(false).resizable(false);
        window.default_pos([160.0, 90.0]).show(ctx, |ui| {
            self.size_ui(ui, viewport);
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
                    ui.spinner();
                    ui.label("rendering at full quality");
                }
            });
        });
        self.open = open;
        request
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
