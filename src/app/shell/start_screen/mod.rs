//! Start screen: pictures of the built-in scenes beside the recent files, shown until a volume is open.

mod cards;
mod live_card;
mod scene_pictures;

use eframe::egui::{self, Key, ScrollArea, vec2};

use self::cards::CardGrid;
use self::live_card::LiveCard;
use self::scene_pictures::ScenePictures;
use super::recent_files::recent_file_button;
use crate::app::common::commands::AppCommand;
use crate::app::common::{overlay_windows, theme};
use crate::app::persistence::{RecentFile, RecentThumbnails};
use crate::app::text;
use chiaroscuro_render::GpuContext;
use chiaroscuro_scene::{PRESETS, Preset};

/// Width of the list of recent files, in points: a thumbnail and some thirty letters of a name.
const LIST_WIDTH: f32 = 250.0;

/// Smallest width at which the list is beside the pictures and not below them, in points: it leaves room for two
/// pictures of a legible size.
const WIDTH_FOR_LIST: f32 = 720.0;

/// Distance of the contents from the borders, in points.
const MARGIN: i8 = 16;

/// Width of a recent file's button without its name, in points: thumbnail, gap and padding.
const BUTTON_WIDTH: f32 = 72.0;

/// Facts about the window that decide on whether the start screen is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WindowOccupation {
    /// True if a volume is open, or kept for the user's answer after a lost device.
    pub has_volume: bool,
    /// True while a volume or another file is being read.
    pub is_opening: bool,
    /// True while a question about earlier work waits for an answer.
    pub has_question: bool,
}

/// State of the start screen.
#[derive(Default)]
pub(crate) struct StartScreen {
    is_open: bool,
    pictures: ScenePictures,
    live: LiveCard,
}

impl StartScreen {
    /// Opens the screen, over an open volume if there is one.
    pub(crate) fn open(&mut self) {
        self.is_open = true;
    }

    /// Closes the screen; without an open volume, it opens again.
    pub(crate) fn close(&mut self) {
        self.is_open = false;
        self.live.rest();
    }

    /// Returns true if the screen is shown in this frame: it opens while there is nothing else to show, and stays while
    /// something is being opened from it.
    pub(crate) fn update(&mut self, window: WindowOccupation) -> bool {
        self.is_open |= !window.has_volume && !window.is_opening;
        self.is_open && !window.has_question
    }

    /// Returns true if the screen is open, be it behind a question.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Shows the screen in the middle of the window, and returns its area. The scene under the pointer is rendered on
    /// a sibling of the device `context`, unless something is being opened.
    pub(crate) fn show(
        &mut self,
        ui: &mut egui::Ui,
        context: Option<&GpuContext>,
        recent: &[RecentFile],
        thumbnails: &mut RecentThumbnails,
        commands: &mut Vec<AppCommand>,
    ) -> egui::Rect {
        self.pictures.decode_next(ui.ctx());
        let frame = egui::Frame::new().fill(theme::EMPTY_CANVAS).inner_margin(MARGIN);
        let frame = if ui.visuals().dark_mode { frame } else { frame.fill(ui.visuals().panel_fill) };
        let shown = egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            let is_wide = ui.available_width() >= WIDTH_FOR_LIST;
            if is_wide {
                let list = egui::Panel::right("recent").resizable(false).exact_size(LIST_WIDTH);
                let gap = egui::Margin { left: MARGIN, ..egui::Margin::ZERO };
                let list = list.frame(egui::Frame::new().inner_margin(gap)).show_separator_line(false);
                list.show(ui, |ui| {
                    ScrollArea::vertical().show(ui, |ui| list_recent(ui, recent, thumbnails, commands));
                });
            }
            ScrollArea::vertical().id_salt("scenes").show(ui, |ui| {
                let pointed = CardGrid { pictures: &self.pictures, live: &self.live }.show(ui, commands);
                match (context, pointed) {
                    (Some(context), Some(card)) => self.live.update(&card, context, ui.ctx()),
                    _ => self.live.rest(),
                }
                if !is_wide {
                    ui.add_space(f32::from(MARGIN));
                    list_recent(ui, recent, thumbnails, commands);
                }
            });
        });
        shown.response.rect
    }

    /// Closes the screen when Escape is pressed and no window or widget takes the key.
    pub(crate) fn close_by_key(&mut self, ctx: &egui::Context) {
        if overlay_windows::escape_for_picture(ctx) {
            self.close();
        }
    }
}

/// Returns the presets of the built-in scenes, each with the name of its volume.
pub(crate) fn scenes() -> impl Iterator<Item = (Preset, &'static str)> {
    PRESETS.into_iter().filter_map(|preset| Some((preset, preset.scene_volume()?)))
}

/// Returns true if a command leaves the start screen open: those for files, help and the window, but not those that
/// change or need a picture.
pub(crate) fn stays_on_start(command: &AppCommand) -> bool {
    matches!(
        command,
        AppCommand::OpenDialog
            | AppCommand::OpenFolder
            | AppCommand::OpenDropped(_)
            | AppCommand::NextFile
            | AppCommand::PreviousFile
            | AppCommand::OpenPath
            | AppCommand::Open(_)
            | AppCommand::OpenScene(_)
            | AppCommand::OpenAgain(..)
            | AppCommand::ReopenLast
            | AppCommand::CancelOpening
            | AppCommand::LoadSettings
            | AppCommand::ToggleKeepLook
            | AppCommand::ShowStart
            | AppCommand::ShowPalette
            | AppCommand::ShowHelp
            | AppCommand::ShowAbout
            | AppCommand::ToggleMessages
            | AppCommand::ToggleFullScreen
            | AppCommand::Scale(_)
            | AppCommand::Quit
    )
}

/// Lists the recent files.
fn list_recent(
    ui: &mut egui::Ui,
    recent: &[RecentFile],
    thumbnails: &mut RecentThumbnails,
    commands: &mut Vec<AppCommand>,
) {
    ui.strong(text::start_screen::RECENT);
    ui.add_space(theme::INDENT / 2.0);
    if recent.is_empty() {
        ui.weak(text::start_screen::NO_RECENT);
    }
    let name_width = LIST_WIDTH - BUTTON_WIDTH - f32::from(MARGIN);
    for file in recent {
        if recent_file_button(ui, file, thumbnails, name_width).clicked() {
            commands.push(AppCommand::OpenAgain(file.path.clone(), file.choice.clone()));
        }
    }
}

/// Moves the keyboard focus to a widget when an arrow key is pressed and nothing has the focus; from there the keys
/// move it by themselves.
fn focus_by_arrow_key(ui: &egui::Ui, first: egui::Id) {
    let arrows = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];
    let is_pressed = ui.input(|input| arrows.iter().any(|key| input.key_pressed(*key)));
    if is_pressed && ui.memory(|memory| memory.focused().is_none()) {
        ui.memory_mut(|memory| {
            // This press only finds the first one, and does not move on.
            memory.move_focus(egui::FocusDirection::None);
            memory.request_focus(first);
        });
    }
}

/// Shows the buttons that open files in an area.
fn open_buttons(ui: &mut egui::Ui, rect: egui::Rect, commands: &mut Vec<AppCommand>) {
    let edge = egui::Stroke::new(1.0, ui.visuals().weak_text_color());
    let corners =
        [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom(), rect.left_top()];
    // Dashed, as places for what is dropped usually are.
    ui.painter().extend(egui::Shape::dashed_line(&corners, edge, DASH, DASH));
    let inside = egui::UiBuilder::new().max_rect(rect.shrink(f32::from(MARGIN)));
    let layout = egui::Layout::top_down(egui::Align::Center);
    ui.scope_builder(inside.layout(layout), |ui| {
        let height = 3.0 * ui.spacing().interact_size.y + 2.0 * ui.spacing().item_spacing.y;
        ui.add_space(((ui.available_height() - height) / 2.0).max(0.0));
        ui.add(egui::Label::new(egui::RichText::new(text::start_screen::DROP_HINT).weak()).wrap());
        let least = vec2(BUTTON_MIN_WIDTH, 0.0);
        for (label, command) in [
            (text::start_screen::OPEN_FILE, AppCommand::OpenDialog),
            (text::commands::OPEN_FOLDER, AppCommand::OpenFolder),
        ] {
            if ui.add(egui::Button::new(label).min_size(least)).clicked() {
                commands.push(command);
            }
        }
    });
}

/// Length of the dashes and gaps of a dashed border, in points.
const DASH: f32 = 5.0;

/// Least width of the buttons that open files, in points: that of the longer label, for both.
const BUTTON_MIN_WIDTH: f32 = 110.0;
