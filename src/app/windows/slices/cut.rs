//! One of the three cuts of the window "Slices": texture, letters at its edges, and mouse gestures.

use std::sync::Arc;

use eframe::egui::{
    self, Color32, CursorIcon, Painter, PointerButton, Rect, Response, Role, Sense, Stroke, TextureHandle,
    TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use super::plane::{BodyPlane, SlicePlane};
use super::slice_image::{GreyWindow, color_table, render_slice};
use super::slice_overlay::SliceOverlay;
use crate::app::common::theme;
use crate::app::text;
use crate::app::viewport::mouse_navigation::wheel_notches;
use crate::app::viewport::overlay::orientation_letters;
use chiaroscuro_scene::TransferFunction;
use chiaroscuro_volume::{DensityMapping, ValueRange, Volume};

/// Distance from the edges of a slice to its letters, in points.
const LETTER_MARGIN: f32 = 3.0;

/// Inputs of a texture: content id of the volume, plane, slice index, grey levels, colours, further layers.
type SliceTextureKey = (u64, SlicePlane, usize, GreyWindow, Option<TransferFunction>, Vec<SliceOverlay>);

/// Colours of a slice: those of the first layer, and of further ones over it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SliceColors<'a> {
    /// Transfer function of the first layer.
    pub transfer: &'a TransferFunction,
    /// Layers that are blended over it.
    pub further: &'a [SliceOverlay],
}

/// Plane of a cut, and its size on screen.
#[derive(Debug, Clone, Copy)]
pub(super) struct CutGeometry {
    pub plane: SlicePlane,
    /// Longest edge on screen, in points.
    pub edge: f32,
}

/// Cut through the volume, with its cached texture.
#[derive(Default)]
pub(super) struct SliceCut {
    texture: Option<TextureHandle>,
    texture_key: Option<SliceTextureKey>,
}

impl SliceCut {
    /// Shows the cut through the cursor. `turned`: fraction of a slice that the wheel has turned.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        CutGeometry { plane, edge }: CutGeometry,
        volume: &Arc<Volume>,
        (cursor, wheel_fraction): (&mut [usize; 3], &mut f64),
        grey_window: &mut GreyWindow,
        colors: Option<SliceColors<'_>>,
    ) {
        self.update_texture(ui, plane, volume, cursor[plane.normal_axis], *grey_window, colors);
        let Some(texture) = &self.texture else { return };
        let (dims, spacing) = (volume.dims(), volume.spacing_mm());
        let [u, v] = [plane.right.axis, plane.up.axis];
        let size = vec2((dims[u] as f64 * spacing[u]) as f32, (dims[v] as f64 * spacing[v]) as f32);
        let size = (size * (edge / size.max_elem())).max(Vec2::splat(2.0));
        ui.vertical(|ui| {
            ui.set_max_width(edge);
            ui.spacing_mut().item_spacing.y = 2.0;
            let name = text::slices::plane(plane_name(plane), plane.normal_axis, cursor[plane.normal_axis]);
            ui.add(egui::Label::new(egui::RichText::new(name).small().weak()).truncate());
            // All frames begin at the same height when side by side.
            let (frame, response) =
                ui.allocate_exact_size(vec2(edge, size.y.max(0.4 * edge)), Sense::click_and_drag());
            let area = Rect::from_center_size(frame.center(), size);
            let sides = volume.is_anatomical().then(|| plane.side_letters(&volume.scene()));
            response.widget_info(|| {
                let across = plane.normal_axis;
                let name = sides.as_ref().map(|sides| text::slices::anatomical_slice_name(across, sides));
                WidgetInfo::labeled(
                    Role::Canvas,
                    true,
                    name.unwrap_or_else(|| text::slices::slice_name(across)),
                )
            });
            let painter = ui.painter_at(frame);
            // Lighter than black data, so that the edge of the slice is visible.
            painter.rect_filled(frame, 0.0, theme::EMPTY_CANVAS);
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture.id(), area, whole, Color32::WHITE);
            move_cursor(ui, &response, area, plane, dims, (cursor, wheel_fraction));
            if response.dragged_by(PointerButton::Secondary) {
                grey_window.drag(response.drag_delta() / edge, volume.shown_range());
            }
            crosshair(&painter, area, plane, *cursor, dims);
            if let Some(sides) = sides {
                orientation_letters::paint_orientation_letters(&painter, frame, sides, LETTER_MARGIN);
            }
            if response.hovered() {
                ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
            }
        });
    }

    /// Updates the texture if its inputs have changed.
    fn update_texture(
        &mut self,
        ui: &Ui,
        plane: SlicePlane,
        volume: &Arc<Volume>,
        at: usize,
        grey: GreyWindow,
        colors: Option<SliceColors<'_>>,
    ) {
        let further = colors.map_or(&[][..], |colors| colors.further);
        let colors = colors.map(|colors| colors.transfer);
        let what = (volume.content_id(), plane, at, grey, colors.cloned(), further.to_vec());
        if self.texture_key.as_ref() == Some(&what) {
            return;
        }
        // Independent of the shown range of the picture: beyond these grey levels all values look alike.
        let ValueRange { low, high } = volume.shown_range();
        let greys = DensityMapping::Range(ValueRange::new(low.min(grey.black), high.max(grey.white)));
        let is_by_label = colors.is_some() && volume.shown_labels().is_some();
        let shown = if is_by_label { DensityMapping::Labels } else { greys };
        let volume = volume.with_density_mapping(shown);
        let mut image = render_slice(&volume, &plane, at, &color_table(&volume, grey, colors));
        for layer in further {
            layer.blend_over(&mut image, &plane, at);
        }
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            empty => *empty = Some(ui.ctx().load_texture("slice", image, TextureOptions::LINEAR)),
        }
        self.texture_key = Some(what);
    }
}

/// Name of a slice plane, anatomical if the volume is.
fn plane_name(plane: SlicePlane) -> &'static str {
    match plane.body_plane {
        Some(BodyPlane::Sagittal) => text::slices::SAGITTAL,
        Some(BodyPlane::Coronal) => text::slices::CORONAL,
        Some(BodyPlane::Axial) => text::slices::AXIAL,
        None => text::slices::axes(plane.normal_axis),
    }
}

fn move_cursor(
    ui: &Ui,
    response: &Response,
    area: Rect,
    plane: SlicePlane,
    dims: [usize; 3],
    (cursor, turned): (&mut [usize; 3], &mut f64),
) {
    let moves = response.clicked() || response.dragged_by(PointerButton::Primary);
    if let Some(at) = response.interact_pointer_pos().filter(|_| moves) {
        plane.move_to(at, area, dims, cursor);
    }
    if response.hovered() {
        *turned += wheel_notches(ui);
        let whole = turned.trunc();
        *turned -= whole;
        let at = &mut cursor[plane.normal_axis];
        *at = at.saturating_add_signed(whole as isize).min(dims[plane.normal_axis] - 1);
    }
}

/// Paints where the other two cuts intersect this one.
fn crosshair(painter: &Painter, area: Rect, plane: SlicePlane, cursor: [usize; 3], dims: [usize; 3]) {
    let at = plane.screen_position(cursor, dims, area);
    let stroke = |axis: usize| Stroke::new(1.0, theme::AXES[axis].gamma_multiply(0.8));
    // A line runs along the axis whose colour it has.
    painter.hline(area.x_range(), at.y, stroke(plane.right.axis));
    painter.vline(at.x, area.y_range(), stroke(plane.up.axis));
}
