//! Tool windows: floating over the picture, or docked beside it without hiding anything.

use std::collections::BTreeSet;

use eframe::egui::{
    self, Align, CursorIcon, Id, LayerId, Layout, Panel, Rect, RichText, Sense, Stroke, Ui, UiBuilder, pos2,
    vec2,
};

use super::overlay_windows;
use super::theme;
use crate::app::text;

/// Default width of the dock, in points, until the user drags its border.
const WIDTH: f32 = 470.0;
/// Minimum width of the dock, in points, at which the narrowest tool is not cut.
const MIN_WIDTH: f32 = 240.0;
/// Width of the picture beside the widest dock, in points.
const MIN_PICTURE_BESIDE_WIDEST: f32 = 240.0;
/// Minimum width of the picture beside the narrowest dock, in points; below it, tools float over the picture.
const MIN_PICTURE: f32 = 160.0;
/// Height of a docked tool's header, in points.
const HEADER: f32 = 26.0;
/// Width of the toolkit's close button at the right end of a title bar, in points.
const CLOSE_BUTTON_WIDTH: f32 = 30.0;

/// State of the dock: the titles of the docked tools, and their layout.
#[derive(Debug, Clone, Default)]
struct DockState {
    docked: BTreeSet<String>,
    /// Docked tools shown in the previous frame, in order from the top.
    before: Vec<&'static str>,
    /// Docked tools shown so far in this frame, in order from the top.
    now: Vec<&'static str>,
    area: Option<Rect>,
    /// True while only the picture is shown.
    is_hidden: bool,
    /// True if the window is too narrow for a dock: tools float over the picture.
    is_too_narrow: bool,
    /// Maximum width of the dock, in points.
    room: f32,
}

fn change<R>(ctx: &egui::Context, change: impl FnOnce(&mut DockState) -> R) -> R {
    ctx.data_mut(|data| change(data.get_temp_mut_or_default(Id::unique("dock"))))
}

/// Returns the titles of the docked tools.
pub(crate) fn docked_titles(ctx: &egui::Context) -> BTreeSet<String> {
    change(ctx, |dock| dock.docked.clone())
}

/// Docks the tools that were docked in an earlier run.
pub(crate) fn set_docked(ctx: &egui::Context, titles: &BTreeSet<String>) {
    change(ctx, |dock| dock.docked.clone_from(titles));
}

/// Reserves space beside the picture, if a docked tool is open.
pub(crate) fn reserve_space(ui: &mut Ui) {
    let room = ui.available_width() - MIN_PICTURE_BESIDE_WIDEST;
    let is_too_narrow = ui.available_width() < MIN_WIDTH + MIN_PICTURE;
    let is_needed = change(ui.ctx(), |dock| {
        dock.before = std::mem::take(&mut dock.now);
        if is_too_narrow {
            dock.before.clear();
        }
        (dock.area, dock.is_hidden, dock.is_too_narrow, dock.room) = (None, false, is_too_narrow, room);
        !dock.before.is_empty()
    });
    if !is_needed {
        return;
    }
    let most = room.max(MIN_WIDTH);
    let panel = Panel::left("dock").resizable(true).default_size(WIDTH.min(most));
    let panel = panel.size_range(MIN_WIDTH..=most).frame(theme::panel(ui));
    let area = panel.show(ui, |ui| ui.allocate_rect(ui.available_rect_before_wrap(), Sense::hover()).rect);
    change(ui.ctx(), |dock| dock.area = Some(area.inner));
}

/// Hides the dock with its tools, while only the picture is shown.
pub(crate) fn hide(ctx: &egui::Context) {
    change(ctx, |dock| {
        dock.now.clear();
        (dock.area, dock.is_hidden) = (None, true);
    });
}

/// Tool window, identified by its title.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ToolWindow {
    /// Title of the tool, which also identifies it.
    pub title: &'static str,
    /// Initial position of the floating window, in points.
    pub default_pos: [f32; 2],
    /// Initial width of the floating window's contents, in points.
    pub default_width: f32,
}

impl ToolWindow {
    /// Shows the tool while it is open.
    pub(crate) fn show(self, ctx: &egui::Context, open: &mut bool, add: impl FnOnce(&mut Ui)) {
        self.show_as(ctx, open, false, add);
    }

    /// Shows a dialog while it is open: Escape closes it wherever the pointer is.
    pub(crate) fn show_dialog(self, ctx: &egui::Context, open: &mut bool, add: impl FnOnce(&mut Ui)) {
        self.show_as(ctx, open, true, add);
    }

    fn show_as(self, ctx: &egui::Context, open: &mut bool, is_dialog: bool, add: impl FnOnce(&mut Ui)) {
        if !*open {
            return;
        }
        if self.is_docked(ctx, is_dialog) {
            self.show_docked(ctx, open, is_dialog, add);
        } else {
            self.show_floating(ctx, open, self.can_dock(ctx, is_dialog), add);
        }
    }

    /// Returns true if a dialog floats over the picture, by choice or for lack of space.
    pub(crate) fn is_floating_dialog(&self, ctx: &egui::Context) -> bool {
        !self.is_docked(ctx, true)
    }

    fn is_docked(&self, ctx: &egui::Context, is_dialog: bool) -> bool {
        self.can_dock(ctx, is_dialog) && change(ctx, |dock| dock.docked.contains(self.title))
    }

    /// Returns true if the tool can be docked. A dialog needs its full width: cut rows would hide its buttons.
    fn can_dock(&self, ctx: &egui::Context, is_dialog: bool) -> bool {
        change(ctx, |dock| !dock.is_too_narrow && (!is_dialog || dock.room >= self.default_width))
    }

    fn show_floating(self, ctx: &egui::Context, open: &mut bool, can_dock: bool, add: impl FnOnce(&mut Ui)) {
        let window = egui::Window::new(self.title).open(open).collapsible(false).resizable(true);
        let window = window.constrain_to(overlay_windows::window_area(ctx)).default_pos(self.default_pos);
        let shown = window.default_width(self.default_width).show(ctx, add);
        let Some(shown) = shown else { return };
        *open &= !overlay_windows::escape_closes(ctx, Some(&shown.response));
        if !can_dock {
            return;
        }
        // Beside the close button of the window.
        let whole = shown.response.rect;
        let middle = pos2(whole.right() - CLOSE_BUTTON_WIDTH - 12.0, whole.top() + 0.5 * HEADER + 2.0);
        let builder = UiBuilder::new().layer_id(shown.response.layer_id).max_rect(whole);
        let ui = Ui::new(ctx.clone(), Id::unique((self.title, "title")), builder);
        if dock_button(
            &ui,
            Rect::from_center_size(middle, vec2(20.0, 18.0)),
            &text::dock::dock_name(self.title),
            true,
        ) {
            change(ctx, |dock| dock.docked.insert(self.title.to_owned()));
            ctx.request_repaint();
        }
    }

    fn show_docked(self, ctx: &egui::Context, open: &mut bool, is_dialog: bool, add: impl FnOnce(&mut Ui)) {
        if change(ctx, |dock| dock.is_hidden) {
            return;
        }
        let (area, at, count) = change(ctx, |dock| {
            dock.now.push(self.title);
            let at = dock.before.iter().position(|title| *title == self.title);
            (dock.area, at, dock.before.len())
        });
        let Some((area, at)) = area.zip(at) else {
            // The next frame reserves the space.
            return ctx.request_repaint();
        };
        let height = area.height() / count.max(1) as f32;
        let top = area.top() + at as f32 * height;
        let place =
            Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), height)).shrink2(vec2(2.0, 1.0));
        let builder = UiBuilder::new().layer_id(LayerId::background()).max_rect(place);
        let mut ui = Ui::new(ctx.clone(), Id::unique((self.title, "docked")), builder);
        ui.set_clip_rect(place);
        // It lies below all windows; Escape closes the tool under the pointer.
        if (is_dialog || ui.rect_contains_pointer(place)) && overlay_windows::escape_for_picture(ctx) {
            *open = false;
        }
        ui.horizontal(|ui| {
            ui.set_height(HEADER - 6.0);
            ui.label(RichText::new(self.title).strong());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.small_button(text::dock::CLOSE).clicked() {
                    *open = false;
                }
                let (rect, _) = ui.allocate_exact_size(vec2(20.0, 18.0), Sense::hover());
                if dock_button(ui, rect, &text::dock::undock_name(self.title), false) {
                    change(ctx, |dock| dock.docked.remove(self.title));
                    ctx.request_repaint();
                }
            });
        });
        ui.separator();
        let scroll = egui::ScrollArea::both().id_salt((self.title, "contents")).auto_shrink(false);
        scroll.show(&mut ui, add);
    }
}

/// Shows the icon of a window whose left part is filled (`docks`) or empty, as a button; returns true if it was
/// clicked.
fn dock_button(ui: &Ui, area: Rect, name: &str, docks: bool) -> bool {
    let response = ui.interact(area, ui.scope_id().with(("dock", docks)), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    let lit = response.hovered() || response.has_focus();
    let ink = if lit { theme::accent(ui.visuals()) } else { ui.visuals().weak_text_color() };
    let frame = Rect::from_center_size(area.center(), vec2(14.0, 11.0));
    let painter = ui.painter();
    painter.rect_stroke(frame, 2.0, Stroke::new(1.2, ink), egui::StrokeKind::Inside);
    if docks {
        let left = Rect::from_min_max(frame.min, pos2(frame.left() + 5.0, frame.bottom()));
        painter.rect_filled(left, 1.0, ink);
    }
    response.on_hover_text(name).on_hover_cursor(CursorIcon::PointingHand).clicked()
}
