//! Placement, scrolling and closing of windows and menus over the main window.

use eframe::egui::style::ScrollStyle;
use eframe::egui::{self, InnerResponse, Key, Modifiers, Order, Popup, Rect, Response, ScrollArea, Ui};

/// Height of the menu bar in points. No window covers it: a user who cannot reach it is stuck.
const MENU_HEIGHT: f32 = 26.0;

/// Area for windows: the main window below the menu bar.
pub(crate) fn window_area(ctx: &egui::Context) -> Rect {
    let mut room = ctx.content_rect();
    room.min.y += MENU_HEIGHT.min(room.height());
    room
}

/// Margin above and below the rows of a menu, within its frame, in points.
const MENU_MARGIN: f32 = 10.0;

/// Shows a button that opens a menu, which scrolls if the window is too low for it: by wheel, by scroll bar, and to
/// the row with the keyboard focus.
pub(crate) fn scrolling_menu<R>(
    ui: &mut Ui,
    title: &str,
    add: impl FnOnce(&mut Ui) -> R,
) -> InnerResponse<Option<R>> {
    ui.menu_button(title, |ui| {
        // Only a solid scroll bar shows that there is more.
        ui.spacing_mut().scroll = ScrollStyle::solid();
        let height = window_area(ui.ctx()).height() - 2.0 * MENU_MARGIN;
        // As high as its rows, whatever minimum the toolkit assumes, and at most as high as the area; as wide as its
        // rows.
        let scroll = ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        let shown = scroll.show(ui, |ui| {
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            let added = add(ui);
            follow_focus(ui);
            added
        });
        shown.inner
    })
}

/// Scrolls to a widget that was just added and has gained the keyboard focus.
fn follow_focus(ui: &Ui) {
    let focused = ui.memory(egui::Memory::focused).and_then(|id| ui.ctx().read_response(id));
    if let Some(focused) = focused
        && focused.gained_focus()
        && focused.layer_id == ui.layer_id()
    {
        ui.scroll_to_rect(focused.rect, None);
    }
}

/// Layer of the probe's tag, which lies below all windows and does not count as one.
pub(crate) const PROBE_TAG: &str = "tag";

/// Layer of the topmost window, if any is open.
fn topmost_window(ctx: &egui::Context) -> Option<egui::LayerId> {
    let tag = egui::Id::unique(PROBE_TAG);
    ctx.memory(|memory| {
        let is_there = |layer: &egui::LayerId| {
            layer.order == Order::Middle && layer.id != tag && memory.areas().is_visible(layer)
        };
        memory.layer_ids().filter(is_there).last()
    })
}

/// Consumes Escape for the picture and returns true, if no window or popup is open and nothing is dragged.
pub(crate) fn escape_for_picture(ctx: &egui::Context) -> bool {
    topmost_window(ctx).is_none()
        && !Popup::is_any_open(ctx)
        && ctx.dragged_id().is_none()
        && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
}

/// Consumes Escape for a window that was just shown and returns true, if the window is topmost, no popup is open and
/// nothing is dragged.
pub(crate) fn escape_closes(ctx: &egui::Context, shown: Option<&Response>) -> bool {
    let Some(shown) = shown else { return false };
    topmost_window(ctx) == Some(shown.layer_id)
        && !Popup::is_any_open(ctx)
        && ctx.dragged_id().is_none()
        && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
}
