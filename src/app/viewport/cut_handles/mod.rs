//! Handles for the crop box and the clip plane in the picture: the faces of the box are dragged along their axes, the
//! plane along its normal, and the normal is rotated by the tip of an arrow.

mod outline;

use eframe::egui::{
    Color32, CursorIcon, Id, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
};
use glam::DVec3;

use super::orbit::wheel_notches;
use super::view_projection::ViewProjection;
use crate::app::common::theme;
use crate::app::text;
use crate::math::SceneSpace;
use crate::model::{CropBox, MAX_PLANE_OFFSET, MIN_CROP, Settings};

/// Length of the clip plane's arrow, in scene units.
const ARROW: f64 = 0.35;
/// Displacement of the plane per notch of the wheel, in scene units: a hundredth of the volume's longest edge.
const OFFSET_PER_NOTCH: f64 = 0.02;
/// Half the edge length of a square handle, in points.
const SIDE: f32 = 5.5;

/// Drag in progress on one of the handles.
#[derive(Debug, Clone, Copy)]
struct Drag {
    id: Id,
    /// Offset from the pointer to the handle, in points.
    grip: Vec2,
    /// Centre of rotation of the plane in scene space, and whether its arrow points away from the eye.
    pivot: DVec3,
    behind: bool,
}

/// State of the cut handles between frames.
#[derive(Debug, Default)]
pub(crate) struct CutHandles {
    drag: Option<Drag>,
    /// True if the pointer is on the plane's handle, where the wheel moves the plane.
    pub takes_wheel: bool,
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
        self.takes_wheel = false;
        if hidden {
            return;
        }
        let view_projection = ViewProjection { camera: settings.camera.clone(), picture };
        let visible = ui.rect_contains_pointer(picture) || self.drag.is_some();
        let opacity = ui.ctx().animate_bool_with_time(Id::unique("cut handles"), visible, theme::FADE_S);
        let mut painter = ui.painter_at(picture);
        painter.multiply_opacity(opacity);
        if settings.cuts.crop.on {
            self.crop(ui, &painter, &view_projection, &mut settings.cuts.crop, scene);
        }
        if settings.cuts.plane.on {
            self.plane(ui, &painter, &view_projection, settings, scene);
        }
    }

    fn crop(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view_projection: &ViewProjection,
        crop: &mut CropBox,
        scene: &SceneSpace,
    ) {
        let stroke = Stroke::new(1.2, theme::ACCENT.gamma_multiply(0.75));
        for [a, b] in outline::edges(crop, scene) {
            if let (Some(a), Some(b)) = (view_projection.point(a), view_projection.point(b)) {
                painter.line_segment([a, b], stroke);
            }
        }
        for axis in 0..3 {
            for is_high in [false, true] {
                let (at, along) = outline::side(crop, scene, axis, is_high);
                let Some(position) = view_projection.point(at) else { continue };
                let name = text::cut_handles::crop_side(axis, is_high);
                let id = Id::unique("crop side").with((axis, is_high));
                // Handles of faces outside the picture are clamped to its border.
                let waits = within(painter.clip_rect(), position);
                let (response, to) = self.interact(ui, id, &name, waits, DVec3::ZERO, false);
                if let Some(to) = to
                    && let Some(share) = view_projection.along(to + (position - waits), at, along)
                {
                    let (low, high) = (crop.low[axis], crop.high[axis]);
                    if is_high {
                        crop.high[axis] = (high + share).clamp(low + MIN_CROP, 1.0);
                    } else {
                        crop.low[axis] = (low + share).clamp(0.0, high - MIN_CROP);
                    }
                }
                let now =
                    view_projection.point(outline::side(crop, scene, axis, is_high).0).unwrap_or(position);
                square(painter, within(painter.clip_rect(), now), &response);
            }
        }
    }

    fn plane(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view_projection: &ViewProjection,
        settings: &mut Settings,
        scene: &SceneSpace,
    ) {
        let section = outline::section(&settings.cuts.plane, scene);
        let border: Vec<Pos2> = section.iter().filter_map(|&corner| view_projection.point(corner)).collect();
        if border.len() == section.len() {
            let stroke = Stroke::new(1.2, theme::ACCENT.gamma_multiply(0.75));
            painter.add(Shape::closed_line(border, stroke));
        }
        let plane = &mut settings.cuts.plane;
        let normal = plane.unit_normal();
        let middle = outline::middle(&section, plane);
        let tip = middle + normal * ARROW;
        let (Some(at), Some(end)) = (view_projection.point(middle), view_projection.point(tip)) else {
            return;
        };
        let to_eye = view_projection.camera.scene_from_view().z_axis;
        let behind = normal.dot(to_eye) < 0.0;

        // The tip comes first, so that where both handles overlap, the plane is moved.
        let id = Id::unique("plane tip");
        let (turned, to) = self.interact(ui, id, text::cut_handles::PLANE_DIRECTION, end, middle, behind);
        if let (Some(to), Some(drag)) = (to, self.drag) {
            let (origin, direction) = view_projection.ray(to);
            let normal = towards_sphere(origin - drag.pivot, direction, ARROW, drag.behind);
            plane.normal = normal.into();
            plane.offset = normal.dot(drag.pivot);
        }
        let id = Id::unique("plane middle");
        let (moved, to) = self.interact(ui, id, text::cut_handles::PLANE_PLACE, at, middle, behind);
        if let Some(to) = to
            && let Some(distance) = view_projection.along(to, middle, normal)
        {
            plane.offset += distance;
        }
        // The wheel moves the plane along its normal, whether it is seen edge-on or face-on.
        if moved.hovered() || moved.dragged() {
            self.takes_wheel = true;
            plane.offset += wheel_notches(ui) * OFFSET_PER_NOTCH;
        }
        plane.offset = plane.offset.clamp(-MAX_PLANE_OFFSET, MAX_PLANE_OFFSET);
        let middle = outline::middle(&outline::section(plane, scene), plane);
        let tip = middle + plane.unit_normal() * ARROW;
        if let (Some(at), Some(end)) = (view_projection.point(middle), view_projection.point(tip)) {
            arrow(painter, at, end);
            square(painter, at, &moved);
            knob(painter, end, &turned, behind);
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
            self.drag = Some(Drag { id, grip: position - pressed, pivot, behind });
        }
        let drag = self.drag.filter(|drag| drag.id == id);
        if drag.is_some() && !response.dragged() {
            self.drag = None;
        }
        let moves = response.dragged() && ui.input(|input| input.pointer.delta()) != Vec2::ZERO;
        let to = drag.zip(pointer).filter(|_| moves).map(|(drag, pointer)| pointer + drag.grip);
        (response, to)
    }
}

/// Clamps the position of a handle to the picture, inset so that it can be grabbed.
fn within(picture: Rect, position: Pos2) -> Pos2 {
    let room = picture.shrink(theme::HANDLE_INSET);
    if room.is_positive() { room.clamp(position) } else { position }
}

/// Intersects a viewing ray with a sphere around the origin and returns the direction of the hit from its centre; for
/// a ray that misses the sphere, the direction of the nearest point on the ray.
fn towards_sphere(origin: DVec3, direction: DVec3, radius: f64, behind: bool) -> DVec3 {
    let nearest = origin - direction * origin.dot(direction);
    let half_chord = (radius * radius - nearest.length_squared()).max(0.0).sqrt();
    let sign = if behind { 1.0 } else { -1.0 };
    (nearest + direction * (sign * half_chord)).normalize_or(-direction)
}

/// Returns the half size and the colour of a handle: it grows and brightens under the pointer.
fn look(response: &Response) -> (f32, Color32) {
    if response.hovered() || response.dragged() {
        (SIDE + 1.5, theme::EYE_CURVE)
    } else {
        (SIDE, theme::ACCENT)
    }
}

/// Paints a square handle, which is dragged along an axis.
fn square(painter: &Painter, at: Pos2, response: &Response) {
    let (half, ink) = look(response);
    painter.rect_filled(Rect::from_center_size(at, Vec2::splat(2.0 * half + 3.0)), 2.0, theme::OUTLINE);
    painter.rect_filled(Rect::from_center_size(at, Vec2::splat(2.0 * half)), 1.5, ink);
}

/// Paints a round handle, which rotates the plane; hollow where it points away from the eye.
fn knob(painter: &Painter, at: Pos2, response: &Response, hollow: bool) {
    let (radius, ink) = look(response);
    painter.circle_filled(at, radius + 1.5, theme::OUTLINE);
    if hollow {
        painter.circle_stroke(at, radius - 1.0, Stroke::new(2.0, ink));
    } else {
        painter.circle_filled(at, radius, ink);
    }
}

fn arrow(painter: &Painter, from: Pos2, to: Pos2) {
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
        let front = towards_sphere(origin, DVec3::NEG_Z, 0.35, false);
        assert!((front * 0.35 - DVec3::new(0.1, 0.0, 0.11_f64.sqrt() * 1.011)).length() < 0.01, "{front}");
        assert!(towards_sphere(origin, DVec3::NEG_Z, 0.35, true).z < 0.0);
        let beside = towards_sphere(DVec3::new(3.0, 4.0, 5.0), DVec3::NEG_Z, 0.35, false);
        assert!((beside - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-9, "{beside}");
    }
}
