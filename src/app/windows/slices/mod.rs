//! The window "Slices": three cuts through the data along its axes, through a cursor that they share with the
//! picture.

pub(in crate::app::windows) mod image;

use std::sync::Arc;

use eframe::egui::{
    self, Color32, CursorIcon, Painter, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke,
    TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use glam::DVec3;

use self::image::{Grey, across, lookup, slice};
use crate::app::common::dock::Tool;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use crate::app::viewport::orbit::wheel_notches;
use crate::app::viewport::view_projection::ViewProjection;
use crate::data::{Shown, ValueRange, Volume};
use crate::math::SceneSpace;
use crate::model::TransferFunction;

/// Longest edge of a slice on screen, in points, before somebody makes the window larger or smaller.
const EDGE: f32 = 208.0;
/// The least of them, in which something is seen, and the most: two fill a large screen.
const LEAST_EDGE: f32 = 96.0;
const MOST_EDGE: f32 = 900.0;

/// Shares of all voxels that are as black, or as white, as can be, before the user says otherwise.
const CLIPPED: [f64; 2] = [0.005, 0.995];

/// One of the three cuts.
#[derive(Default)]
struct Cut {
    texture: Option<TextureHandle>,
    /// What the texture shows: volume, slice, grey levels, colours.
    drawn: Option<(u64, usize, Grey, Option<TransferFunction>)>,
}

/// State of the window.
#[derive(Default)]
pub(crate) struct Slices {
    /// Whether it is there.
    pub open: bool,
    /// The voxel through which all cuts go.
    cursor: [usize; 3],
    /// Of which volume that is, and the grey levels.
    of: Option<(u64, Grey)>,
    /// In the colours of the transfer function, where that shows something.
    colored: bool,
    /// What the wheel has turned beyond whole slices: it comes in many small parts.
    turned: f64,
    cuts: [Cut; 3],
    /// Longest edge of a slice on screen, in points.
    edge: f32,
}

impl std::fmt::Debug for Slices {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Slices")
            .field("open", &self.open)
            .field("cursor", &self.cursor)
            .finish_non_exhaustive()
    }
}

impl Slices {
    /// Moves the cursor to a point of index space.
    pub(crate) fn point_at(&mut self, index: DVec3, dims: [usize; 3]) {
        for axis in 0..3 {
            self.cursor[axis] = (index[axis].round().max(0.0) as usize).min(dims[axis] - 1);
        }
    }

    /// Shows the window if it is open.
    pub(crate) fn ui(
        &mut self,
        ctx: &egui::Context,
        volume: Option<&Arc<Volume>>,
        facts: Option<&VolumeFacts>,
        transfer: &TransferFunction,
    ) {
        let (Some(volume), Some(facts), true) = (volume, facts, self.open) else { return };
        let mut grey = match self.of {
            Some((of, grey)) if of == volume.content_id() => grey,
            _ => {
                self.cursor = volume.dims().map(|n| n / 2);
                let [black, white] = CLIPPED.map(|share| volume.value_of(facts.histogram.percentile(share)));
                Grey { black, white }
            }
        };
        let mut open = true;
        let tool =
            Tool { title: text::slices::TITLE, default_pos: [24.0, 60.0], default_width: 2.0 * EDGE + 8.0 };
        tool.show(ctx, &mut open, |ui| {
            // Two beside each other.
            self.edge = ((ui.available_width() - 8.0) / 2.0).clamp(LEAST_EDGE, MOST_EDGE);
            // From above, from the front, from the right; and what is at the cursor.
            ui.horizontal_top(|ui| {
                self.cut(ui, 2, volume, &mut grey, transfer);
                self.cut(ui, 1, volume, &mut grey, transfer);
            });
            ui.horizontal_top(|ui| {
                self.cut(ui, 0, volume, &mut grey, transfer);
                ui.vertical(|ui| self.facts(ui, volume, facts, &mut grey, transfer));
            });
        });
        self.open = open;
        self.of = Some((volume.content_id(), grey.within(facts.range)));
    }

    /// What is known of the cursor, and how grey the slices are.
    fn facts(
        &mut self,
        ui: &mut Ui,
        volume: &Volume,
        facts: &VolumeFacts,
        grey: &mut Grey,
        transfer: &TransferFunction,
    ) {
        let [x, y, z] = self.cursor;
        let value = volume.value(x, y, z);
        let unit = facts.length_unit();
        let world = volume.world_from_index().transform_point3(DVec3::from(self.cursor.map(|at| at as f64)));
        egui::Grid::new("cursor").num_columns(2).spacing([10.0, 3.0]).show(ui, |ui| {
            let mut line = |what: &str, found: String| {
                ui.weak(what);
                ui.label(found);
                ui.end_row();
            };
            line(text::slices::VOXEL, format!("{x}, {y}, {z}"));
            let [x, y, z] = (world / unit.mm).to_array();
            line(unit.symbol(), format!("{x:.1}, {y:.1}, {z:.1}"));
            let digits = if facts.levels.is_some() { format!("{value}") } else { format!("{value:.5}") };
            line(text::slices::VALUE, digits);
            let place = volume.table_range().at(volume.density_of(value));
            line(text::slices::OPACITY, format!("{:.2}", transfer.opacity_at(place)));
        });
        let speed = facts.range.span() / 500.0;
        for (name, level) in [(text::slices::BLACK, &mut grey.black), (text::slices::WHITE, &mut grey.white)]
        {
            ui.horizontal(|ui| {
                let label = ui.label(name);
                let field = egui::DragValue::new(level).speed(speed).max_decimals(3);
                ui.add(field).labelled_by(label.id).on_hover_text(text::slices::LEVEL_TIP);
            });
        }
        let colored = text::slices::COLORED;
        ui.checkbox(&mut self.colored, colored.name).on_hover_text(colored.tip);
        ui.weak(text::slices::HINT);
    }

    /// The cut across an axis, and what the mouse does on it.
    fn cut(
        &mut self,
        ui: &mut Ui,
        axis: usize,
        volume: &Arc<Volume>,
        grey: &mut Grey,
        transfer: &TransferFunction,
    ) {
        let dims = volume.dims();
        let [u, v] = across(axis);
        let what = (volume.content_id(), self.cursor[axis], *grey, self.colored.then(|| transfer.clone()));
        let cut = &mut self.cuts[axis];
        if cut.drawn.as_ref() != Some(&what) {
            // Whatever the picture shows: beyond these all values look the same.
            let ValueRange { low, high } = volume.shown_range();
            let greys = Shown::Range(ValueRange::new(low.min(grey.black), high.max(grey.white)));
            let is_by_label = self.colored && volume.shown_labels().is_some();
            let shown = if is_by_label { Shown::Labels } else { greys };
            let volume = volume.showing(shown);
            let table = lookup(&volume, *grey, what.3.as_ref());
            let image = slice(&volume, axis, self.cursor[axis], &table);
            match &mut cut.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                empty => *empty = Some(ui.ctx().load_texture("slice", image, TextureOptions::LINEAR)),
            }
            cut.drawn = Some(what);
        }
        let Some(texture) = &cut.texture else { return };
        let spacing = volume.spacing_mm();
        let size = vec2((dims[u] as f64 * spacing[u]) as f32, (dims[v] as f64 * spacing[v]) as f32);
        let edge = self.edge;
        let size = (size * (edge / size.max_elem())).max(Vec2::splat(2.0));
        // Beside each other they begin at the same places.
        let (frame, response) =
            ui.allocate_exact_size(vec2(edge, size.y.max(0.4 * edge)), Sense::click_and_drag());
        let area = Rect::from_center_size(frame.center(), size);
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, text::slices::across(axis)));
        let painter = ui.painter_at(frame);
        // Not as black as data may be, so that it is seen where these end.
        painter.rect_filled(frame, 0.0, theme::EMPTY_CANVAS);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture.id(), area, whole, Color32::WHITE);
        self.move_cursor(ui, &response, area, axis, dims);
        if response.dragged_by(PointerButton::Secondary) {
            grey.drag(response.drag_delta() / edge, volume.shown_range());
        }
        crosshair(&painter, area, axis, self.cursor, dims);
        let name = text::slices::plane(axis, self.cursor[axis], volume.is_anatomical());
        let font = egui::TextStyle::Small.resolve(ui.style());
        painter.text(frame.left_top() + vec2(5.0, 3.0), egui::Align2::LEFT_TOP, name, font, theme::EYE_CURVE);
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
    }

    fn move_cursor(&mut self, ui: &Ui, response: &Response, area: Rect, axis: usize, dims: [usize; 3]) {
        let [u, v] = across(axis);
        let moves = response.clicked() || response.dragged_by(PointerButton::Primary);
        if let Some(at) = response.interact_pointer_pos().filter(|_| moves) {
            let share = (at - area.min) / area.size();
            let voxel = |share: f32, n: usize| ((share * n as f32).max(0.0) as usize).min(n - 1);
            self.cursor[u] = voxel(share.x, dims[u]);
            self.cursor[v] = voxel(1.0 - share.y, dims[v]);
        }
        if response.hovered() {
            self.turned += wheel_notches(ui);
            let whole = self.turned.trunc();
            self.turned -= whole;
            self.cursor[axis] = self.cursor[axis].saturating_add_signed(whole as isize).min(dims[axis] - 1);
        }
    }

    /// The cursor in the picture: a line along each axis of the grid.
    pub(crate) fn mark(&self, painter: &Painter, view_projection: &ViewProjection, scene: &SceneSpace) {
        if !self.open || self.of.is_none() {
            return;
        }
        let cursor = DVec3::from(self.cursor.map(|at| at as f64));
        for axis in 0..3 {
            let end = |at: f64| {
                let mut index = cursor;
                index[axis] = at;
                view_projection.point(scene.scene_from_index.transform_point3(index))
            };
            if let (Some(a), Some(b)) = (end(-0.5), end(scene.dims[axis] as f64 - 0.5)) {
                painter.line_segment([a, b], Stroke::new(1.0, theme::AXES[axis].gamma_multiply(0.8)));
            }
        }
    }
}

/// Where the other two cuts go through this one.
fn crosshair(painter: &Painter, area: Rect, axis: usize, cursor: [usize; 3], dims: [usize; 3]) {
    let [u, v] = across(axis);
    let share = |axis: usize| (cursor[axis] as f32 + 0.5) / dims[axis] as f32;
    let at: Pos2 = area.min + vec2(share(u), 1.0 - share(v)) * area.size();
    let stroke = |axis: usize| Stroke::new(1.0, theme::AXES[axis].gamma_multiply(0.8));
    // A line lies along the axis that it stands for.
    painter.hline(area.x_range(), at.y, stroke(u));
    painter.vline(at.x, area.y_range(), stroke(v));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::worker::loader::Reading;
    use crate::data::{Dataset, Samples};

    #[test]
    fn greys_are_those_of_the_values_that_matter() {
        // A ramp, and one voxel that is far beyond it.
        let mut values: Vec<f32> = (0..24 * 24 * 24).map(|at| (at % 1000) as f32).collect();
        values[7] = 1e20;
        let volume = Volume::with_spacing("ramp", [24; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let dataset = Dataset::new(volume);
        let facts = VolumeFacts::of("ramp".into(), Reading::default(), &dataset);
        let mut slices = Slices { open: true, ..Slices::default() };
        let ctx = egui::Context::default();
        let transfer = TransferFunction::default();
        for _ in 0..2 {
            let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
                slices.ui(ui.ctx(), Some(dataset.volume()), Some(&facts), &transfer);
            });
            output.textures_delta.clear();
        }
        let (_, grey) = slices.of.expect("grey levels");
        assert!(grey.black < 20.0 && (900.0..1100.0).contains(&grey.white), "{grey:?}");
    }
}
