//! Tool that makes materials from places that are clicked in the picture.

use eframe::egui::{Align2, Color32, CursorIcon, Pos2, Rect, Response, Stroke, Ui, vec2};
use glam::DVec3;

use super::probe_at;
use crate::app::common::{overlay_windows, theme};
use crate::app::text;
use crate::app::viewport::overlay::outlined_text::paint_outlined_text;
use crate::app::viewport::view_projection::ViewProjection;
use chiaroscuro_scene::{Camera, MATERIAL_COLORS, MAX_MATERIAL_BOXES, MaterialBox, MaterialSample, Settings};
use chiaroscuro_volume::Volume;

/// Radius of the mark at a place that was clicked, in points.
const MARK_RADIUS: f32 = 5.0;

/// Tool that parts the materials at places that are clicked: they take the place of the first layer's curve.
#[derive(Debug, Default)]
pub(crate) struct MaterialPicker {
    is_active: bool,
    /// Materials at the places, with these in scene space.
    picked: Vec<(MaterialSample, DVec3)>,
    /// Content identifier of the volume in which they were picked.
    content_id: u64,
    /// Materials of the layer that were made of them.
    made: Vec<MaterialBox>,
    /// Pointer in the picture while a layer is drawn by materials, with the value and the change under it.
    hovered: Option<(Pos2, Option<[f64; 2]>)>,
}

impl MaterialPicker {
    /// Begins picking, or ends it.
    pub(crate) fn toggle(&mut self) {
        *self = Self { is_active: !self.is_active, hovered: self.hovered, ..Self::default() };
    }

    /// Applies a click to the materials of a look. Returns true if nothing else may use it.
    pub(crate) fn handle_mouse(
        &mut self,
        ui: &Ui,
        response: &Response,
        settings: &mut Settings,
        volume: &Volume,
    ) -> bool {
        self.update_hovered(response, settings, volume);
        if self.is_active && overlay_windows::escape_for_picture(ui.ctx()) {
            self.is_active = false;
        }
        if !self.is_active {
            return false;
        }
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) else { return false };
        if let Some(found) = picked_at(volume, settings, response.rect, at) {
            // In another volume, and after an undo or another change, a click begins anew.
            let is_continued =
                self.content_id == volume.content_id() && self.made == settings.layer().materials;
            if !is_continued || self.picked.len() >= MAX_MATERIAL_BOXES {
                self.content_id = volume.content_id();
                self.picked.clear();
            }
            self.picked.push(found);
            // One alone would hide the others, which are still to be clicked.
            if self.picked.len() > 1 {
                let materials: Vec<MaterialSample> =
                    self.picked.iter().map(|(material, _)| *material).collect();
                let range = settings.layer().shown_range(&volume.ranges(), None);
                self.made = MaterialSample::separating_boxes(&materials, range);
                settings.layer_mut().materials.clone_from(&self.made);
            } else {
                self.made.clone_from(&settings.layer().materials);
            }
        }
        true
    }

    /// Returns the value under the pointer in the picture, and its change over a voxel, while materials are edited.
    pub(crate) fn hovered(&self) -> Option<[f64; 2]> {
        self.hovered.and_then(|(_, found)| found)
    }

    fn update_hovered(&mut self, response: &Response, settings: &Settings, volume: &Volume) {
        let pointer =
            response.hover_pos().filter(|_| settings.layer().has_materials() && !response.dragged());
        self.hovered = pointer.map(|at| match self.hovered {
            Some((known, found)) if known == at => (at, found),
            _ => {
                let found = probe_at(volume, settings, response.rect, at);
                (at, found.map(|found| [found.value, MaterialSample::change_at(volume, found.index)]))
            }
        });
    }

    /// Paints the places that were clicked, and a hint.
    pub(crate) fn paint(&self, ui: &Ui, picture: Rect, camera: &Camera) {
        if !self.is_active {
            return;
        }
        let painter = ui.painter_at(picture);
        let projection = ViewProjection { camera: camera.clone(), picture };
        for ((_, place), color) in self.picked.iter().zip(MATERIAL_COLORS) {
            if let Some(at) = projection.project(*place) {
                painter.circle(at, MARK_RADIUS, theme::color(color), Stroke::new(1.5, Color32::BLACK));
            }
        }
        let at = picture.center_bottom() - vec2(0.0, 14.0);
        paint_outlined_text(
            &painter,
            at,
            Align2::CENTER_BOTTOM,
            text::materials::pick_hint(self.picked.len()),
        );
        let line = vec2(0.0, 16.0);
        paint_outlined_text(&painter, at - line, Align2::CENTER_BOTTOM, text::materials::ESCAPE_ENDS);
    }
}

/// Returns the material behind the surface at a point of the window, with the place of the surface; where no material
/// is seen, behind that which the curve would show.
fn picked_at(
    volume: &Volume,
    settings: &Settings,
    picture: Rect,
    at: Pos2,
) -> Option<(MaterialSample, DVec3)> {
    let found = probe_at(volume, settings, picture, at).or_else(|| {
        let mut by_curve = settings.clone();
        by_curve.layer_mut().materials.clear();
        probe_at(volume, &by_curve, picture, at)
    })?;
    let offset = at - picture.min;
    let [x, y, width, height] = [offset.x, offset.y, picture.width(), picture.height()].map(f64::from);
    let (_, direction) = settings.camera.ray_through(x, y, width, height);
    let into = volume.scene().index_from_scene.transform_vector3(direction);
    Some((MaterialSample::measure(volume, found.index, into)?, found.point))
}
