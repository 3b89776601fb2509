//! What windows over the main one share: where they may lie, and how they are left.

use eframe::egui::{self, Key, Modifiers, Order, Popup, Rect, Response};

/// Height of the menu, which no window covers: whoever cannot reach it is stuck.
const MENU_HEIGHT: f32 = 26.0;

/// Where windows may lie: below the menu, and within the main window.
pub(in crate::app) fn room(ctx: &egui::Context) -> Rect {
    let mut room = ctx.content_rect();
    room.min.y += MENU_HEIGHT.min(room.height());
    room
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
