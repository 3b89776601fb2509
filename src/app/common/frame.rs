//! What windows and menus over the main window share: where they may lie, and how they are left.

use eframe::egui::style::ScrollStyle;
use eframe::egui::{self, InnerResponse, Key, Modifiers, Order, Popup, Rect, Response, ScrollArea, Ui};

/// Height of the menu, which no window covers: whoever cannot reach it is stuck.
const MENU_HEIGHT: f32 = 26.0;

/// Where windows may lie: below the menu, and within the main window.
pub(in crate::app) fn room(ctx: &egui::Context) -> Rect {
    let mut room = ctx.content_rect();
    room.min.y += MENU_HEIGHT.min(room.height());
    room
}

/// Points above and below the rows of a menu, within its frame.
const MENU_MARGIN: f32 = 10.0;

/// A button that opens a menu, which scrolls where the window is too low for it: by wheel, by its bar, and to the row that
/// the keyboard leads to.
pub(in crate::app) fn scrolling_menu<R>(
    ui: &mut Ui,
    title: &str,
    add: impl FnOnce(&mut Ui) -> R,
) -> InnerResponse<Option<R>> {
    ui.menu_button(title, |ui| {
        // Nothing else says that there is more.
        ui.spacing_mut().scroll = ScrollStyle::solid();
        let height = room(ui.ctx()).height() - 2.0 * MENU_MARGIN;
        // As high as its rows, whatever the toolkit thinks that a window needs, and at most as the room; and as wide.
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

/// Scrolls to a widget among those that were just added that the keyboard has come to.
fn follow_focus(ui: &Ui) {
    let focused = ui.memory(egui::Memory::focused).and_then(|id| ui.ctx().read_response(id));
    if let Some(focused) = focused
        && focused.gained_focus()
        && focused.layer_id == ui.layer_id()
    {
        ui.scroll_to_rect(focused.rect, None);
    }
}

/// The tag of the probe, which lies below all windows and is none.
pub(in crate::app) const PROBE_TAG: &str = "tag";

/// The highest window.
fn highest(ctx: &egui::Context) -> Option<egui::LayerId> {
    let tag = egui::Id::unique(PROBE_TAG);
    ctx.memory(|memory| {
        let is_there = |layer: &egui::LayerId| {
            layer.order == Order::Middle && layer.id != tag && memory.areas().is_visible(layer)
        };
        memory.layer_ids().filter(is_there).last()
    })
}

/// Whether Escape is for the picture: no window is open, nothing is dragged, and nothing takes the key.
pub(in crate::app) fn is_for_picture(ctx: &egui::Context) -> bool {
    highest(ctx).is_none()
        && !Popup::is_any_open(ctx)
        && ctx.dragged_id().is_none()
        && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
}

/// Whether Escape closes a window that was just shown: it lies above all others, and nothing in it takes the key.
pub(in crate::app) fn is_left(ctx: &egui::Context, shown: Option<&Response>) -> bool {
    let Some(shown) = shown else { return false };
    highest(ctx) == Some(shown.layer_id)
        && !Popup::is_any_open(ctx)
        && ctx.dragged_id().is_none()
        && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
}
