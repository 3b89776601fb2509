//! Raw import dialog: asks how a file of bare voxels is stored. Numbers on the left, a preview of the file with these
//! on the right, and below the numbers the layouts that its bytes make most likely.

mod analysis;
mod form;
mod preview;

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, Modifiers};

use self::analysis::RawAnalysis;
use self::form::RawImportForm;
use self::preview::RawPreview;
use crate::app::common::{overlay_windows, shortcuts};
use crate::app::text;
use chiaroscuro_volume_io::{RawGuess, RawLayout, raw::LayoutProposal};

/// Width of the numbers and proposals, in points.
const NUMBERS_WIDTH: f32 = 356.0;

/// Height of the dialog's contents, in points.
const CONTENT_HEIGHT: f32 = 640.0;

/// Height of a window's title and margins, in points.
const TITLE_HEIGHT: f32 = 46.0;

/// Layout of a raw file as the user has described it.
#[derive(Debug)]
pub(crate) struct RawDialogResult {
    /// Path of the described file.
    pub path: PathBuf,
    /// Layout of the file's voxels.
    pub layout: RawLayout,
    /// Path of a header file to write with this layout, if the user wants one.
    pub header: Option<PathBuf>,
    /// True if the file is gzip-compressed.
    pub is_gzip: bool,
}

/// File that the dialog asks about.
#[derive(Debug)]
struct RawImport {
    path: PathBuf,
    unknown_facts: String,
    form: RawImportForm,
    analysis: RawAnalysis,
    preview: RawPreview,
    /// Path where a header would be written.
    header: PathBuf,
    /// True if that header exists already.
    has_header: bool,
    writes_header: bool,
    /// True until the first field has taken the keyboard focus.
    takes_focus: bool,
    /// Id of the first field, once it has been shown.
    first_field: Option<egui::Id>,
}

/// State of the dialog; empty while it is closed.
#[derive(Debug, Default)]
pub(crate) struct RawDialog {
    pending: Option<RawImport>,
}

impl RawDialog {
    /// Opens the dialog for a file; `why` says what is not known of it.
    pub(crate) fn open(&mut self, path: &Path, why: String, guess: RawGuess, ctx: &egui::Context) {
        let header = header_path(path);
        self.pending = Some(RawImport {
            path: path.to_owned(),
            unknown_facts: why,
            form: RawImportForm::new(guess),
            analysis: RawAnalysis::start(path, guess.name_hints, ctx),
            preview: RawPreview::default(),
            has_header: header.exists(),
            header,
            writes_header: false,
            takes_focus: true,
            first_field: None,
        });
    }

    /// Closes the dialog, because something else is being opened.
    pub(crate) fn close(&mut self) {
        self.pending = None;
    }

    /// Shows the dialog, if it is open, and returns the user's description once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<RawDialogResult> {
        let asked = self.pending.as_mut()?;
        asked.take_proposals();
        shortcuts::reserve_letters(ctx);
        let mut open = true;
        let mut answer = None;
        let window = egui::Window::new(text::raw::TITLE).open(&mut open).collapsible(false).resizable(false);
        // In a low window it scrolls, so that its buttons can be reached.
        let room = overlay_windows::window_area(ctx);
        let is_narrow = room.height() < CONTENT_HEIGHT;
        let window = window.constrain_to(room).vscroll(is_narrow);
        let window = if is_narrow { window.max_height(room.height() - TITLE_HEIGHT) } else { window };
        window.default_pos([40.0, 40.0]).show(ctx, |ui| {
            let name = asked.path.file_name().unwrap_or_default().to_string_lossy();
            ui.horizontal(|ui| {
                ui.strong(name);
                ui.add(egui::Label::new(egui::RichText::new(&asked.unknown_facts).weak()).truncate());
            });
            ui.add_space(4.0);
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(NUMBERS_WIDTH);
                    answer = asked.show_left_column(ui);
                });
                ui.separator();
                ui.vertical(|ui| {
                    let layout = asked.form.layout();
                    asked.preview.ui(ui, &asked.analysis, &layout);
                });
            });
        });
        // Escape closes an open drop-down list first.
        let is_free = !egui::Popup::is_any_open(ctx);
        if is_free && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) || !open {
            answer = Some(RawDialogAnswer::Cancel);
        }
        match answer? {
            RawDialogAnswer::Cancel => {
                self.pending = None;
                None
            }
            RawDialogAnswer::Open => self.pending.take().map(RawImport::into_description),
        }
    }
}

/// Answer of the user in this frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RawDialogAnswer {
    Open,
    Cancel,
}

impl RawImport {
    /// Takes the result of the analysis. Values that the user has not edited become those of the best proposal.
    fn take_proposals(&mut self) {
        if !self.analysis.collect() {
            return;
        }
        self.form.set_analysis(self.analysis.length(), self.analysis.proposals().first());
    }

    /// Shows the numbers, whether they match the file, the proposals and the buttons.
    fn show_left_column(&mut self, ui: &mut egui::Ui) -> Option<RawDialogAnswer> {
        // Requested before the field is shown: then all of its number is selected, and typing replaces it.
        if let Some(first) = self.first_field.filter(|_| self.takes_focus && !self.analysis.is_busy()) {
            ui.memory_mut(|memory| memory.request_focus(first));
            self.takes_focus = false;
        }
        self.first_field = Some(self.form.show_fields(ui).id);
        ui.add_space(4.0);
        let fits = self.form.show_length_check(ui);
        ui.add_space(6.0);
        self.proposals(ui);
        ui.add_space(4.0);
        let header = self.header.file_name().unwrap_or_default().to_string_lossy();
        let words = if self.has_header {
            text::raw::rewrite_header(&header)
        } else {
            text::raw::write_header(&header)
        };
        ui.checkbox(&mut self.writes_header, words).on_hover_text(text::raw::HEADER_TIP);
        ui.add_space(2.0);
        let mut answer = None;
        ui.horizontal(|ui| {
            let button = ui.add_enabled(fits, egui::Button::new(text::raw::OPEN));
            // Enter opens unless another button has the focus. A number that was being typed has been committed by
            // then.
            let is_free = ui.memory(egui::Memory::focused).is_none() && !egui::Popup::is_any_open(ui.ctx());
            let enter = fits && is_free && ui.input(|input| input.key_pressed(Key::Enter));
            if button.on_hover_text(text::raw::OPEN_TIP).clicked() || enter {
                answer = Some(RawDialogAnswer::Open);
            }
            if ui.button(text::common::CANCEL).clicked() {
                answer = Some(RawDialogAnswer::Cancel);
            }
        });
        answer
    }

    /// Shows the most likely layouts, each of which fills in the numbers when clicked.
    fn proposals(&mut self, ui: &mut egui::Ui) {
        ui.strong(text::raw::PROPOSALS);
        if self.analysis.is_busy() {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.weak(text::raw::ANALYSING);
            });
            return;
        }
        if let Some(why) = self.analysis.failure() {
            ui.colored_label(ui.visuals().error_fg_color, why);
            return;
        }
        let proposals = self.analysis.proposals();
        ui.weak(text::raw::confidence(proposals.first().map(|first| first.evidence)));
        let mut chosen: Option<LayoutProposal> = None;
        for proposal in proposals {
            let is_chosen = self.form.has_layout(&proposal.layout);
            let line = text::raw::layout_summary(&proposal.layout);
            let why =
                text::raw::evidence_summary(&proposal.evidence, &proposal.layout, self.analysis.length());
            if proposal_row(ui, is_chosen, &line, &why).clicked() {
                chosen = Some(*proposal);
            }
        }
        if let Some(proposal) = chosen {
            self.form.set_layout(&proposal.layout);
        }
    }

    fn into_description(self) -> RawDialogResult {
        RawDialogResult {
            layout: self.form.layout(),
            header: Some(self.header).filter(|_| self.writes_header),
            is_gzip: self.form.is_gzip(),
            path: self.path,
        }
    }
}

/// Shows a row of the list: a layout, and the evidence for it.
fn proposal_row(ui: &mut egui::Ui, is_chosen: bool, line: &str, why: &str) -> egui::Response {
    let style = ui.style();
    let color = if is_chosen { style.visuals.selection.stroke.color } else { style.visuals.text_color() };
    let weak = if is_chosen { color } else { style.visuals.weak_text_color() };
    let mut job = egui::text::LayoutJob::default();
    let format = |style_name: egui::TextStyle, color| egui::TextFormat {
        font_id: style_name.resolve(style),
        color,
        ..egui::TextFormat::default()
    };
    job.append(line, 0.0, format(egui::TextStyle::Body, color));
    job.append("\n", 0.0, format(egui::TextStyle::Small, weak));
    job.append(why, 0.0, format(egui::TextStyle::Small, weak));
    let button = egui::Button::selectable(is_chosen, job).min_size(egui::vec2(NUMBERS_WIDTH, 0.0));
    let response = ui.add(button);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, line));
    response
}

/// Path of the header beside a data file: `scan.raw.gz` has `scan.nhdr`.
fn header_path(path: &Path) -> PathBuf {
    let stem = |path: &Path| path.file_stem().map(PathBuf::from).unwrap_or_default();
    let mut name = stem(path);
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz")) {
        name = stem(&name);
    }
    path.with_file_name(format!("{}.nhdr", name.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_lie_beside_their_data() {
        for (data, header) in
            [("/a/scan.raw", "/a/scan.nhdr"), ("scan.raw.gz", "scan.nhdr"), ("b.c/scan", "b.c/scan.nhdr")]
        {
            assert_eq!(header_path(Path::new(data)), Path::new(header));
        }
    }
}
