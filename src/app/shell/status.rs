//! Status bar: progress of picture and tasks, the last undo step, and render statistics behind a button.

use std::path::Path;

use eframe::egui::{self, ProgressBar, RichText, TextStyle};

use super::messages::MessageLog;
use crate::app::common::commands::AppCommand;
use crate::app::common::elide::elide_middle;
use crate::app::common::theme;
use crate::app::text;
use crate::app::viewport::{RendererActivity, RendererStatus};
use crate::app::windows::export::ExportProgress;
use crate::app::worker::loader::LoadProgress;
use crate::app::worker::mailbox::FinerLevelStatus;
use chiaroscuro_files::sanitised;

/// Maximum number of characters of a path in the bar: more than the widest screen shows.
const MAX_PATH_CHARS: usize = 500;

/// Maximum width of the last undo step, in points: names of lights may be long.
const MAX_STEP_WIDTH: f32 = 260.0;

/// Width reserved for the buttons at the right end of the bar, in points.
const BUTTONS_WIDTH: f32 = 200.0;

/// Tasks that can be cancelled in the bar.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CancellableTasks<'a> {
    /// Progress of the volume that is being opened.
    pub opening: Option<LoadProgress<'a>>,
    /// Path of another file that is being read.
    pub reading: Option<&'a Path>,
    /// Progress of the export, while its window is closed.
    pub exporting: Option<ExportProgress>,
}

/// Contents of the status bar.
#[derive(Clone, Copy)]
pub(crate) struct StatusBar<'a> {
    /// Statistics and state of the renderer.
    pub facts: &'a RendererStatus,
    /// Tasks in progress that can be cancelled.
    pub busy: CancellableTasks<'a>,
    /// Name of another task in progress, such as placing lights.
    pub background_task: Option<&'static str>,
    /// Description of the last undo or redo.
    pub last_step: Option<&'a str>,
}

/// Shows the bar at the bottom of the window.
pub(crate) fn show(
    ui: &mut egui::Ui,
    status: StatusBar<'_>,
    messages: &mut MessageLog,
    commands: &mut Vec<AppCommand>,
) {
    let StatusBar {
        facts,
        busy: CancellableTasks { opening, reading, exporting },
        background_task: making,
        last_step: went,
    } = status;
    egui::Panel::bottom("status").resizable(false).frame(theme::panel(ui)).show(ui, |ui| {
        ui.horizontal(|ui| {
            if let Some(opening) = opening {
                progress_of_opening(ui, &opening, commands);
            } else if let Some(path) = reading {
                ui.spinner();
                let path = sanitised(&path.to_string_lossy(), MAX_PATH_CHARS);
                let words = text::status::opening_progress(text::opening::READING, None, &path);
                let room = ui.available_width() - BUTTONS_WIDTH;
                let response = ui.label(elide_middle(ui, &words, &TextStyle::Body, room));
                response.on_hover_text(words);
                cancel(ui, commands);
            } else {
                picture_state(ui, facts.activity, making);
                if let Some(levels) = &facts.finer_levels {
                    finer_levels(ui, levels);
                }
                if let Some(went) = went {
                    ui.separator();
                    let words = elide_middle(ui, went, &TextStyle::Body, MAX_STEP_WIDTH);
                    let link = ui.add(egui::Link::new(words));
                    if link.on_hover_text(text::status::HISTORY_TIP).clicked() {
                        commands.push(AppCommand::ToggleHistory);
                    }
                }
            }
            if let Some(exporting) = exporting {
                export(ui, exporting, commands);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                statistics(ui, facts);
                let (count, left) = messages.unread();
                if count > 0 {
                    ui.ctx().request_repaint_after(left);
                    let button = ui.small_button(text::messages::count(count));
                    if button.on_hover_text(text::messages::LIST_TIP).clicked() {
                        messages.list_open ^= true;
                    }
                }
            });
        });
    });
}

/// Shows the progress of a volume that is being opened.
fn progress_of_opening(ui: &mut egui::Ui, opening: &LoadProgress<'_>, commands: &mut Vec<AppCommand>) {
    let &LoadProgress { source, reading: _, phase, fraction, bytes } = opening;
    match fraction {
        Some(share) => ui.add(ProgressBar::new(share).desired_width(120.0).desired_height(8.0)),
        // A spinner, since an empty progress bar looks stuck.
        None => ui.spinner(),
    };
    let words =
        text::status::opening_progress(phase, bytes, &sanitised(&source.to_string_lossy(), MAX_PATH_CHARS));
    let room = ui.available_width() - BUTTONS_WIDTH;
    let response = ui.label(elide_middle(ui, &words, &TextStyle::Body, room));
    response.on_hover_text(words);
    cancel(ui, commands);
}

/// Shows the button that cancels reading and opening.
fn cancel(ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) {
    if ui.small_button(&*AppCommand::CancelOpening.label()).clicked() {
        commands.push(AppCommand::CancelOpening);
    }
}

/// Shows the progress of an export whose window may be closed.
fn export(
    ui: &mut egui::Ui,
    ExportProgress { done, total, remaining: left }: ExportProgress,
    commands: &mut Vec<AppCommand>,
) {
    ui.separator();
    // First, so that the button does not move while the count changes.
    if ui.small_button(text::common::CANCEL).clicked() {
        commands.push(AppCommand::CancelExport);
    }
    if total > 1 {
        let bar = ProgressBar::new(done as f32 / total as f32).desired_width(80.0).desired_height(8.0);
        ui.add(bar);
    } else {
        ui.spinner();
    }
    let words = text::status::export_progress(done, total);
    let words = left.map_or(words.clone(), |left| format!("{words}, {}", text::export::time_left(left)));
    if ui.link(words).on_hover_text(text::status::EXPORTING_TIP).clicked() {
        commands.push(AppCommand::Export);
    }
}

/// Shows the button with a popup of statistics: render times, memory and graphics device.
fn statistics(ui: &mut egui::Ui, facts: &RendererStatus) {
    let named = text::status::PERFORMANCE;
    let button = ui.small_button(named.name);
    egui::Popup::menu(&button).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.strong(named.name);
        egui::Grid::new("performance").num_columns(2).show(ui, |ui| {
            for (name, value) in text::status::statistics(&text::status::RenderStatisticsText {
                full_ms: facts.full_ms,
                preview_ms: facts.preview_ms,
                splats: facts.splat_count,
                cached_light_volumes: facts.cached_light_volumes,
                light_rebuilds: facts.light_fill_count,
                gpu_mebibytes: facts.gpu_mebibytes,
                adapter: &facts.adapter,
                driver: &facts.driver,
                is_software: facts.is_software,
            }) {
                ui.weak(name);
                ui.label(value);
                ui.end_row();
            }
        });
    });
    button.on_hover_text(named.tooltip);
}

/// Shows which resolution level the picture has, and what of it is missing.
fn finer_levels(ui: &mut egui::Ui, levels: &FinerLevelStatus) {
    ui.separator();
    let FinerLevelStatus { finest, missing, is_substituted, error } = levels;
    let words = text::status::finer_levels(finest, *missing, *is_substituted);
    match error {
        None => ui.label(words).on_hover_text(text::status::FINER_LEVELS_TIP),
        Some(error) => {
            let words = text::status::FINER_LEVELS_FAILED;
            ui.label(RichText::new(words).color(ui.visuals().error_fg_color)).on_hover_text(error)
        }
    };
}

/// Shows the state of the picture, or the task in progress.
fn picture_state(ui: &mut egui::Ui, doing: RendererActivity, making: Option<&'static str>) {
    match (doing, making) {
        (RendererActivity::Refining(what, share), _) => {
            let bar = ProgressBar::new(share).desired_width(80.0).desired_height(8.0);
            ui.add(bar.fill(theme::ACCENT));
            ui.label(text::status::refinement_progress(share, what))
        }
        (RendererActivity::Failed, _) => {
            ui.label(RichText::new(text::status::NOT_RENDERED).color(ui.visuals().error_fg_color))
        }
        (RendererActivity::DeviceLost, _) => {
            ui.label(RichText::new(text::status::DEVICE_LOST).color(ui.visuals().error_fg_color))
        }
        (_, Some(making)) => {
            ui.spinner();
            ui.label(making)
        }
        (RendererActivity::Idle, None) => ui.weak(text::status::NO_VOLUME),
        (RendererActivity::FullQuality, None) => ui.label(text::status::FULL_QUALITY),
        (RendererActivity::Preview, None) => {
            ui.label(RichText::new(text::status::PREVIEW).color(theme::accent(ui.visuals())))
        }
    };
}
