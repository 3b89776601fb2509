//! Secondary handle of a light: hit test and drag.

use eframe::egui::{self, Id, Pos2, Rect, Role, Sense, Ui, Vec2, WidgetInfo};

/// Margin around a handle that also grabs it, in points.
const HIT_MARGIN: f32 = 3.0;

/// Pointer interaction with a handle in this frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct SmallHandleResponse {
    /// True if the pointer is on the handle or drags it.
    pub is_active: bool,
    pub is_dragged: bool,
    /// Position that the handle is dragged to in this frame, in points.
    pub moved_to: Option<Pos2>,
}

/// Interacts with a square handle of the given half edge in points, which screen readers know by `name`.
pub(super) fn interact_small_handle(
    ui: &Ui,
    at: Pos2,
    half_edge: f32,
    id: Id,
    name: &str,
) -> SmallHandleResponse {
    let area = Rect::from_center_size(at, Vec2::splat(2.0 * (half_edge + HIT_MARGIN)));
    let response = ui.interact(area, id, Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let is_dragged = response.dragged();
    let is_active = response.hovered() || is_dragged;
    if is_active {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
    }
    let pointer = response.interact_pointer_pos().filter(|_| is_dragged);
    let moved_to = pointer.filter(|_| ui.input(|input| input.pointer.delta()) != Vec2::ZERO);
    SmallHandleResponse { is_active, is_dragged, moved_to }
}
