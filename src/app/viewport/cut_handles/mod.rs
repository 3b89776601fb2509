//! Handles for the crop box and the clip plane in the picture: the faces of the box are dragged along their axes, the
//! plane along its normal, and the normal is rotated by the tip of an arrow. [`shape_tool`] cuts by shapes.

mod geometry;
mod part_highlight;
pub(crate) mod shape_tool;

use eframe::egui::{
    Color32, CursorIcon, Id, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
};
use glam::DVec3;

use super::mouse_navigation::wheel_notches;
use super::view_projection::ViewProjection;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{CropBox, MAX_PLANE_OFFSET, MIN_CROP_EXTENT, Settings};
use chiaroscuro_volume::math::SceneSpace;

/// Length of the clip plane's arrow, in scene units.
const PLANE_ARROW_LENGTH: f64 = 0.35;
/// Displacement of the plane per notch of the wheel, in scene units: a hundredth of the volume's longest edge.
const OFFSET_PER_NOTCH: f64 = 0.02;
/// Half the edge length of a square handle, in points.
const SQUARE_HANDLE_HALF_EDGE: f32 = 5.5;

/// Drag in progress on one of the handles.
#[derive(Debug, Clone, Copy)]
struct CutHandleDrag {
    id: Id,
    /// Offset from the pointer to the handle, in points.
    pointer_offset: Vec2,
    /// Centre of rotation of the plane in scene space, and whether its arrow points away from the eye.
    pivot: DVec3,
    is_behind: bool,
}

/// State of the cut handles between frames.
#[derive(Debug, Default)]
pub(crate) struct CutHandles {
    drag: Option<CutHandleDrag>,
    /// True if the pointer is on the plane's handle, where the wheel moves the plane.
    pub captures_wheel: bool,
}

impl CutHandles {
    /// Shows the handles of the active cuts, lets the user drag them, and changes the cuts.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        picture: Rect,
        settings: &mut Settings,
        scene: &SceneSpace,
        hidden: bool,
    ) {
        self.captures_wheel = false;
        if hidden {
            return;
        }
        let view_projection = ViewProjection { camera: settings.camera.clone(), picture };
        let visible = ui.rect_contains_pointer(picture) || self.drag.is_some();
        let opacity = ui.ctx().animate_bool_with_time(Id::unique("cut handles"), visible, theme::FADE_S);
        let mut painter = ui.painter_at(picture);
        painter.multiply_opacity(opacity);
        if settings.cuts.crop.on {
            self.show_crop_handles(ui, &painter, &view_projection, &mut settings.cuts.crop, scene);
        }
        if settings.cuts.plane.on {
            self.show_plane_handles(ui, &painter, &view_projection, settings, scene);
        }
    }

    fn show_crop_handles(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view_projection: &ViewProjection,
        crop: &mut CropBox,
        scene: &SceneSpace,
    ) {
        let stroke = Stroke::new(1.2, theme::ACCENT.gamma_multiply(0.75));
        for [a, b] in geometry::crop_edges(crop, scene) {
            if let (Some(a), Some(b)) = (view_projection.project(a), view_projection.project(b)) {
                painter.line_segment([a, b], stroke);
            }
        }
        for axis in 0..3 {
            for is_high in [false, true] {
                let (at, along) = geometry::crop_face(crop, scene, axis, is_high);
                let Some(position) = view_projection.project(at) else { continue };
                let name = text::cut_handles::crop_side(axis, is_high);
                let id = Id::unique("crop side").with((axis, is_high));
                // Handles of faces outside the picture are clamped to its border.
                let waits = clamp_to_picture(painter.clip_rect(), position);
                let (response, to) = self.interact(ui, id, &name, waits, DVec3::ZERO, false);
                if let Some(to) = to
                    && let Some(share) = view_projection.nearest_on_line(to + (position - waits), at, along)
                {
                    let (low, high) = (crop.low[axis], crop.high[axis]);
                    if is_high {
                        crop.high[axis] = (high + share).clamp(low + MIN_CROP_EXTENT, 1.0);
                    } else {
                        crop.low[axis] = (low + share).clamp(0.0, high - MIN_CROP_EXTENT);
                    }
                }
                let now = view_projection
                    .project(geometry::crop_face(crop, scene, axis, is_high).0)
                    .unwrap_or(position);
                paint_square_handle(painter, clamp_to_picture(painter.clip_rect(), now), &response);
            }
        }
    }

    fn show_plane_handles(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view_projection: &ViewProjection,
        settings: &mut Settings,
        scene: &SceneSpace,
    ) {
        let section = geometry::plane_section(&settings.cuts.plane, scene);
        let border: Vec<Pos2> =
            section.iter().filter_map(|&corner| view_projection.project(corner)).collect();
        if border.len() == section.len() {
            let stroke = Stroke::new(1.2, theme::ACCENT.gamma_multiply(0.75));
            painter.add(Shape::closed_line(border, stroke));
        }
        let plane = &mut settings.cuts.plane;
        let normal = plane.unit_normal();
        let middle = geometry::plane_handle_position(&section, plane);
        let tip = middle + normal * PLANE_ARROW_LENGTH;
        let (Some(at), Some(end)) = (view_projection.project(middle), view_projection.project(tip)) else {
            return;
        };
        let to_eye = view_projection.camera.scene_from_view().z_axis;
        let behind = normal.dot(to_eye) < 0.0;

        // The tip comes first, so that where both handles overlap, the plane is moved.
        let id = Id::unique("plane tip");
        let (turned, to) = self.interact(ui, id, text::cut_handles::PLANE_DIRECTION, end, middle, behind);
        if let (Some(to), Some(drag)) = (to, self.drag) {
            let (origin, direction) = view_projection.ray(to);
            let normal =
                direction_to_sphere_hit(origin - drag.pivot, direction, PLANE_ARROW_LENGTH, drag.is_behind);
            plane.normal = normal.into();
            plane.offset = normal.dot(drag.pivot);
        }
        let id = Id::unique("plane middle");
        let (moved, to) = self.interact(ui, id, text::cut_handles::PLANE_POSITION, at, middle, behind);
        if let Some(to) = to
            && let Some(distance) = view_projection.nearest_on_line(to, middle, normal)
        {
            plane.offset += distance;
        }
        // The wheel moves the plane along its normal, whether it is seen edge-on or face-on.
        if moved.hovered() || moved.dragged() {
            self.captures_wheel = true;
            plane.offset += wheel_notches(ui) * OFFSET_PER_NOTCH;
        }
        plane.offset = plane.offset.clamp(-MAX_PLANE_OFFSET, MAX_PLANE_OFFSET);
        let middle = geometry::plane_handle_position(&geometry::plane_section(plane, scene), plane);
        let tip = middle + plane.unit_normal() * PLANE_ARROW_LENGTH;
        if let (Some(at), Some(end)) = (view_projection.project(middle), view_projection.project(tip)) {
            paint_arrow(painter, at, end);
            paint_square_handle(painter, at, &moved);
            paint_round_handle(painter, end, &turned, behind);
        }
    }

    /// Interacts with one handle. Returns the response, and while it is dragged, the new position in points.
    fn interact(
        &mut self,
        ui: &Ui,
        id: Id,
        name: &str,
        position: Pos2,
        pivot: DVec3,
        behind: bool,
    ) -> (Response, Option<Pos2>) {
        let area = Rect::from_center_size(position, Vec2::splat(2.0 * theme::HANDLE_RADIUS + 4.0));
        let response = ui.interact(area, id, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        let pointer = response.interact_pointer_pos();
        if response.drag_started()
            && let Some(pointer) = pointer
        {
            // From where the button was pressed: egui reports a drag only some points later.
            let pressed = ui.input(|input| input.pointer.press_origin()).unwrap_or(pointer);
            self.drag =
                Some(CutHandleDrag { id, pointer_offset: position - pressed, pivot, is_behind: behind });
        }
        let drag = self.drag.filter(|drag| drag.id == id);
        if drag.is_some() && !response.dragged() {
            self.drag = None;
        }
        let moves = response.dragged() && ui.input(|input| input.pointer.delta()) != Vec2::ZERO;
        let to = drag.zip(pointer).filter(|_| moves).map(|(drag, pointer)| pointer + drag.pointer_offset);
        (response, to)
    }
}

/// Clamps the position of a handle to the picture, inset so that it can be grabbed.
fn clamp_to_picture(picture: Rect, position: Pos2) -> Pos2 {
    let room = picture.shrink(theme::HANDLE_INSET);
    if room.is_positive() { room.clamp(position) } else { position }
}

/// Intersects a viewing ray with a sphere around the origin and returns the direction of the hit from its centre; for
/// a ray that misses the sphere, the direction of the nearest point on the ray.
fn direction_to_sphere_hit(origin: DVec3, direction: DVec3, radius: f64, behind: bool) -> DVec3 {
    let nearest = origin - direction * origin.dot(direction);
    let half_chord = (radius * radius - nearest.length_squared()).max(0.0).sqrt();
    let sign = if behind { 1.0 } else { -1.0 };
    (nearest + direction * (sign * half_chord)).normalize_or(-direction)
}

/// Returns the half size and the colour of a handle: it grows and brightens under the pointer.
fn handle_style(response: &Response) -> (f32, Color32) {
    if response.hovered() || response.dragged() {
        (SQUARE_HANDLE_HALF_EDGE + 1.5, theme::PICTURE_TEXT)
    } else {
        (SQUARE_HANDLE_HALF_EDGE, theme::ACCENT)
    }
}

/// Paints a square handle, which is dragged along an axis.
fn paint_square_handle(painter: &Painter, at: Pos2, response: &Response) {
    let (half, ink) = handle_style(response);
    painter.rect_filled(Rect::from_center_size(at, Vec2::splat(2.0 * half + 3.0)), 2.0, theme::OUTLINE);
    painter.rect_filled(Rect::from_center_size(at, Vec2::splat(2.0 * half)), 1.5, ink);
}

/// Paints a round handle, which rotates the plane; hollow where it points away from the eye.
fn paint_round_handle(painter: &Painter, at: Pos2, response: &Response, hollow: bool) {
    let (radius, ink) = handle_style(response);
    painter.circle_filled(at, radius + 1.5, theme::OUTLINE);
    if hollow {
        painter.circle_stroke(at, radius - 1.0, Stroke::new(2.0, ink));
    } else {
        painter.circle_filled(at, radius, ink);
    }
}

fn paint_arrow(painter: &Painter, from: Pos2, to: Pos2) {
    for (width, color) in [(4.0, theme::OUTLINE), (1.8, theme::ACCENT)] {
        painter.line_segment([from, to], Stroke::new(width, color));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_are_turned_by_their_tip() {
        let origin = DVec3::new(0.1, 0.0, 5.0);
        let front = direction_to_sphere_hit(origin, DVec3::NEG_Z, 0.35, false);
        assert!((front * 0.35 - DVec3::new(0.1, 0.0, 0.11_f64.sqrt() * 1.011)).length() < 0.01, "{front}");
        assert!(direction_to_sphere_hit(origin, DVec3::NEG_Z, 0.35, true).z < 0.0);
        let beside = direction_to_sphere_hit(DVec3::new(3.0, 4.0, 5.0), DVec3::NEG_Z, 0.35, false);
        assert!((beside - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-9, "{beside}");
    }
}
