//! Export window: kind of export, size, samples, format, marks and file.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Ui};

use super::{ExportKind, ExportWindow, destination};
use crate::app::common::dock::ToolWindow;
use crate::app::common::shortcuts;
use crate::app::text::{self, ControlText};
use crate::app::windows::file_dialogs::FileDialogPurpose;
use crate::app::windows::{SceneTool, ToolRequest, ToolScene};
use crate::app::worker::jobs::JobProgress;
use chiaroscuro_media::{AnimationFormat, PictureFormat, frame_names};
use chiaroscuro_scene::{Annotations, MAX_IMAGE_EDGE, MAX_SAMPLES_PER_EDGE, PixelFormat};

const EXPORT_KINDS: [(ExportKind, ControlText); 4] = [
    (ExportKind::Still, text::export::STILL),
    (ExportKind::Turntable, text::export::TURNTABLE),
    (ExportKind::LightTurntable, text::export::LIGHT_TURN),
    (ExportKind::TimeSeries, text::export::TIME_SERIES),
];

/// File formats of a picture, with their extensions.
const STILL_FORMATS: [(PixelFormat, ControlText, &str); 3] = [
    (PixelFormat::Eight, text::export::PNG, "png"),
    (PixelFormat::Sixteen, text::export::PNG_16, "png"),
    (PixelFormat::Linear, text::export::EXR, "exr"),
];

/// File formats of an animation, with their extensions.
const ANIMATION_FORMATS: [(AnimationFormat, ControlText, &str); 4] = [
    (AnimationFormat::Apng, text::export::APNG, "png"),
    (AnimationFormat::Gif, text::export::GIF, "gif"),
    (AnimationFormat::Mp4, text::export::MP4, "mp4"),
    (AnimationFormat::Folder, text::export::FOLDER, ""),
];

/// Extensions of all files that can be written.
const EXTENSIONS: [&str; 5] = ["png", "apng", "exr", "gif", "mp4"];

impl SceneTool for ExportWindow {
    fn show(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Option<ToolRequest> {
        let is_anatomical = scene.volume.is_some_and(|volume| volume.is_anatomical);
        self.step_count = scene.step_count;
        if self.step_count == 0 && self.kind == ExportKind::TimeSeries {
            self.set_kind(ExportKind::Still);
        }
        let mut request = None;
        let mut open = self.open;
        let tool =
            ToolWindow { title: text::export::TITLE, default_pos: [160.0, 90.0], default_width: 440.0 };
        if open && tool.is_floating_dialog(ctx) {
            shortcuts::reserve_letters(ctx);
        }
        tool.show_dialog(ctx, &mut open, |ui| {
            ui.horizontal(|ui| {
                for (kind, ControlText { name, tooltip: tip }) in EXPORT_KINDS {
                    if kind == ExportKind::TimeSeries && self.step_count == 0 {
                        continue;
                    }
                    if ui.selectable_label(self.kind == kind, name).on_hover_text(tip).clicked() {
                        self.set_kind(kind);
                    }
                }
            });
            self.size_ui(ui, scene.picture_size);
            if self.kind == ExportKind::Still {
                self.still_ui(ui);
            } else {
                self.turntable_ui(ui);
            }
            let fits = self.kind == ExportKind::Still || self.animation_format() != AnimationFormat::Mp4;
            let mut left_out = self.image_spec.transparent && fits;
            let switch = egui::Checkbox::new(&mut left_out, text::export::TRANSPARENT.name);
            let response = ui.add_enabled(fits, switch).on_hover_text(text::export::TRANSPARENT.tooltip);
            if response.on_disabled_hover_text(text::export::NOT_TRANSPARENT_TIP).changed() {
                self.image_spec.transparent = left_out;
            }
            self.marks_ui(ui, is_anatomical);
            ui.horizontal(|ui| {
                let label = ui.label(text::export::FILE);
                let field = egui::TextEdit::singleline(&mut self.path).desired_width(320.0);
                if ui.add(field).labelled_by(label.id).changed() {
                    self.has_user_name = true;
                    self.adapt_depth_to_name();
                }
                if ui.button(text::export::CHOOSE).clicked() {
                    request = Some(ToolRequest::AskFile(FileDialogPurpose::ExportPicture));
                }
            });
            self.destination_ui(ui);
            ui.horizontal(|ui| {
                let ready = !self.is_busy() && !self.path.trim().is_empty();
                if ui
                    .add_enabled(ready && !self.asks_to_replace, egui::Button::new(text::export::EXPORT))
                    .clicked()
                {
                    self.asks_to_replace = self.would_replace();
                    request = (!self.asks_to_replace).then_some(ToolRequest::Export);
                }
                if self.is_busy() {
                    self.progress_ui(ui);
                }
            });
            if self.asks_to_replace && self.replace_question_ui(ui) {
                request = Some(ToolRequest::Export);
            }
            if let Some(asked) = self.last_file_ui(ui) {
                request = Some(asked);
            }
        });
        self.open = open;
        request
    }
}

impl ExportWindow {
    /// Row of switches for the marks drawn over the picture.
    fn marks_ui(&mut self, ui: &mut Ui, is_anatomical: bool) {
        ui.horizontal_wrapped(|ui| {
            ui.label(text::export::ANNOTATIONS);
            let Annotations { scale_bar, letters, legend } = &mut self.image_spec.marks;
            ui.checkbox(scale_bar, text::export::SCALE_BAR.name)
                .on_hover_text(text::export::SCALE_BAR.tooltip);
            let mut are_drawn = *letters && is_anatomical;
            let switch = egui::Checkbox::new(&mut are_drawn, text::export::LETTERS.name);
            let response = ui.add_enabled(is_anatomical, switch).on_hover_text(text::export::LETTERS.tooltip);
            if response.on_disabled_hover_text(text::export::NO_LETTERS_TIP).changed() {
                *letters = are_drawn;
            }
            ui.checkbox(legend, text::export::LEGEND.name).on_hover_text(text::export::LEGEND.tooltip);
        });
    }

    /// Shows the absolute path of the file, if the typed one is relative.
    fn destination_ui(&self, ui: &mut Ui) {
        let absolute = destination::absolute_path(&self.path);
        if absolute != Path::new(self.path.trim()) {
            let words = text::export::target_path(&absolute);
            ui.add(egui::Label::new(egui::RichText::new(&words).weak()).truncate()).on_hover_text(words);
        }
    }

    /// Shows the file that was written last, with buttons to open its folder and copy its path.
    fn last_file_ui(&self, ui: &mut Ui) -> Option<ToolRequest> {
        let last = self.last_file.as_ref().filter(|_| !self.is_busy())?;
        let mut request = None;
        ui.separator();
        ui.horizontal(|ui| {
            if ui.button(text::export::SHOW_IN_FOLDER).clicked()
                && let Err(err) = destination::show_in_folder(last)
            {
                request = Some(ToolRequest::Report(text::export::NO_FOLDER, err.to_string()));
            }
            if ui.button(text::export::COPY_PATH).clicked() {
                ui.ctx().copy_text(destination::absolute_path(&last.to_string_lossy()).display().to_string());
            }
            let words = text::messages::exported(last);
            ui.add(egui::Label::new(egui::RichText::new(&words).weak()).truncate()).on_hover_text(words);
        });
        request
    }

    /// Returns true if the file exists and the user has not agreed to replace it.
    fn would_replace(&self) -> bool {
        self.target_exists() && self.replaceable.as_deref() != Some(Path::new(self.path.trim()))
    }

    /// Returns true if the export would overwrite a file: the target, or a picture in the target folder.
    fn target_exists(&self) -> bool {
        let path = Path::new(self.path.trim());
        let is_folder = self.kind != ExportKind::Still && self.animation_format() == AnimationFormat::Folder;
        path.is_file() || is_folder && frame_names(path, self.frame_count()).iter().any(|name| name.exists())
    }

    /// Asks whether the file may be replaced; returns true if the user agrees.
    fn replace_question_ui(&mut self, ui: &mut Ui) -> bool {
        let path = PathBuf::from(self.path.trim());
        // The name may have been edited meanwhile.
        self.asks_to_replace = self.target_exists();
        let mut agreed = false;
        ui.horizontal(|ui| {
            ui.label(text::files::overwrite_question(&path));
            agreed = ui.button(text::files::REPLACE).clicked();
            self.asks_to_replace &= !agreed && !ui.button(text::common::CANCEL).clicked();
        });
        agreed
    }

    /// Format of an animation, by the extension of its path.
    pub(crate) fn animation_format(&self) -> AnimationFormat {
        AnimationFormat::from_path(Path::new(self.path.trim()))
    }

    /// Sets the kind of export; changes the extension if its file formats differ.
    fn set_kind(&mut self, kind: ExportKind) {
        if (self.kind == ExportKind::Still) != (kind == ExportKind::Still) {
            self.set_extension("png");
        }
        self.kind = kind;
        self.adapt_depth_to_name();
    }

    /// Sets the bit depth to one that the file name's format allows.
    pub(crate) fn adapt_depth_to_name(&mut self) {
        self.image_spec.depth =
            PictureFormat::from_path(Path::new(self.path.trim())).supported_depth(self.image_spec.depth);
    }

    /// Replaces a known extension of the file name, or appends one; other text after a dot is part of the name.
    fn set_extension(&mut self, ending: &str) {
        let path = Path::new(self.path.trim());
        let known = path
            .extension()
            .is_some_and(|found| EXTENSIONS.iter().any(|own| found.eq_ignore_ascii_case(own)));
        let stem = if known { path.with_extension("") } else { path.to_owned() };
        self.path = stem.display().to_string();
        if !ending.is_empty() {
            self.path = format!("{}.{ending}", self.path);
        }
    }

    /// Rows for the samples per pixel of a picture, and its file format.
    fn still_ui(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label(text::export::SAMPLES.name);
            for samples in 1..=MAX_SAMPLES_PER_EDGE {
                let count = samples * samples;
                let response = ui.selectable_label(self.image_spec.samples == samples, count.to_string());
                let response = response.on_hover_text(text::export::SAMPLES.tooltip);
                response.widget_info(|| {
                    let label = text::export::samples(count);
                    egui::WidgetInfo::selected(
                        egui::Role::Button,
                        true,
                        samples == self.image_spec.samples,
                        label,
                    )
                });
                if response.clicked() {
                    self.image_spec.samples = samples;
                }
            }
        });
        ui.horizontal(|ui| {
            for (depth, ControlText { name, tooltip: tip }, ending) in STILL_FORMATS {
                if ui.selectable_label(self.image_spec.depth == depth, name).on_hover_text(tip).clicked() {
                    self.image_spec.depth = depth;
                    self.set_extension(ending);
                }
            }
        });
    }

    /// Rows for the number of frames of a turntable, its frame rate and its file format.
    fn turntable_ui(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            if self.kind == ExportKind::TimeSeries {
                ui.label(text::export::steps(self.step_count));
            } else {
                let field = egui::DragValue::new(&mut self.frames)
                    .range(2..=3600)
                    .suffix(text::export::TURN_PICTURES_UNIT);
                ui.name_inputs(text::export::FRAMES, |ui| ui.add(field));
            }
            let field = egui::DragValue::new(&mut self.rate).range(1..=120).suffix(text::export::RATE_UNIT);
            ui.name_inputs(text::export::RATE, |ui| ui.add(field));
            ui.weak(text::export::seconds(f64::from(self.frame_count()) / f64::from(self.rate.max(1))));
        });
        ui.horizontal(|ui| {
            for (format, ControlText { name, tooltip: tip }, ending) in ANIMATION_FORMATS {
                let is_selected = self.animation_format() == format;
                if ui.selectable_label(is_selected, name).on_hover_text(tip).clicked() && !is_selected {
                    self.set_extension(ending);
                }
            }
        });
    }

    fn progress_ui(&self, ui: &mut Ui) {
        // Comes first, so that it stays in place when the progress bar appears.
        if ui.button(text::common::CANCEL).clicked() {
            self.cancel();
        }
        let JobProgress { done, total } = self.work.progress().unwrap_or_default();
        if total > 1 {
            let bar = egui::ProgressBar::new(done as f32 / total as f32).desired_width(120.0);
            let count = if self.kind == ExportKind::Still {
                text::export::parts_done(done, total)
            } else {
                text::export::frames_done(done, total)
            };
            ui.add(bar.text(count));
            if let Some(left) = self.remaining_time() {
                ui.weak(text::export::time_left(left));
            }
        } else {
            ui.spinner();
            ui.label(text::export::RENDERING);
        }
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
    }

    fn size_ui(&mut self, ui: &mut Ui, viewport: [u32; 2]) {
        ui.horizontal(|ui| {
            ui.label(text::export::SIZE);
            for (edge, name) in
                self.image_spec.size.iter_mut().zip([text::export::WIDTH, text::export::HEIGHT])
            {
                let field = egui::DragValue::new(edge).range(1..=MAX_IMAGE_EDGE).suffix(text::export::PIXELS);
                ui.name_inputs(name, |ui| ui.add(field));
            }
            let [width, height] = self.image_spec.size.map(f64::from);
            // At 300 dots per inch, as journals require.
            ui.weak(text::export::print_size(width / 300.0 * 25.4, height / 300.0 * 25.4));
        });
        ui.horizontal(|ui| {
            let presets = [
                (text::export::WINDOW, viewport),
                (text::export::TWICE_WINDOW, viewport.map(|n| n.saturating_mul(2))),
                (text::export::FULL_HD, [1920, 1080]),
                (text::export::ULTRA_HD, [3840, 2160]),
                (text::export::ULTRA_HD_8K, [7680, 4320]),
            ];
            for (name, size) in presets {
                if ui.selectable_label(self.image_spec.size == size, name).clicked() {
                    self.set_size(size);
                }
            }
        });
    }
}
