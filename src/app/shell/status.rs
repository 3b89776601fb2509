//! Status bar: progress of picture and tasks, the last undo step, and render statistics behind a button.

use std::path::Path;

use eframe::egui::{self, ProgressBar, RichText, TextStyle};

use super::messages::Messages;
use crate::app::common::commands::Command;
use crate::app::common::elide::elide_middle;
use crate::app::common::theme;
use crate::app::text;
use crate::app::viewport::{Doing, Facts};
use crate::app::windows::export::Unseen;
use crate::app::worker::loader::LoadProgress;
use crate::data::plain;

/// Maximum number of characters of a path in the bar: more than the widest screen shows.
const LONGEST_PATH: usize = 500;

/// Maximum width of the last undo step, in points: names of lights may be long.
const LONGEST_STEP: f32 = 260.0;

/// Width reserved for the buttons at the right end of the bar, in points.
const BUTTONS: f32 = 200.0;

/// Tasks that can be cancelled in the bar.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Busy<'a> {
    /// Progress of the volume that is being opened.
    pub opening: Option<LoadProgress<'a>>,
    /// Path of another file that is being read.
    pub reading: Option<&'a Path>,
    /// Progress of the export, while its window is closed.
    pub exporting: Option<Unseen>,
}

/// Contents of the status bar.
#[derive(Clone, Copy)]
pub(crate) struct Status<'a> {
    /// Statistics and state of the renderer.
    pub facts: &'a Facts,
    /// Tasks in progress that can be cancelled.
    pub busy: Busy<'a>,
    /// Name of another task in progress, such as placing lights.
    pub making: Option<&'static str>,
    /// Description of the last undo or redo.
    pub went: Option<&'a str>,
}

/// Shows the bar at the bottom of the window.
pub(crate) fn show(
    ui: &mut egui::Ui,
    status: Status<'_>,
    messages: &mut Messages,
    commands: &mut Vec<Command>,
) {
    let Status { facts, busy: Busy { opening, reading, exporting }, making, went } = status;
    egui::Panel::bottom("status").resizable(false).frame(theme::panel(ui)).show(ui, |ui| {
        ui.horizontal(|ui| {
            if let Some(opening) = opening {
                progress_of_opening(ui, &opening, commands);
            } else if let Some(path) = reading {
                ui.spinner();
                let path = plain(&path.to_string_lossy(), LONGEST_PATH);
                let words = text::status::opening(text::opening::READING, None, &path);
                let room = ui.available_width() - BUTTONS;
                let response = ui.label(elide_middle(ui, &words, &TextStyle::Body, room));
                response.on_hover_text(words);
                cancel(ui, commands);
            } else {
                doing(ui, facts.doing, making);
                if let Some(went) = went {
                    ui.separator();
                    let words = elide_middle(ui, went, &TextStyle::Body, LONGEST_STEP);
                    let link = ui.add(egui::Link::new(words));
                    if link.on_hover_text(text::status::WENT_TIP).clicked() {
                        commands.push(Command::ToggleHistory);
                    }
                }
            }
            if let Some(exporting) = exporting {
                export(ui, exporting, commands);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                figures(ui, facts);
                let (count, left) = messages.unread();
                if count > 0 {
                    ui.ctx().request_repaint_after(left);
                    let button = ui.small_button(text::messages::count(count));
                    if button.on_hover_text(text::messages::LIST_TIP).clicked() {
                        messages.lists ^= true;
                    }
                }
            });
        });
    });
}

/// Shows the progress of a volume that is being opened.
fn progress_of_opening(ui: &mut egui::Ui, opening: &LoadProgress<'_>, commands: &mut Vec<Command>) {
    let &LoadProgress { source, reading: _, phase, fraction, bytes } = opening;
    match fraction {
        Some(share) => ui.add(ProgressBar::new(share).desired_width(120.0).desired_height(8.0)),
        // A spinner, since an empty progress bar looks stuck.
        None => ui.spinner(),
    };
    let words = text::status::opening(phase, bytes, &plain(&source.to_string_lossy(), LONGEST_PATH));
    let room = ui.available_width() - BUTTONS;
    let response = ui.label(elide_middle(ui, &words, &TextStyle::Body, room));
    response.on_hover_text(words);
    cancel(ui, commands);
}

/// Shows the button that cancels reading and opening.
fn cancel(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    if ui.small_button(&*Command::CancelOpening.label()).clicked() {
        commands.push(Command::CancelOpening);
    }
}

/// Shows the progress of an export whose window may be closed.
fn export(ui: &mut egui::Ui, Unseen { done, total, left }: Unseen, commands: &mut Vec<Command>) {
    ui.separator();
    // First, so that the button does not move while the count changes.
    if ui.small_button(text::common::CANCEL).clicked() {
        commands.push(Command::CancelExport);
    }
    if total > 1 {
        let bar = ProgressBar::new(done as f32 / total as f32).desired_width(80.0).desired_height(8.0);
        ui.add(bar);
    } else {
        ui.spinner();
    }
    let words = text::status::exporting(done, total);
    let words = left.map_or(words.clone(), |left| format!("{words}, {}", text::export::left(left)));
    if ui.link(words).on_hover_text(text::status::EXPORTING_TIP).clicked() {
        commands.push(Command::Export);
    }
}

/// Shows the button with a popup of statistics: render times, memory and graphics device.
fn figures(ui: &mut egui::Ui, facts: &Facts) {
    let named = text::status::PERFORMANCE;
    let button = ui.small_button(named.name);
    egui::Popup::menu(&button).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.strong(named.name);
        egui::Grid::new("performance").num_columns(2).show(ui, |ui| {
            for (name, value) in text::status::figures(&text::status::Figures {
                full_ms: facts.full_ms,
                preview_ms: facts.preview_ms,
                splats: facts.splats,
                cached_light_volumes: facts.cached_light_volumes,
                light_rebuilds: facts.light_rebuilds,
                gpu_mebibytes: facts.gpu_mebibytes,
                adapter: &facts.adapter,
                driver: &facts.driver,
                is_software: facts.software,
            }) {
                ui.weak(name);
                ui.label(value);
                ui.end_row();
            }
        });
    });
    button.on_hover_text(named.tip);
}

/// Shows the state of the picture, or the task in progress.
fn doing(ui: &mut egui::Ui, doing: Doing, making: Option<&'static str>) {
    match (doing, making) {
        (Doing::Refining(what, share), _) => {
            let bar = ProgressBar::new(share).desired_width(80.0).desired_height(8.0);
            ui.add(bar.fill(theme::ACCENT));
            ui.label(text::status::refining(share, what))
        }
        (Doing::Failed, _) => {
            ui.label(RichText::new(text::status::NOT_RENDERED).color(ui.visuals().error_fg_color))
        }
        (Doing::Lost, _) => {
            ui.label(RichText::new(text::status::DEVICE_LOST).color(ui.visuals().error_fg_color))
        }
        (_, Some(making)) => {
            ui.spinner();
            ui.label(making)
        }
        (Doing::Nothing, None) => ui.weak(text::status::NO_VOLUME),
        (Doing::FullQuality, None) => ui.label(text::status::SHARP),
        (Doing::Preview, None) => {
            ui.label(RichText::new(text::status::PREVIEW).color(theme::accent(ui.visuals())))
        }
    };
}
