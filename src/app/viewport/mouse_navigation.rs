//! Mouse navigation in the picture: orbit, pan, zoom, and window/level.

use eframe::egui::{self, Key, PointerButton, Response};
use glam::dvec2;

use crate::app::common::light_keys;
use chiaroscuro_scene::{Camera, Settings, first_look::ObjectOutline};
use chiaroscuro_volume::ValueRange;

/// Degrees of orbit per point of drag.
const DEGREES_PER_POINT: f64 = 0.4;
/// Factor by which one notch of the wheel reduces the eye's distance.
const ZOOM_PER_NOTCH: f64 = 1.1;
/// Points of scrolling per notch of the wheel.
const POINTS_PER_NOTCH: f64 = 40.0;

/// Natural logarithm of the factor by which a drag across the whole picture widens the value window.
const LOG_WINDOW_PER_WIDTH: f64 = 2.0;

/// Distance of the eye at the start of an orbit around an object that was completely in the frame; the object stays
/// in the frame during the orbit.
#[derive(Debug, Default)]
pub(crate) struct OrbitDrag {
    distance: Option<f64>,
}

/// Tolerance for rounding errors in the outline of an object that was framed exactly.
const FRAMING_TOLERANCE: f64 = 1.0 + 1e-3;

impl OrbitDrag {
    /// Starts an orbit at the camera's present distance.
    pub(crate) fn begin(camera: &Camera, outline: Option<&ObjectOutline>) -> Self {
        let is_whole =
            |outline: &&ObjectOutline| camera.distance * FRAMING_TOLERANCE >= outline.least_distance(camera);
        Self { distance: outline.filter(is_whole).map(|_| camera.distance) }
    }

    /// Moves the camera as far away as the object needs from this side, and back to the initial distance where it
    /// does not.
    pub(crate) fn keep_in_frame(&self, camera: &mut Camera, outline: Option<&ObjectOutline>) {
        if let Some((distance, outline)) = self.distance.zip(outline) {
            camera.distance = distance.max(outline.least_distance(camera));
        }
    }
}

/// Applies mouse gestures on the picture to the camera, or, while L is held, to the selected light; with the right
/// button, to level and window of the transfer function.
///
/// `zooms`: the wheel is not used elsewhere. `range`: range of the volume's values, if there is a volume. `outline`:
/// outline of the object, if it is known.
pub(crate) fn navigate(
    ui: &egui::Ui,
    response: &Response,
    settings: &mut Settings,
    selected: usize,
    zooms: bool,
    range: Option<ValueRange>,
    (orbit, outline): (&mut OrbitDrag, Option<&ObjectOutline>),
) {
    let Settings { camera, lights, layers, .. } = settings;
    let (width, height) = (f64::from(response.rect.width()), f64::from(response.rect.height()));
    if response.drag_started() {
        *orbit = OrbitDrag::begin(camera, outline);
    }
    let delta = response.drag_delta();
    let (dx, dy) = (f64::from(delta.x), f64::from(delta.y));
    let shift = ui.input(|input| input.modifiers.shift);
    let pans =
        response.dragged_by(PointerButton::Middle) || (shift && response.dragged_by(PointerButton::Primary));
    let lit = lights.get_mut(selected).filter(|_| ui.input(|input| input.key_down(Key::L)));
    if let Some(light) = lit.filter(|_| response.dragged_by(PointerButton::Primary)) {
        light_keys::turn(light, camera, dx * DEGREES_PER_POINT, -dy * DEGREES_PER_POINT);
    } else if let Some(range) = range.filter(|_| response.dragged_by(PointerButton::Secondary)) {
        // The direction matches that of the slice views: down means higher values.
        let shift = dy / height.max(1.0) * (range.high - range.low);
        layers
            .first_mut()
            .transfer
            .shift_and_stretch(shift, (LOG_WINDOW_PER_WIDTH * dx / width.max(1.0)).exp());
    } else if pans {
        camera.pan(dx, dy, width, height);
    } else if response.dragged_by(PointerButton::Primary) {
        camera.orbit(dx * DEGREES_PER_POINT, dy * DEGREES_PER_POINT);
        orbit.keep_in_frame(camera, outline);
    }
    if zooms && response.contains_pointer() {
        let notches = wheel_notches(ui);
        let pinch = ui.input(egui::InputState::zoom_delta);
        if notches != 0.0 || pinch != 1.0 {
            let factor = ZOOM_PER_NOTCH.powf(-notches) / f64::from(pinch);
            let at = response.hover_pos().unwrap_or(response.rect.center()) - response.rect.min;
            // A zoom overrides the distance that the orbit would return to.
            *orbit = OrbitDrag::default();
            camera.zoom_at(factor, dvec2(f64::from(at.x), f64::from(at.y)), dvec2(width, height));
        }
    }
}

/// Returns the wheel's notches in this frame, positive upwards.
pub(crate) fn wheel_notches(ui: &egui::Ui) -> f64 {
    f64::from(ui.input(|input| input.smooth_scroll_delta().y)) / POINTS_PER_NOTCH
}
