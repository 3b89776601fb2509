//! A small handle beside that of a light: where the pointer takes hold of it, and where it is dragged to.

use eframe::egui::{self, Id, Pos2, Rect, Role, Sense, Ui, Vec2, WidgetInfo};

/// Points around a handle in which it can be grabbed, too.
const MARGIN: f32 = 3.0;

/// What the pointer does with a handle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grip {
    /// It is on it, or drags it.
    pub is_active: bool,
    pub is_dragged: bool,
    /// Where it is dragged to now.
    pub moved_to: Option<Pos2>,
}

/// Lets the pointer take hold of a handle, of half that edge, which readers know by a name.
pub(super) fn grip(ui: &Ui, at: Pos2, half_edge: f32, id: Id, name: &str) -> Grip {
    let area = Rect::from_center_size(at, Vec2::splat(2.0 * (half_edge + MARGIN)));
    let response = ui.interact(area, id, Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let is_dragged = response.dragged();
    let is_active = response.hovered() || is_dragged;
    if is_active {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
    }
    let pointer = response.interact_pointer_pos().filter(|_| is_dragged);
    let moved_to = pointer.filter(|_| ui.input(|input| input.pointer.delta()) != Vec2::ZERO);
    Grip { is_active, is_dragged, moved_to }
}
