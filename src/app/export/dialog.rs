//! The export window: what is made, how large and how fine, and into which file.

use std::path::Path;
use std::sync::atomic::Ordering;

use eframe::egui::{self, Ui};

use super::{Export, Kind, Request};
use crate::export::{AnimationFormat, PictureFormat};
use crate::model::{Depth, MAX_EDGE, MAX_SAMPLES};

const KINDS: [(Kind, &str, &str); 3] = [
    (Kind::Still, "Picture", "What the window shows, at any size"),
    (Kind::Turntable, "Turntable", "The camera goes once around the volume; the light stays"),
    (Kind::LightTurn, "Turning light", "The selected light goes once around the vertical axis"),
];

/// Files for a picture: depth, name, ending, tip.
const STILLS: [(Depth, &str, &str, &str); 3] = [
    (Depth::Eight, "PNG", "png", "For papers, slides and the web"),
    (
        Depth::Sixteen,
        "PNG, 16 bit",
        "png",
        "For prints and for changing colours afterwards: smooth shading stays smooth",
    ),
    (Depth::Linear, "EXR", "exr", "Light before the tone map, linear, for programs that grade and composite"),
];

/// Files for a turn: kind, name, ending, tip.
const TURNS: [(AnimationFormat, &str, &str, &str); 4] = [
    (AnimationFormat::Apng, "PNG that moves", "png", "Every colour, and transparency; browsers show it"),
    (AnimationFormat::Gif, "GIF", "gif", "256 colours; everything shows it"),
    (AnimationFormat::Mp4, "MP4", "mp4", "A video for slides; needs ffmpeg on this computer"),
    (AnimationFormat::Folder, "One file per picture", "", "A folder of PNG files, for video programs"),
];

/// All endings of files that are written.
const ENDINGS: [&str; 5] = ["png", "apng", "exr", "gif", "mp4"];

impl Export {
    /// Shows the window if it is open.
    pub(in crate::app) fn ui(&mut self, ctx: &egui::Context, viewport: [u32; 2]) -> Option<Request> {
        let mut request = None;
        let mut open = self.open;
        let window = egui::Window::new("Export picture").open(&mut open).collapsible(false).resizable(false);
        window.default_pos([160.0, 90.0]).show(ctx, |ui| {
            ui.horizontal(|ui| {
                for (kind, name, tip) in KINDS {
                    if ui.selectable_label(self.kind == kind, name).on_hover_text(tip).clicked() {
                        self.set_kind(kind);
                    }
                }
            });
            self.size_ui(ui, viewport);
            if self.kind == Kind::Still {
                self.still_ui(ui);
            } else {
                self.turn_ui(ui);
            }
            let fits = self.kind == Kind::Still || self.animation() != AnimationFormat::Mp4;
            let mut left_out = self.shot.transparent && fits;
            let tip = "Leaves the background out, for placing the picture on something else";
            let switch = egui::Checkbox::new(&mut left_out, "Transparent background");
            let response = ui.add_enabled(fits, switch).on_hover_text(tip);
            if response.on_disabled_hover_text("MP4 has no transparency").changed() {
                self.shot.transparent = left_out;
            }
            ui.horizontal(|ui| {
                let label = ui.label("File");
                let field = egui::TextEdit::singleline(&mut self.path).desired_width(280.0);
                if ui.add(field).labelled_by(label.id).changed() {
                    self.follow_name();
                }
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

    /// What a turn is written as.
    pub(super) fn animation(&self) -> AnimationFormat {
        AnimationFormat::of_path(Path::new(self.path.trim()))
    }

    /// Turns and pictures are not written as the same kinds of files.
    fn set_kind(&mut self, kind: Kind) {
        if (self.kind == Kind::Still) != (kind == Kind::Still) {
            self.set_ending("png");
        }
        self.kind = kind;
        self.follow_name();
    }

    /// What the name says of the depth holds.
    pub(super) fn follow_name(&mut self) {
        self.shot.depth = PictureFormat::of_path(Path::new(self.path.trim())).depth(self.shot.depth);
    }

    /// Gives the name an ending, instead of one of ours if it has one: what follows another dot is a part of it.
    fn set_ending(&mut self, ending: &str) {
        let path = Path::new(self.path.trim());
        let known =
            path.extension().is_some_and(|found| ENDINGS.iter().any(|own| found.eq_ignore_ascii_case(own)));
        let stem = if known { path.with_extension("") } else { path.to_owned() };
        self.path = stem.display().to_string();
        if !ending.is_empty() {
            self.path = format!("{}.{ending}", self.path);
        }
    }

    /// How fine a picture is, and what its file holds.
    fn still_ui(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label("Samples per pixel");
            for samples in 1..=MAX_SAMPLES {
                let tip = "More samples smooth edges and thin structures, and take as many times longer";
                let name = (samples * samples).to_string();
                let response = ui.selectable_label(self.shot.samples == samples, &name).on_hover_text(tip);
                response.widget_info(|| {
                    let label = format!("{name} samples per pixel");
                    egui::WidgetInfo::selected(egui::Role::Button, true, samples == self.shot.samples, label)
                });
                if response.clicked() {
                    self.shot.samples = samples;
                }
            }
        });
        ui.horizontal(|ui| {
            for (depth, name, ending, tip) in STILLS {
                if ui.selectable_label(self.shot.depth == depth, name).on_hover_text(tip).clicked() {
                    self.shot.depth = depth;
                    self.set_ending(ending);
                }
            }
        });
    }

    /// How many pictures a turn has, how fast they go by, and what its file is.
    fn turn_ui(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let field = egui::DragValue::new(&mut self.frames).range(2..=3600).suffix(" pictures");
            ui.name_inputs("Pictures of a turn", |ui| ui.add(field));
            let field = egui::DragValue::new(&mut self.rate).range(1..=120).suffix(" per second");
            ui.name_inputs("Pictures per second", |ui| ui.add(field));
            ui.weak(format!("{:.1} s", f64::from(self.frames) / f64::from(self.rate.max(1))));
        });
        ui.horizontal(|ui| {
            for (format, name, ending, tip) in TURNS {
                let is_it = self.animation() == format;
                if ui.selectable_label(is_it, name).on_hover_text(tip).clicked() && !is_it {
                    self.set_ending(ending);
                }
            }
        });
    }

    fn progress_ui(&self, ui: &mut Ui) {
        let (done, total) =
            (self.progress.done.load(Ordering::Relaxed), self.progress.total.load(Ordering::Relaxed));
        if total > 1 {
            let bar = egui::ProgressBar::new(done as f32 / total as f32).desired_width(120.0);
            let parts = if self.kind == Kind::Still { "parts" } else { "pictures" };
            ui.add(bar.text(format!("{done} of {total} {parts}")));
        } else {
            ui.spinner();
            ui.label("rendering at full quality");
        }
        if ui.button("Cancel").clicked() {
            self.progress.cancelled.store(true, Ordering::Relaxed);
        }
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
    }

    fn size_ui(&mut self, ui: &mut Ui, viewport: [u32; 2]) {
        ui.horizontal(|ui| {
            ui.label("Size");
            for (edge, name) in self.shot.size.iter_mut().zip(["Width", "Height"]) {
                let field = egui::DragValue::new(edge).range(1..=MAX_EDGE).suffix(" px");
                ui.name_inputs(name, |ui| ui.add(field));
            }
            let [width, height] = self.shot.size.map(f64::from);
            // At the 300 dots per inch that journals ask for.
            ui.weak(format!("{:.0} × {:.0} mm at 300 dpi", width / 300.0 * 25.4, height / 300.0 * 25.4));
        });
        ui.horizontal(|ui| {
            let presets = [
                ("Window", viewport),
                ("2 × window", viewport.map(|n| n.saturating_mul(2))),
                ("1920 × 1080", [1920, 1080]),
                ("3840 × 2160", [3840, 2160]),
                ("7680 × 4320", [7680, 4320]),
            ];
            for (name, size) in presets {
                if ui.selectable_label(self.shot.size == size, name).clicked() {
                    self.set_size(size);
                }
            }
        });
    }
}
