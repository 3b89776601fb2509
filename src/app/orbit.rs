//! The mouse on the picture: orbit, pan, zoom.

use eframe::egui::{self, PointerButton, Response};

use crate::model::Camera;

/// Degrees of orbit per point of drag.
const DEGREES_PER_POINT: f64 = 0.4;
/// One notch of the wheel brings the eye this much nearer.
const ZOOM_PER_NOTCH: f64 = 1.1;
/// Points of scrolling per notch.
const POINTS_PER_NOTCH: f64 = 40.0;

/// Applies what the user does on the picture to the camera. `height` of the picture in points;
/// `zooms`: the wheel is not needed elsewhere.
pub(super) fn navigate(ui: &egui::Ui, response: &Response, camera: &mut Camera, height: f64, zooms: bool) {
    let delta = response.drag_delta();
    let (dx, dy) = (f64::from(delta.x), f64::from(delta.y));
    let shift = ui.input(|input| input.modifiers.shift);
    let pans = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Secondary)
        || (shift && response.dragged_by(PointerButton::Primary));
    if pans {
        camera.pan(dx, dy, height);
    } else if response.dragged_by(PointerButton::Primary) {
        camera.orbit(dx * DEGREES_PER_POINT, dy * DEGREES_PER_POINT);
    }
    if zooms && response.contains_pointer() {
        let notches = wheel_notches(ui);
        let pinch = ui.input(egui::InputState::zoom_delta);
        if notches != 0.0 || pinch != 1.0 {
            camera.zoom(ZOOM_PER_NOTCH.powf(-notches) / f64::from(pinch));
        }
    }
}

/// Notches of the wheel in this frame, upwards.
pub(super) fn wheel_notches(ui: &egui::Ui) -> f64 {
    f64::from(ui.input(|input| input.smooth_scroll_delta().y)) / POINTS_PER_NOTCH
}
