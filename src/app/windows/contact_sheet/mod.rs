//! Contact sheet: looks tried on the open volume as small pictures. Whole looks, lights (rigs and positions for the
//! selected light, all of them or the best), or the library's presets.

mod candidates;

use std::sync::mpsc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, vec2};

use self::candidates::{LookCandidate, PICTURE_SIZE, RenderedCandidate};
use super::export::ExportScene;
use crate::app::common::commands::AppCommand;
use crate::app::common::dock::ToolWindow;
use crate::app::common::theme;
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_scene::Settings;

pub(crate) use self::candidates::{ContactSheetKind, PICTURE_SIZE as SMALL, quick_settings, render_small};

/// Height above and below the pictures, in points: default position of the window, its title, the row of buttons, and
/// margins.
const CHROME_HEIGHT: f32 = 170.0;
/// Smallest height of the sheet, in points: one picture with its name.
const MIN_HEIGHT: f32 = 150.0;

/// Number of columns before the user resizes the window.
const COLUMNS: usize = 4;
/// Largest number of columns: that of the largest sheets.
const MAX_COLUMNS: usize = 12;

/// Gap between pictures, in points.
const TILE_GAP: f32 = 8.0;
/// Range of picture widths relative to their rendered width: from where they can still be told apart to where they
/// look blurred.
const RELATIVE_WIDTHS: std::ops::RangeInclusive<f32> = 0.65..=1.35;

/// Grid layout of the pictures in the window.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TileLayout {
    columns: usize,
    /// Width of a picture, in points.
    width: f32,
}

impl TileLayout {
    /// Layout that fills a width with the fewest empty places in the last row, at about the rendered size.
    fn fit(room: f32, count: usize) -> Self {
        let made = PICTURE_SIZE[0] as f32;
        let width = |columns: usize| (room + TILE_GAP) / columns as f32 - TILE_GAP;
        let fits = |columns: &usize| RELATIVE_WIDTHS.contains(&(width(*columns) / made));
        let empty = |columns: usize| if count < columns { 0 } else { (columns - count % columns) % columns };
        let off = |columns: usize| (width(columns) / made).ln().abs();
        let best = (1..=MAX_COLUMNS)
            .filter(fits)
            .min_by(|&a, &b| empty(a).cmp(&empty(b)).then(off(a).total_cmp(&off(b))));
        match best {
            Some(columns) => Self { columns, width: width(columns) },
            // Narrower than one picture, or wider than all.
            None if room < made => Self { columns: 1, width: room.max(1.0) },
            None => Self { columns: MAX_COLUMNS, width: made },
        }
    }
}

/// Candidate look with its small picture, as a texture of the window.
struct ContactPrint {
    name: String,
    tip: String,
    command: AppCommand,
    texture: TextureHandle,
    /// True if the candidate suits the kind of data.
    suits_data: bool,
}

/// Contact sheet in progress on a background thread, as far as its pictures have arrived.
struct SheetTask {
    /// Finished candidates, each with the total number of candidates.
    results: mpsc::Receiver<(usize, RenderedCandidate)>,
    /// True while the pictures of the previous sheet are still shown.
    shows_previous: bool,
    count: usize,
    sheet: ContactSheetKind,
    /// Look and selected light that the candidates are derived from.
    base: (Settings, usize),
}

/// State of the contact sheet window.
#[derive(Default)]
pub(crate) struct ContactSheetWindow {
    /// True while the window is shown.
    open: bool,
    /// Kind of sheet that the window shows.
    sheet: ContactSheetKind,
    /// True if pictures are to be made as soon as possible.
    is_due: bool,
    /// Sheet in progress; one at a time, because each opens a device of its own.
    task: JobSlot<Result<(), String>, SheetTask>,
    prints: Vec<ContactPrint>,
    /// Name of the candidate that was chosen last.
    chosen: Option<String>,
}

impl std::fmt::Debug for ContactSheetWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactSheet").field("open", &self.open).finish_non_exhaustive()
    }
}

impl ContactSheetWindow {
    /// Opens the window and requests pictures.
    pub(crate) fn open(&mut self, sheet: ContactSheetKind) {
        if self.sheet != sheet {
            self.prints.clear();
        }
        self.chosen = None;
        (self.open, self.is_due, self.sheet) = (true, true, sheet);
    }

    /// Closes the window and discards its pictures, because the volume has been replaced.
    pub(crate) fn discard(&mut self) {
        self.prints.clear();
        (self.open, self.is_due) = (false, false);
        self.task.cancel();
    }

    /// Returns true if pictures are to be made.
    pub(crate) fn needs_start(&self) -> bool {
        self.is_due
    }

    /// Starts to render the pictures, or continues if the same ones are in progress. Another sheet in progress ends
    /// first, so that a held key starts one thread and not many. Without a subject nothing is started.
    pub(crate) fn start(&mut self, subject: Option<ExportScene>, ctx: &egui::Context) -> Result<(), String> {
        let Some(subject) = subject else {
            self.is_due = false;
            return Ok(());
        };
        let (sheet, of) = (self.sheet, (subject.settings.clone(), subject.selected_light));
        if let Some(trying) = self.task.inputs() {
            if trying.sheet == sheet && trying.base == of && !self.task.is_cancelled() {
                self.is_due = false;
            } else {
                self.task.cancel();
            }
            return Ok(());
        }
        self.is_due = false;
        let (sender, tried) = mpsc::channel();
        let wake = ctx.clone();
        let task = move |job: &JobControl| {
            let hand_on = |count: usize, of: RenderedCandidate| {
                // The receiver may be gone; the result is then dropped.
                drop(sender.send((count, of)));
                wake.request_repaint();
            };
            sheet.render_candidates(&subject, job.token(), &hand_on)
        };
        let trying = SheetTask { results: tried, shows_previous: true, count: 0, sheet, base: of };
        let started = self.task.start(JobKind::ContactSheet, ctx, trying, task);
        started.map_err(text::contact_sheet::no_thread)
    }

    /// Collects the finished pictures, unless the sheet was cancelled.
    fn collect(&mut self, ctx: &egui::Context) -> Result<(), String> {
        let is_cancelled = self.task.is_cancelled();
        // Taken before the channel is drained: nothing is sent after the end of the task.
        let mut ended = self.task.take_ended();
        let trying = ended.as_mut().map(|(trying, _)| trying).or(self.task.inputs_mut());
        let Some(trying) = trying.filter(|_| !is_cancelled) else { return Ok(()) };
        for (count, (look, picture)) in trying.results.try_iter() {
            if std::mem::take(&mut trying.shows_previous) {
                self.prints.clear();
            }
            trying.count = count;
            self.prints.push(upload_candidate(ctx, look, picture));
        }
        ended.map_or(Ok(()), |(_, result)| result.and_then(|result| result))
    }

    /// Shows the window, and adds the command of the chosen look. An error says why there are no pictures.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, commands: &mut Vec<AppCommand>) -> Result<(), String> {
        let outcome = self.collect(ctx);
        let mut open = self.open;
        let default_width = COLUMNS as f32 * (PICTURE_SIZE[0] as f32 + TILE_GAP);
        let tool = ToolWindow { title: self.sheet.title(), default_pos: [60.0, 60.0], default_width };
        tool.show(ctx, &mut open, |ui| {
            ui.horizontal(|ui| {
                if self.task.is_running() || self.is_due {
                    ui.spinner();
                    let (done, count) = self
                        .task
                        .inputs()
                        .filter(|trying| !trying.shows_previous)
                        .map_or((0, 0), |trying| (self.prints.len(), trying.count));
                    ui.label(text::contact_sheet::progress(done, count));
                } else if ui.button(text::contact_sheet::AGAIN).clicked() {
                    self.is_due = true;
                }
                ui.add_space(theme::HANDLE_RADIUS);
                ui.weak(text::contact_sheet::CLICK_HINT);
            });
            // In a low window the sheet scrolls instead of overflowing.
            let most = (ctx.content_rect().height() - CHROME_HEIGHT).max(MIN_HEIGHT);
            let area = egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most);
            area.show(ui, |ui| {
                let count = self.task.inputs().map_or(0, |trying| trying.count).max(self.prints.len());
                let TileLayout { columns, width } = TileLayout::fit(ui.available_width(), count);
                let size = vec2(width, width * PICTURE_SIZE[1] as f32 / PICTURE_SIZE[0] as f32);
                egui::Grid::new("contact sheet").spacing([TILE_GAP, TILE_GAP]).show(ui, |ui| {
                    for (at, tried) in self.prints.iter().enumerate() {
                        if at > 0 && at % columns == 0 {
                            ui.end_row();
                        }
                        ui.vertical(|ui| {
                            let image = egui::Image::new((tried.texture.id(), size));
                            // Candidates for other kinds of data are dimmed.
                            let tint = if tried.suits_data {
                                egui::Color32::WHITE
                            } else {
                                egui::Color32::from_gray(0x60)
                            };
                            let image = image.tint(tint);
                            let button = ui.add(egui::Button::image(image).frame(false));
                            let name = text::contact_sheet::use_look(&tried.name);
                            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                            if self.chosen.as_ref() == Some(&tried.name) {
                                let edge = egui::Stroke::new(2.5, theme::ACCENT);
                                ui.painter().rect_stroke(button.rect, 2.0, edge, egui::StrokeKind::Inside);
                            }
                            if button.on_hover_text(&tried.tip).clicked() {
                                commands.push(tried.command.clone());
                                self.chosen = Some(tried.name.clone());
                            }
                            ui.small(&tried.name);
                        });
                    }
                })
            });
        });
        if self.open && !open {
            self.is_due = false;
            self.task.cancel();
        }
        self.open = open;
        outcome
    }
}

fn upload_candidate(ctx: &egui::Context, look: LookCandidate, picture: ColorImage) -> ContactPrint {
    let LookCandidate { name, tip, command, settings: _, suits_data: fits } = look;
    let texture = ctx.load_texture(format!("contact sheet {name}"), picture, TextureOptions::LINEAR);
    ContactPrint { name, tip, command, texture, suits_data: fits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_render::GpuContext;
    use chiaroscuro_volume::{CancelToken, Dataset, synthetic::builtin};

    /// Cancel token of the running thread, if there is one.
    fn cancel_token(sheet: &ContactSheetWindow) -> Option<CancelToken> {
        sheet.task.token().cloned()
    }

    #[test]
    fn pictures_fill_their_window() {
        let tiles = |room: f32, count: usize| TileLayout::fit(room, count);
        for room in 132..2000 {
            for count in [1, 3, 4, 10, 12, 22] {
                let TileLayout { columns, width } = tiles(room as f32, count);
                let taken = columns as f32 * (width + TILE_GAP) - TILE_GAP;
                assert!((taken - room as f32).abs() < 1e-2, "{count} in {room}: {columns} × {width}");
                assert!((width / PICTURE_SIZE[0] as f32) < 1.36, "{count} in {room}: {width}");
            }
        }
        // Ten pictures in a window that almost fits four columns: no picture is alone in a row.
        assert_eq!(tiles(720.0, 10).columns, 5);
        assert_eq!(tiles(728.0, 12).columns, 4);
        assert_eq!(tiles(100.0, 10), TileLayout { columns: 1, width: 100.0 });
    }

    #[test]
    fn one_thread_tries_at_a_time() {
        let ctx = egui::Context::default();
        let subject = ExportScene {
            context: GpuContext::headless().expect("an adapter"),
            dataset: Dataset::new(builtin("sphere", Some(8)).expect("a volume")),
            settings: Settings::default(),
            first_look: Settings::default(),
            source: "builtin:sphere:8".into(),
            selected_light: 0,
            outline: None,
            series: None,
            file: None,
        };
        let mut sheet = ContactSheetWindow::default();
        let ask = |sheet: &mut ContactSheetWindow, subject: Option<&ExportScene>| {
            sheet.open(ContactSheetKind::Lights);
            sheet.start(subject.cloned(), &ctx).expect("a thread");
            cancel_token(sheet)
        };
        assert!(ask(&mut sheet, None).is_none() && !sheet.needs_start(), "nothing to try on");
        let first = ask(&mut sheet, Some(&subject)).expect("a thread");
        for _ in 0..5 {
            let again = ask(&mut sheet, Some(&subject)).expect("a thread");
            assert!(!again.is_cancelled() && !sheet.needs_start(), "it is on its way");
        }
        assert!(!first.is_cancelled());
        // For another subject the first task ends before the second starts.
        let other = ExportScene { selected_light: 1, ..subject };
        let still = ask(&mut sheet, Some(&other)).expect("a thread");
        assert!(still.is_cancelled() && first.is_cancelled() && sheet.needs_start());
        while sheet.task.is_running() {
            sheet.collect(&ctx).expect("no error");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        assert!(sheet.prints.is_empty(), "of what nobody wants");
        let second = ask(&mut sheet, Some(&other)).expect("a thread");
        assert!(!second.is_cancelled() && !sheet.needs_start());
        sheet.discard();
        assert!(second.is_cancelled() && !sheet.open);
        while sheet.task.is_running() {
            sheet.collect(&ctx).expect("no error");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
    }
}
