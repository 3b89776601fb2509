//! A contact sheet: looks that are tried on the open volume. Whole ones, lights (rigs, and places for the selected
//! light, all of them or the best), or the library's presets.

mod sheet;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, vec2};

use self::sheet::{Candidate, SIZE, Tried};
use super::export::Subject;
use crate::app::common::commands::Command;
use crate::app::common::theme;
use crate::app::text;
use crate::app::worker::task::Work;

pub(crate) use self::sheet::Sheet;

/// Pictures side by side.
const COLUMNS: usize = 4;

/// A candidate and its small picture, on the GPU of the window.
struct Print {
    name: String,
    tip: String,
    command: Command,
    texture: TextureHandle,
}

/// The window.
#[derive(Default)]
pub(crate) struct ContactSheet {
    /// Whether it is shown.
    open: bool,
    /// What it shows.
    sheet: Sheet,
    /// Whether pictures are to be made as soon as that is possible.
    pub is_due: bool,
    work: Option<Work<Result<Vec<Tried>, String>>>,
    prints: Vec<Print>,
}

impl std::fmt::Debug for ContactSheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactSheet").field("open", &self.open).finish_non_exhaustive()
    }
}

impl ContactSheet {
    /// Opens the window and asks for pictures.
    pub(crate) fn open(&mut self, sheet: Sheet) {
        if self.sheet != sheet {
            self.prints.clear();
        }
        (self.open, self.is_due, self.sheet) = (true, true, sheet);
    }

    /// Starts to make the pictures.
    pub(crate) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        self.is_due = false;
        let sheet = self.sheet;
        let task = move || sheet.try_all(&subject);
        let work = Work::start("contact-sheet", ctx, task);
        self.work = Some(work.map_err(text::contact_sheet::no_thread)?);
        Ok(())
    }

    /// Shows the window, and adds what was chosen. An error says why there are no pictures.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, commands: &mut Vec<Command>) -> Result<(), String> {
        let finished = self.work.as_ref().and_then(Work::take);
        let mut outcome = Ok(());
        if let Some(result) = finished {
            self.work = None;
            match result.and_then(|result| result) {
                Ok(tried) => {
                    self.prints =
                        tried.into_iter().map(|(look, picture)| print(ctx, look, picture)).collect();
                }
                Err(err) => outcome = Err(err),
            }
        }
        let mut open = self.open;
        let window =
            egui::Window::new(self.sheet.title()).open(&mut open).resizable(false).collapsible(false);
        window.default_pos([60.0, 60.0]).show(ctx, |ui| {
            ui.horizontal(|ui| {
                if self.work.is_some() || self.is_due {
                    ui.spinner();
                    ui.label(text::contact_sheet::TRYING);
                } else if ui.button(text::contact_sheet::AGAIN).clicked() {
                    self.is_due = true;
                }
                ui.add_space(theme::HANDLE_RADIUS);
                ui.weak(text::contact_sheet::QUALITY);
            });
            // Low windows have bars instead of a sheet that hangs over.
            let most = ctx.content_rect().height() - 170.0;
            let most = most.max(150.0);
            let area = egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most);
            area.show(ui, |ui| {
                egui::Grid::new("contact sheet").spacing([8.0, 8.0]).show(ui, |ui| {
                    for (at, tried) in self.prints.iter().enumerate() {
                        if at > 0 && at % COLUMNS == 0 {
                            ui.end_row();
                        }
                        ui.vertical(|ui| {
                            let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
                            let image = egui::Image::new((tried.texture.id(), size));
                            let button = ui.add(egui::Button::image(image).frame(false));
                            let name = text::contact_sheet::use_look(&tried.name);
                            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                            if button.on_hover_text(&tried.tip).clicked() {
                                commands.push(tried.command.clone());
                            }
                            ui.small(&tried.name);
                        });
                    }
                })
            });
        });
        self.open = open;
        outcome
    }
}

fn print(ctx: &egui::Context, look: Candidate, picture: ColorImage) -> Print {
    let Candidate { name, tip, command, settings: _ } = look;
    let texture = ctx.load_texture(format!("contact sheet {name}"), picture, TextureOptions::LINEAR);
    Print { name, tip, command, texture }
}
