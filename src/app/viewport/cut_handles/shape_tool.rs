//! Tool that cuts by shapes in the picture: an outline is drawn, a sphere is placed, a part is picked.

use std::sync::Arc;

use eframe::egui::{Align2, CursorIcon, Key, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui, vec2};
use glam::DVec3;

use super::part_highlight::PartHighlight;
use crate::app::common::{overlay_windows, shortcuts, theme};
use crate::app::text;
use crate::app::viewport::light_probe;
use crate::app::viewport::mouse_navigation::wheel_notches;
use crate::app::viewport::overlay::outlined_text::paint_outlined_text;
use crate::app::viewport::view_projection::ViewProjection;
use chiaroscuro_scene::{
    Camera, ComponentCut, CutAction, CutShape, CutShapeKind, MAX_OUTLINE_POINTS, MAX_SHAPE_CUTS, OutlineCut,
    Settings, ShapeCut, SphereCut,
};
use chiaroscuro_volume::{ValueRange, Volume};

/// Smallest distance between two corners of an outline, in points.
const MIN_CORNER_DISTANCE: f32 = 3.0;

/// Smallest extent of an outline that cuts, in points: a click that slipped is none.
const MIN_OUTLINE_EXTENT: f32 = 8.0;

/// Factor of the radius of a sphere per notch of the wheel.
const RADIUS_PER_NOTCH: f64 = 1.15;

/// Smallest and largest radius of a sphere, in scene units: from a voxel of a large volume to all of it.
const RADIUS_RANGE: [f64; 2] = [0.002, 2.0];

/// Number of corners of an outline at which a surface is looked for.
const MAX_SURFACE_PROBES: usize = 16;

/// Number of corners of the painted circle of a sphere.
const CIRCLE_CORNERS: usize = 64;

/// Tool that cuts by shapes, in use while Q is held or after a kind of shape was chosen.
#[derive(Debug, Default)]
pub(crate) struct ShapeCutTool {
    /// Kind of shape that was chosen, until Escape.
    chosen: Option<CutShapeKind>,
    /// Corners of the outline in progress, in points.
    corners: Vec<Pos2>,
    /// Radius of the next sphere, in scene units; `None` before the first.
    radius: Option<f64>,
    /// Kind of shape in use in this frame.
    active: Option<CutShapeKind>,
    /// Pointer for which the sphere's centre was found, with the centre.
    center: Option<(Pos2, Option<DVec3>)>,
    /// True while Shift is held, for the hint.
    is_reversed: bool,
    /// Outline of the part that a click would cut.
    part: PartHighlight,
}

impl ShapeCutTool {
    /// Chooses a kind of shape, or ends cutting if it is chosen already. Returns true if a kind is chosen.
    pub(crate) fn toggle(&mut self, kind: CutShapeKind) -> bool {
        self.chosen = (self.chosen != Some(kind)).then_some(kind);
        self.corners.clear();
        self.chosen.is_some()
    }

    /// Applies the mouse to the cuts of a look. Returns true if nothing else may use it.
    pub(crate) fn handle_mouse(
        &mut self,
        ui: &Ui,
        response: &Response,
        settings: &mut Settings,
        volume: &Arc<Volume>,
    ) -> bool {
        let is_held = !shortcuts::is_typing(ui.ctx())
            && ui.input(|input| input.key_down(Key::Q) && !input.modifiers.command);
        if self.chosen.is_some() && self.corners.is_empty() && overlay_windows::escape_for_picture(ui.ctx()) {
            self.chosen = None;
        }
        self.active = self.chosen.or((is_held || !self.corners.is_empty()).then_some(CutShapeKind::Outline));
        self.is_reversed = ui.input(|input| input.modifiers.shift);
        if self.cuts_by_click() {
            self.part.update(ui, response, settings, volume);
        } else {
            self.part.clear();
        }
        let Some(kind) = self.active else { return false };
        if response.hovered() || response.dragged() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        // Other buttons pan the view and change the window meanwhile.
        let is_primary =
            !response.dragged_by(PointerButton::Middle) && !response.dragged_by(PointerButton::Secondary);
        match kind {
            CutShapeKind::Outline => {
                self.draw_outline(ui, response, settings, volume);
                is_primary
            }
            CutShapeKind::Sphere => {
                self.place_sphere(ui, response, settings, volume);
                // A drag turns the view as ever, but the wheel belongs to the sphere.
                response.clicked() || wheel_notches(ui) != 0.0
            }
            // Not chosen: it is cut at once.
            CutShapeKind::Box | CutShapeKind::HalfSpace => false,
            CutShapeKind::Component => {
                self.pick_component(response, settings, volume);
                response.clicked()
            }
        }
    }

    /// Returns true if a click would cut the part under the pointer.
    fn cuts_by_click(&self) -> bool {
        match self.active {
            Some(CutShapeKind::Component) => true,
            Some(CutShapeKind::Outline) => self.corners.is_empty(),
            _ => false,
        }
    }

    /// Adds a cut, if there is room for one.
    fn add_cut(settings: &mut Settings, action: CutAction, shape: CutShape) {
        if settings.cuts.shapes.len() < MAX_SHAPE_CUTS {
            settings.cuts.shapes.push(ShapeCut { action, shape, ..ShapeCut::default() });
        }
    }

    fn draw_outline(&mut self, ui: &Ui, response: &Response, settings: &mut Settings, volume: &Volume) {
        if response.drag_started_by(PointerButton::Primary) {
            // From where the button was pressed: egui reports a drag only some points later.
            self.corners = ui.input(|input| input.pointer.press_origin()).into_iter().collect();
        }
        if response.dragged_by(PointerButton::Primary)
            && let Some(at) = response.interact_pointer_pos()
            && self.corners.last().is_some_and(|last| last.distance(at) >= MIN_CORNER_DISTANCE)
        {
            self.corners.push(at);
        }
        if response.clicked() {
            // A click cuts what is under it.
            self.pick_component(response, settings, volume);
        }
        if response.drag_stopped_by(PointerButton::Primary) {
            let corners = std::mem::take(&mut self.corners);
            // Escape ends a drag while the button is still down.
            let is_cancelled = ui.input(|input| input.pointer.primary_down());
            let extent = Rect::from_points(&corners).size();
            if !is_cancelled && corners.len() >= 3 && extent.max_elem() >= MIN_OUTLINE_EXTENT {
                let action = if self.is_reversed { CutAction::Keep } else { CutAction::Hide };
                let mut outline = outline_cut(&corners, response.rect, &settings.camera);
                outline.surface = surface_inside(&corners, response.rect, settings, volume);
                Self::add_cut(settings, action, CutShape::Outline(outline));
            }
        }
    }

    fn place_sphere(&mut self, ui: &Ui, response: &Response, settings: &mut Settings, volume: &Volume) {
        let [smallest, largest] = RADIUS_RANGE;
        let radius = self.radius.get_or_insert(SphereCut::default().radius);
        if response.contains_pointer() {
            *radius = (*radius * RADIUS_PER_NOTCH.powf(wheel_notches(ui))).clamp(smallest, largest);
        }
        let radius = *radius;
        let pointer = response.hover_pos().filter(|_| !response.dragged());
        self.center = pointer.map(|at| match self.center {
            Some((known, center)) if known == at => (at, center),
            _ => {
                // Hidden matter is probed, too, so that it can be restored.
                let all = volume.with_mask(None);
                let volume = if self.is_reversed { &all } else { volume };
                let found = light_probe::probe_at(volume, settings, response.rect, at);
                (at, found.map(|found| found.point))
            }
        });
        if response.clicked()
            && let Some((_, Some(center))) = self.center
        {
            let action = if self.is_reversed { CutAction::Restore } else { CutAction::Hide };
            Self::add_cut(settings, action, CutShape::Sphere(SphereCut { center: center.into(), radius }));
            // The surface is another one now.
            self.center = None;
        }
    }

    fn pick_component(&self, response: &Response, settings: &mut Settings, volume: &Volume) {
        if response.clicked()
            && let Some(at) = response.interact_pointer_pos()
            && let Some(found) = light_probe::probe_at(volume, settings, response.rect, at)
        {
            let action = if self.is_reversed { CutAction::Keep } else { CutAction::Hide };
            let component = ComponentCut::from_picked(settings, volume, found.point, found.value);
            Self::add_cut(settings, action, CutShape::Component(component));
        }
    }

    /// Paints the shape in progress, and a hint on the gestures.
    pub(crate) fn paint(&self, ui: &Ui, picture: Rect, camera: &Camera) {
        let Some(kind) = self.active else { return };
        let painter = ui.painter_at(picture);
        self.part.paint(&painter, picture);
        let line: Vec<Pos2> = match (kind, self.center, self.radius) {
            (CutShapeKind::Sphere, Some((_, Some(center))), Some(radius)) => {
                circle(camera, picture, center, radius)
            }
            _ => self.corners.clone(),
        };
        if line.len() > 1 {
            for (width, ink) in [(4.0, theme::OUTLINE), (1.8, theme::ACCENT)] {
                painter.add(Shape::closed_line(line.clone(), Stroke::new(width, ink)));
            }
        }
        let at = picture.center_bottom() - vec2(0.0, 14.0);
        let hint = text::cuts::shape_hint(kind, self.is_reversed);
        paint_outlined_text(&painter, at, Align2::CENTER_BOTTOM, hint);
        if self.chosen.is_some() {
            let line = vec2(0.0, 16.0);
            paint_outlined_text(&painter, at - line, Align2::CENTER_BOTTOM, text::cuts::ESCAPE_ENDS);
        }
    }
}

/// Returns the cut of an outline in points, drawn over a picture.
fn outline_cut(corners: &[Pos2], picture: Rect, camera: &Camera) -> OutlineCut {
    let step = corners.len().div_ceil(MAX_OUTLINE_POINTS);
    let points = corners.iter().step_by(step).map(|&at| {
        let share = (at - picture.min) / picture.size();
        [f64::from(share.x), f64::from(share.y)]
    });
    let aspect = f64::from(picture.width()) / f64::from(picture.height()).max(1.0);
    OutlineCut { camera: camera.clone(), aspect, points: points.collect(), ..OutlineCut::default() }
}

/// Returns the values of the surface that is seen inside an outline: in its middle, or at the first corner that shows
/// one.
fn surface_inside(
    corners: &[Pos2],
    picture: Rect,
    settings: &Settings,
    volume: &Volume,
) -> Option<ValueRange> {
    let middle = Rect::from_points(corners).center();
    let step = corners.len().div_ceil(MAX_SURFACE_PROBES);
    let mut places = std::iter::once(middle).chain(corners.iter().copied().step_by(step));
    let found = places.find_map(|at| light_probe::probe_at(volume, settings, picture, at))?;
    Some(ComponentCut::from_picked(settings, volume, found.point, found.value).values)
}

/// Returns the circle of a sphere that is seen through a camera, in points.
fn circle(camera: &Camera, picture: Rect, center: DVec3, radius: f64) -> Vec<Pos2> {
    let view_projection = ViewProjection { camera: camera.clone(), picture };
    let view = camera.scene_from_view();
    let corner = |at: usize| {
        let (sin, cos) = (at as f64 / CIRCLE_CORNERS as f64 * std::f64::consts::TAU).sin_cos();
        view_projection.project(center + radius * (view.x_axis * cos + view.y_axis * sin))
    };
    (0..CIRCLE_CORNERS).filter_map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn outlines_are_stored_in_shares_of_the_picture() {
        let picture = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 200.0));
        let corners: Vec<Pos2> =
            (0..600).map(|at| pos2(100.0 + at as f32 / 2.0, 50.0 + at as f32 / 6.0)).collect();
        let cut = outline_cut(&corners, picture, &Camera::default());
        assert_eq!((cut.aspect, cut.points.len()), (2.0, 200));
        assert_eq!(cut.points[0], [0.0, 0.0]);
        let [x, y] = cut.points[100];
        assert!((x - 0.375).abs() < 1e-6 && (y - 0.25).abs() < 1e-6, "{x} {y}");
    }

    #[test]
    fn circles_have_the_radius_of_their_sphere() {
        let picture = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 400.0));
        let line = circle(&Camera::default(), picture, DVec3::ZERO, 0.5);
        let far = line.iter().map(|at| at.distance(picture.center())).fold(0.0, f32::max);
        let near = line.iter().map(|at| at.distance(picture.center())).fold(f32::MAX, f32::min);
        assert!(line.len() == CIRCLE_CORNERS && far - near < 0.1 && near > 20.0, "{near} to {far}");
    }
}
