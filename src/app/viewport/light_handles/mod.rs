//! Light handles: discs in the picture by which lights are dragged.
//!
//! The handle of a parallel light lies on a sphere around the volume and turns like a trackball; the handle of a
//! perspective light lies at the light's position and moves in the plane that faces the eye. The window paints
//! handles over the picture, so they never appear in an export.

mod geometry;
mod guides;
mod size_handle;
mod small_handle;
mod spotlight_handle;

use eframe::egui::{self, Color32, Id, Pos2, Rect, Response, Role, Sense, Stroke, Vec2, WidgetInfo};

use self::geometry::LightHandleView;
use self::size_handle::{DraggedLightSize, SizeHandle};
use self::spotlight_handle::SpotlightHandle;
use super::mouse_navigation::wheel_notches;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{LightGeometry, Settings};

/// Drag in progress of a light's handle.
#[derive(Debug, Clone, Copy)]
struct LightHandleDrag {
    light: usize,
    /// True if the handle was on the far side of its sphere.
    is_behind: bool,
    /// Offset from the pointer to the handle, in points.
    pointer_offset: Vec2,
}

/// State of the light handles between frames.
#[derive(Debug, Default)]
pub(crate) struct LightHandles {
    /// True if the user has switched the handles off.
    pub is_hidden: bool,
    drag: Option<LightHandleDrag>,
    /// Spotlight handle of the selected light.
    spotlight_handle: SpotlightHandle,
    /// Size handle of the selected light, if it is an area light.
    size_handle: SizeHandle,
    /// True if the pointer is on a handle for which the wheel changes the distance.
    pub captures_wheel: bool,
    /// Positions of the handles in the last frame, in points.
    positions: Vec<Pos2>,
}

impl LightHandles {
    /// Positions of the handles, in points; empty while hidden.
    pub(crate) fn positions(&self) -> &[Pos2] {
        &self.positions
    }

    /// Clears the state that belongs to one frame.
    pub(crate) fn clear_frame_state(&mut self) {
        self.positions.clear();
        self.captures_wheel = false;
    }

    /// Shows the handles, lets the user drag them, and moves the lights.
    pub(crate) fn show(
        &mut self,
        ui: &egui::Ui,
        picture: Rect,
        settings: &mut Settings,
        support_radius: f64,
        selected: &mut usize,
    ) {
        self.clear_frame_state();
        if self.is_hidden {
            return;
        }
        let view = LightHandleView::new(settings.camera.clone(), picture, support_radius);
        let hovered = ui.rect_contains_pointer(picture);
        let visible = hovered || self.drag.is_some();
        let opacity = ui.ctx().animate_bool_with_time(Id::unique("light handles"), visible, theme::FADE_S);
        let mut painter = ui.painter_at(picture);
        painter.multiply_opacity(opacity);
        for light in 0..settings.lights.len() {
            if !settings.lights[light].on {
                continue;
            }
            let seen = |settings: &Settings| view.handle(&settings.lights[light].resolve(&settings.camera));
            let Some(handle) = seen(settings) else { continue };
            let area = Rect::from_center_size(handle.position, Vec2::splat(2.0 * theme::HANDLE_RADIUS + 6.0));
            let response = ui.interact(area, Id::unique("light handle").with(light), Sense::click_and_drag());
            let name = text::lights::handle(&settings.lights[light].name);
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            self.handle_drag(ui, &response, &view, &handle, light, settings, selected);
            let active = response.hovered() || self.drag.is_some_and(|drag| drag.light == light);
            let handle = seen(settings).unwrap_or(handle);
            self.positions.push(handle.position);
            let scene_light = settings.lights[light].resolve(&settings.camera);
            if active
                || (*selected == light && (self.spotlight_handle.is_active() || self.size_handle.is_active()))
            {
                let up = settings.camera.up.direction();
                guides::paint_guides(&painter, &view, &scene_light, up, settings.floor.height);
            }
            if *selected == light
                && let Some(half_angle_deg) = self.spotlight_handle.show(
                    ui,
                    &painter,
                    &view,
                    &scene_light,
                    &settings.lights[light].name,
                    light,
                )
            {
                settings.lights[light].hood.half_angle_deg = half_angle_deg;
            }
            if *selected == light {
                let of_light = (settings.lights[light].name.as_str(), light);
                match self.size_handle.show(ui, &painter, &view, &scene_light, of_light) {
                    Some(DraggedLightSize::Size(size)) => settings.lights[light].size = size,
                    Some(DraggedLightSize::AngleDeg(angle_deg)) => {
                        settings.lights[light].angle_deg = angle_deg;
                    }
                    None => {}
                }
            }
            let color = theme::color(settings.lights[light].color);
            let radius = theme::HANDLE_RADIUS + if active { 1.5 } else { 0.0 };
            if *selected == light {
                painter.circle_stroke(handle.position, radius + 4.0, Stroke::new(1.5, theme::ACCENT));
            }
            paint_handle(&painter, handle.position, radius, color, handle.is_behind);
            if let Some(direction) = handle.direction_outside {
                // Outside the ring of the selected light.
                let from = radius + if *selected == light { 4.5 } else { 0.0 };
                paint_arrow(&painter, handle.position + direction * from, direction, color);
            }
            if response.hovered() {
                ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "one call, right above")]
    fn handle_drag(
        &mut self,
        ui: &egui::Ui,
        response: &Response,
        view: &LightHandleView,
        handle: &geometry::LightHandlePlacement,
        light: usize,
        settings: &mut Settings,
        selected: &mut usize,
    ) {
        if response.clicked() || response.drag_started() {
            *selected = light;
        }
        let pointer = response.interact_pointer_pos();
        if response.drag_started()
            && let Some(pointer) = pointer
        {
            // From where the button was pressed: egui reports a drag only some points later.
            let pressed = ui.input(|input| input.pointer.press_origin()).unwrap_or(pointer);
            self.drag = Some(LightHandleDrag {
                light,
                is_behind: handle.is_behind,
                pointer_offset: handle.position - pressed,
            });
        }
        if let (Some(drag), Some(pointer)) = (self.drag, pointer)
            && drag.light == light
            && response.dragged()
            && ui.input(|input| input.pointer.delta()) != Vec2::ZERO
        {
            let mut moved = settings.lights[light].resolve(&settings.camera);
            view.move_light(&mut moved, pointer + drag.pointer_offset, drag.is_behind);
            settings.lights[light].set_scene_position(moved.position.into(), &settings.camera);
        }
        if self.drag.is_some_and(|drag| drag.light == light && !response.dragged()) {
            self.drag = None;
        }
        if (response.hovered() || response.dragged())
            && settings.lights[light].kind == LightGeometry::Perspective
        {
            self.captures_wheel = true;
            let notches = wheel_notches(ui);
            if notches != 0.0 {
                let mut moved = settings.lights[light].resolve(&settings.camera);
                view.move_along_sight(&mut moved, notches);
                settings.lights[light].set_scene_position(moved.position.into(), &settings.camera);
            }
        }
    }
}

/// Paints a disc in the light's colour, or a ring for a light on the far side.
fn paint_handle(painter: &egui::Painter, at: Pos2, radius: f32, color: Color32, hollow: bool) {
    painter.circle_filled(at, radius + 1.5, theme::OUTLINE);
    if hollow {
        painter.circle_stroke(at, radius - 1.0, Stroke::new(2.5, color));
    } else {
        painter.circle_filled(at, radius, color);
        // A darker circle inside distinguishes white lights from white material.
        painter.circle_stroke(at, radius - 3.0, Stroke::new(1.0, theme::OUTLINE.gamma_multiply(0.6)));
    }
}

/// Length and half width of an arrow, in points.
const ARROW_SIZE: Vec2 = Vec2::new(6.0, 5.0);

/// Paints an arrow at the border of a handle that points towards its light outside the picture.
fn paint_arrow(painter: &egui::Painter, from: Pos2, direction: Vec2, color: Color32) {
    let (foot, side) = (from + direction * 1.5, direction.rot90() * ARROW_SIZE.y);
    let corners = vec![foot + side, foot + direction * ARROW_SIZE.x, foot - side];
    painter.add(egui::Shape::convex_polygon(corners, color, Stroke::new(1.0, theme::OUTLINE)));
}
