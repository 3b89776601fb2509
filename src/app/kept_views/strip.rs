//! Strip of thumbnails of kept views and looks: a click goes to an item, a drag moves it, and the context menu has
//! the rest.

use eframe::egui::{
    self, Align, Align2, FontId, Key, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};

use super::thumbnails::{KeptThumbnails, thumbnail_size};
use crate::app::common::commands::AppCommand;
use crate::app::common::{shortcuts, theme};
use crate::app::text::{self, ControlText};
use crate::app::windows::export::ExportScene;
use chiaroscuro_scene::{DIGIT_KEYS, MAX_NAME_CHARS, SavedContent, SavedEntry, Settings};

/// Height of a thumbnail, in points.
const THUMBNAIL_HEIGHT: f32 = 72.0;
/// Height of the name below a thumbnail, in points.
const NAME_HEIGHT: f32 = 18.0;

/// State of the strip between frames.
#[derive(Debug, Default)]
pub(crate) struct KeptStrip {
    pub(super) thumbnails: KeptThumbnails,
    /// Index of the item that is being dragged.
    dragged_item: Option<usize>,
    /// Indices of the items marked for comparison, at most two, the latest last.
    marked_items: Vec<usize>,
}

/// Action of the user on an item.
enum KeptItemAction {
    Apply,
    Mark,
    Move(usize),
    Remove,
}

fn button(ui: &mut Ui, ControlText { name, tooltip: tip }: ControlText) -> bool {
    ui.button(name).on_hover_text(tip).clicked()
}

impl KeptStrip {
    /// Forgets all thumbnails, and stops the thread that renders them: another volume is shown, or the window closes.
    pub(crate) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Collects the thumbnails that have been rendered since the last call.
    pub(crate) fn collect_thumbnails(&mut self, ctx: &egui::Context) {
        self.thumbnails.collect(ctx);
    }

    /// Returns the items that have no thumbnail yet; `None` if there are none, or while some are being rendered.
    pub(crate) fn missing_thumbnails(
        &mut self,
        settings: &Settings,
        content_id: Option<u64>,
    ) -> Option<Vec<SavedContent>> {
        self.thumbnails.missing(settings, content_id)
    }

    /// Starts to render thumbnails. Views are drawn in the current look.
    pub(crate) fn render_thumbnails(
        &mut self,
        wanted: Vec<SavedContent>,
        subject: ExportScene,
        ctx: &egui::Context,
    ) {
        if let Err(err) = self.thumbnails.start(wanted, subject, ctx) {
            log::warn!("thumbnails of saved views and looks cannot be rendered: {err}");
        }
    }

    /// Shows the strip below the picture.
    pub(crate) fn show(&mut self, ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<AppCommand>) {
        // The list may have changed since the last frame, for example by undo.
        self.dragged_item = self.dragged_item.filter(|&at| at < settings.kept.len());
        let panel = egui::Panel::bottom("kept").resizable(false).frame(theme::panel(ui));
        panel.exact_size(THUMBNAIL_HEIGHT + NAME_HEIGHT + 22.0).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| self.buttons(ui, settings, commands));
                ui.separator();
                if settings.kept.is_empty() {
                    ui.add(egui::Label::new(egui::RichText::new(text::saved_views::NOTHING).weak()).wrap());
                    self.dragged_item = None;
                    return;
                }
                let area = egui::ScrollArea::horizontal().auto_shrink(false);
                area.show(ui, |ui| ui.horizontal_top(|ui| self.items(ui, settings, commands)));
            });
        });
    }

    fn buttons(&self, ui: &mut Ui, settings: &Settings, commands: &mut Vec<AppCommand>) {
        ui.set_width(104.0);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            if button(ui, text::saved_views::SAVE_VIEW) {
                commands.push(AppCommand::SaveView);
            }
            if button(ui, text::saved_views::SAVE_LOOK) {
                commands.push(AppCommand::SaveLookInStrip);
            }
        });
        let is_some = !settings.kept.is_empty();
        let ControlText { name, tooltip: tip } = text::saved_views::SHEET;
        if ui.add_enabled(is_some, egui::Button::new(name)).on_hover_text(tip).clicked() {
            commands.push(AppCommand::ExportContactSheet);
        }
        if button(ui, text::saved_views::CLOSE) {
            commands.push(AppCommand::ToggleStrip);
        }
        if self.thumbnails.is_busy() {
            ui.horizontal(|ui| {
                ui.spinner();
                let left = settings.kept.iter().filter(|kept| self.thumbnails.get(kept).is_none()).count();
                ui.weak(text::saved_views::thumbnails_left(left));
            });
        }
    }

    fn items(&mut self, ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<AppCommand>) {
        self.marked_items.retain(|&at| at < settings.kept.len());
        let mut action = None;
        let mut item_rects = Vec::new();
        for at in 0..settings.kept.len() {
            let response = self.item(ui, at, &settings.kept[at]);
            item_rects.push(response.rect);
            if response.clicked() {
                let marks = ui.input(|input| input.modifiers.command);
                action = Some((at, if marks { KeptItemAction::Mark } else { KeptItemAction::Apply }));
            }
            if response.drag_started() {
                self.dragged_item = Some(at);
            }
            response.context_menu(|ui| {
                if let Some(chosen) = item_menu(ui, at, settings, commands) {
                    action = Some((at, chosen));
                }
            });
        }
        if let Some(from) = self.dragged_item {
            let to = insertion_index(ui, &item_rects);
            if let (Some(to), true) = (to, ui.input(|input| input.pointer.any_down())) {
                let x = item_rects.get(to).map_or_else(
                    || item_rects.last().map_or(0.0, |rect| rect.right() + 3.0),
                    |rect| rect.left() - 3.0,
                );
                let rows = item_rects[0].y_range();
                ui.painter().vline(x, rows, Stroke::new(2.0, theme::ACCENT));
            } else {
                self.dragged_item = None;
                action = to.map(|to| (from, KeptItemAction::Move(to)));
            }
        }
        match action {
            None => {}
            Some((at, KeptItemAction::Apply)) => commands.push(AppCommand::GoToSaved(at, false)),
            Some((at, KeptItemAction::Mark)) => self.mark(at, commands),
            Some((from, KeptItemAction::Move(to))) => {
                self.marked_items.clear();
                let kept = settings.kept.remove(from);
                settings.kept.insert(if to > from { to - 1 } else { to }, kept);
            }
            Some((at, KeptItemAction::Remove)) => {
                self.marked_items.clear();
                settings.kept.remove(at);
            }
        }
    }

    /// Shows one item: its thumbnail, digit, swatch and name.
    fn item(&self, ui: &mut Ui, at: usize, kept: &SavedEntry) -> Response {
        let size = thumbnail_size(THUMBNAIL_HEIGHT);
        let (whole, response) =
            ui.allocate_exact_size(size + vec2(0.0, NAME_HEIGHT), Sense::click_and_drag());
        let is_look = kept.as_look().is_some();
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Button, true, text::saved_views::thumbnail_name(&kept.name))
        });
        let picture = Rect::from_min_size(whole.min, size);
        let painter = ui.painter_at(whole.expand(3.0));
        painter.rect_filled(picture, 3.0, theme::EMPTY_CANVAS);
        if let Some(texture) = self.thumbnails.get(kept) {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture.id(), picture, all, egui::Color32::WHITE);
        }
        // A look has a swatch of its colours; a view has none.
        if let Some(look) = kept.as_look() {
            let dots = look.layer().transfer.points.iter().rev().take(3).map(|point| point.color);
            for (number, color) in (0..).zip(dots) {
                let middle = picture.left_bottom() + vec2(9.0 + 10.0 * number as f32, -9.0);
                painter.circle(middle, 4.0, theme::color(color), Stroke::new(1.0, theme::OUTLINE));
            }
        }
        if let Some(digit) = kept.digit {
            let corner = Rect::from_min_size(picture.min + vec2(3.0, 3.0), vec2(14.0, 14.0));
            painter.rect_filled(corner, 3.0, theme::OUTLINE.gamma_multiply(0.8));
            let font = FontId::proportional(11.0);
            painter.text(
                corner.center(),
                Align2::CENTER_CENTER,
                digit.to_string(),
                font,
                theme::PICTURE_TEXT,
            );
        }
        let is_marked = self.marked_items.contains(&at);
        if is_marked || response.hovered() || response.has_focus() {
            let ink = if is_marked { theme::ACCENT } else { theme::GUIDE };
            painter.rect_stroke(
                picture,
                3.0,
                Stroke::new(if is_marked { 2.5 } else { 1.5 }, ink),
                StrokeKind::Inside,
            );
        }
        let mut row = ui.new_child(
            egui::UiBuilder::new()
                .max_rect(Rect::from_min_max(picture.left_bottom(), whole.max))
                .layout(egui::Layout::top_down(Align::Center)),
        );
        row.add(egui::Label::new(egui::RichText::new(&kept.name).small()).truncate().selectable(false));
        response.on_hover_text(text::saved_views::tooltip(&kept.name, is_look, kept.digit))
    }

    /// Marks or unmarks an item; when two are marked, they are compared.
    fn mark(&mut self, at: usize, commands: &mut Vec<AppCommand>) {
        if let Some(known) = self.marked_items.iter().position(|&marked| marked == at) {
            self.marked_items.remove(known);
            return;
        }
        if self.marked_items.len() == 2 {
            self.marked_items.remove(0);
        }
        self.marked_items.push(at);
        if let [left, right] = self.marked_items[..] {
            commands.push(AppCommand::CompareSaved(Some(left), right));
        }
    }
}

/// Shows the context menu of an item, and returns the action that was chosen.
fn item_menu(
    ui: &mut Ui,
    at: usize,
    settings: &mut Settings,
    commands: &mut Vec<AppCommand>,
) -> Option<KeptItemAction> {
    shortcuts::reserve_letters(ui.ctx());
    let mut act = None;
    let mut close = false;
    let taken: Vec<_> = settings.kept.iter().filter_map(|kept| kept.digit).collect();
    let kept = settings.kept.get_mut(at)?;
    let is_look = kept.as_look().is_some();
    ui.horizontal(|ui| {
        let label = ui.label(text::saved_views::NAME);
        let field =
            egui::TextEdit::singleline(&mut kept.name).char_limit(MAX_NAME_CHARS).desired_width(170.0);
        let response = ui.add(field).labelled_by(label.id);
        close |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 1.0;
        ui.label(text::saved_views::DIGIT);
        for digit in DIGIT_KEYS {
            let is_free = kept.digit == Some(digit) || !taken.contains(&digit);
            let is_own = kept.digit == Some(digit);
            let choice = ui.add_enabled(is_free, egui::Button::selectable(is_own, digit.to_string()));
            if choice.on_hover_text(text::saved_views::shortcut(digit)).clicked() {
                kept.digit = (!is_own).then_some(digit);
            }
        }
    });
    ui.separator();
    if is_look && button(ui, text::saved_views::WITH_VIEW) {
        commands.push(AppCommand::GoToSaved(at, true));
        close = true;
    }
    if button(ui, text::saved_views::REPLACE) {
        commands.push(AppCommand::ReplaceSaved(at));
        close = true;
    }
    if button(ui, text::saved_views::COMPARE) {
        commands.push(AppCommand::CompareSaved(None, at));
        close = true;
    }
    if button(ui, text::saved_views::MARK) {
        act = Some(KeptItemAction::Mark);
        close = true;
    }
    ui.separator();
    if button(ui, text::saved_views::REMOVE) {
        act = Some(KeptItemAction::Remove);
        close = true;
    }
    if close {
        ui.close();
    }
    act
}

/// Gap between items at the pointer, as the number of items before it; `None` without a pointer.
fn insertion_index(ui: &Ui, places: &[Rect]) -> Option<usize> {
    let x = ui.input(|input| input.pointer.interact_pos())?.x;
    Some(places.iter().filter(|rect| rect.center().x < x).count())
}
