//! Editor of materials by value and change, in place of the curve: boxes over a histogram of values and of their
//! changes, in which materials are spots at the bottom, and borders between them are arcs above.

mod drag;
mod histogram;
mod plane;

use eframe::egui::{self, Button, DragValue, Key, Response, RichText, Role, Sense, Ui, Vec2, WidgetInfo};

use self::drag::BoxDrag;
use self::histogram::HistogramCache;
use self::plane::MaterialPlane;
use super::plot::{self, PlotAxes, PlotMarks};
use super::zoom::ShownValues;
use crate::app::common::commands::AppCommand;
use crate::app::common::theme;
use crate::app::common::volume_facts::{VolumeFacts, range_decimals};
use crate::app::panels::controls::color_button;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{MATERIAL_COLORS, MAX_MATERIAL_BOXES, MaterialBox, TransferFunction, VolumeLayer};
use chiaroscuro_volume::ValueRange;

/// Share of the largest opacity of a curve from which on its values are a material's.
const CURVE_SHARE: f64 = 0.1;

/// Returns a material of a curve's visible values at any change, in their colour: the picture is much the same.
pub(super) fn material_of_curve(curve: &TransferFunction, range: ValueRange) -> MaterialBox {
    let most = curve.points.iter().map(|point| point.opacity).fold(0.0, f64::max);
    let values = (0..=256).map(|step| range.value_at(f64::from(step) / 256.0));
    let seen: Vec<f64> =
        values.filter(|&value| most > 0.0 && curve.opacity_at(value) >= CURVE_SHARE * most).collect();
    let [low, high] = match (seen.first(), seen.last()) {
        (Some(&low), Some(&high)) if low < high => [low, high],
        _ => [range.value_at(0.4), range.value_at(1.0)],
    };
    let densest = curve.points.iter().max_by(|a, b| a.opacity.total_cmp(&b.opacity));
    MaterialBox {
        values: [low, high],
        changes: [0.0, range.span()],
        color: densest.map_or([1.0; 3], |point| point.color),
        opacity: if most > 0.0 { most } else { MaterialBox::default().opacity },
        ..MaterialBox::default()
    }
}

/// State of the editor between frames.
#[derive(Debug, Default)]
pub(super) struct MaterialEditor {
    /// Index of the selected material.
    selected: usize,
    histogram: HistogramCache,
    drag: Option<BoxDrag>,
    /// Index of the material under the pointer, while no box is dragged.
    hovered: Option<usize>,
}

impl MaterialEditor {
    /// Shows the editor of a layer's materials in the whole of `ui`. `marks`: what the picture marks.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        layer: &mut VolumeLayer,
        volume: &VolumeFacts,
        marks: PlotMarks,
        commands: &mut Vec<AppCommand>,
    ) {
        self.histogram.update(ui.ctx(), volume);
        self.selected = self.selected.min(layer.materials.len().saturating_sub(1));
        ui.horizontal_wrapped(|ui| self.tools(ui, layer, volume, commands));
        let size = ui.available_size().max(Vec2::splat(20.0));
        let (area, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, text::materials::PLANE));
        let shown = ShownValues { low: volume.range.low, high: volume.range.high, is_whole: true };
        let axes = PlotAxes::new(area, shown, theme::PlotColors::for_visuals(ui.visuals()));
        let plane = MaterialPlane { axes, largest: self.histogram.largest_change() * axes.range.span() };
        self.drag(&response, &plane, layer);
        self.edit_by_keys(ui, &response, layer);
        let is_under = |at| layer.materials.iter().rposition(|material| plane.rect(material).contains(at));
        self.hovered = response.hover_pos().filter(|_| self.drag.is_none()).and_then(is_under);
        plane.paint(ui, self.histogram.texture(), &layer.materials, self.selected);
        let painter = ui.painter_at(area);
        let format = |value: f64| plot::format_value(value, axes.range);
        plot::paint_axis_labels(&painter, &axes, &text::materials::largest_change(&format(plane.largest)));
        plot::paint_value_mark(ui, &axes, marks.value);
        if let Some(place) = marks.hovered {
            plane.paint_place(ui, place);
        }
        if let Some(at) = response.hover_pos() {
            let [value, change] = plane.place_at(at);
            let words = text::materials::readout(&format(value), &format(change));
            plot::paint_readout_text(ui, &axes, at, words);
        }
    }

    /// Takes the index of the material under the pointer in the last frame, if the editor was shown then.
    pub(super) fn take_hovered(&mut self) -> Option<usize> {
        self.hovered.take()
    }

    /// Shows the buttons that add, select and remove materials, and the fields of the selected one.
    fn tools(
        &mut self,
        ui: &mut Ui,
        layer: &mut VolumeLayer,
        volume: &VolumeFacts,
        commands: &mut Vec<AppCommand>,
    ) {
        let named = |ui: &mut Ui, is_enabled: bool, named: ControlText| {
            ui.add_enabled(is_enabled, Button::new(named.name)).on_hover_text(named.tooltip).clicked()
        };
        if named(ui, true, text::materials::USE_CURVE) {
            layer.materials.clear();
            return;
        }
        ui.separator();
        for (index, material) in layer.materials.iter().enumerate() {
            let number =
                RichText::new(text::materials::number(index)).color(theme::color(material.color)).strong();
            let button = ui.selectable_label(self.selected == index, number);
            let name = text::materials::name(index);
            button.widget_info(|| WidgetInfo::selected(Role::Button, true, self.selected == index, &name));
            if button.on_hover_text(&name).clicked() {
                self.selected = index;
            }
        }
        if named(ui, layer.materials.len() < MAX_MATERIAL_BOXES, text::materials::ADD) {
            let middle = volume.range.value_at(0.5);
            let half = 0.1 * volume.range.span();
            let changes = [0.0, 0.5 * self.histogram.largest_change() * volume.range.span()];
            layer.materials.push(MaterialBox {
                values: [middle - half, middle + half],
                changes,
                ..fresh(layer)
            });
            self.selected = layer.materials.len() - 1;
        }
        // Clicks in the picture are on the first layer.
        if volume.layer == 0 && named(ui, true, text::materials::PICK) {
            commands.push(AppCommand::PickMaterials);
        }
        let Some(material) = layer.materials.get_mut(self.selected) else { return };
        color_button(ui, text::materials::COLOR, &mut material.color);
        let share = |value| DragValue::new(value).speed(0.005).range(0.0..=1.0).fixed_decimals(2);
        let label = ui.label(text::materials::OPACITY.name);
        let field = ui.add(share(&mut material.opacity)).labelled_by(label.id);
        field.on_hover_text(text::materials::OPACITY.tooltip);
        let label = ui.label(text::materials::SOFTNESS.name);
        let field = ui.add(share(&mut material.softness)).labelled_by(label.id);
        field.on_hover_text(text::materials::SOFTNESS.tooltip);
        interval_fields(ui, text::materials::VALUES, &mut material.values, volume.range);
        interval_fields(ui, text::materials::CHANGES, &mut material.changes, volume.range);
        if named(ui, true, text::materials::REMOVE) {
            layer.materials.remove(self.selected);
        }
    }

    /// Begins, continues and ends drags; a click selects.
    fn drag(&mut self, response: &Response, plane: &MaterialPlane, layer: &mut VolumeLayer) {
        let pressed = response.ctx.input(|input| input.pointer.press_origin());
        if response.drag_started()
            && let Some(at) = pressed
        {
            let fresh = fresh(layer);
            self.drag = BoxDrag::begin(plane, at, &mut layer.materials, self.selected, fresh);
        } else if response.clicked()
            && let Some(at) = response.interact_pointer_pos()
            && let Some(index) =
                layer.materials.iter().rposition(|material| plane.rect(material).contains(at))
        {
            self.selected = index;
        }
        let Some(drag) = self.drag else { return };
        self.selected = drag.index;
        if let (Some(at), Some(material)) =
            (response.interact_pointer_pos(), layer.materials.get_mut(drag.index))
        {
            drag.update(plane, at, material);
        }
        if !response.dragged() {
            self.drag = None;
        }
    }

    /// Removes the selected material by the keyboard, with the pointer over the plane.
    fn edit_by_keys(&self, ui: &Ui, response: &Response, layer: &mut VolumeLayer) {
        let is_typing = ui.ctx().text_edit_focused() || ui.memory(egui::Memory::focused).is_some();
        let removes =
            |input: &egui::InputState| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace);
        if response.contains_pointer()
            && !is_typing
            && ui.input(removes)
            && self.selected < layer.materials.len()
        {
            layer.materials.remove(self.selected);
        }
    }
}

/// Material to be added to a layer, in the first colour that none has.
fn fresh(layer: &VolumeLayer) -> MaterialBox {
    let is_free = |color: &&[f32; 3]| layer.materials.iter().all(|material| material.color != **color);
    let color = MATERIAL_COLORS.iter().find(is_free).copied().unwrap_or(MATERIAL_COLORS[0]);
    MaterialBox { color, ..MaterialBox::default() }
}

/// Shows fields of the lower and of the upper end of an interval.
fn interval_fields(ui: &mut Ui, named: ControlText, ends: &mut [f64; 2], range: ValueRange) {
    let label = ui.label(named.name).on_hover_text(named.tooltip);
    let [mut low, mut high] = *ends;
    let field = |value| {
        DragValue::new(value).speed(range.span().max(1e-12) / 500.0).max_decimals(range_decimals(range))
    };
    ui.add(field(&mut low)).labelled_by(label.id).on_hover_text(named.tooltip);
    ui.label("…");
    ui.add(field(&mut high)).labelled_by(label.id).on_hover_text(named.tooltip);
    if [low, high] != *ends {
        *ends = [low.min(high), high.max(low)];
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, pos2, vec2};

    use super::*;
    use chiaroscuro_scene::ControlPoint;

    const RANGE: ValueRange = ValueRange::new(0.0, 100.0);

    fn plane() -> MaterialPlane {
        let area = Rect::from_min_size(pos2(20.0, 30.0), vec2(416.0, 114.0));
        let shown = ShownValues { low: RANGE.low, high: RANGE.high, is_whole: true };
        MaterialPlane { axes: PlotAxes::new(area, shown, theme::PlotColors::DARK), largest: 20.0 }
    }

    fn at(value: f64, change: f64) -> egui::Pos2 {
        plane().axes.position(value, change / 20.0)
    }

    fn dragged(materials: &mut Vec<MaterialBox>, from: [f64; 2], to: [f64; 2]) {
        let plane = plane();
        let [from, to] = [from, to].map(|[value, change]| at(value, change));
        let drag = BoxDrag::begin(&plane, from, materials, 0, MaterialBox::default()).unwrap();
        drag.update(&plane, to, &mut materials[drag.index]);
    }

    fn assert_near(found: [f64; 2], expected: [f64; 2]) {
        assert!((0..2).all(|end| (found[end] - expected[end]).abs() < 0.3), "{found:?} {expected:?}");
    }

    #[test]
    fn boxes_are_drawn_moved_and_resized() {
        let mut materials = Vec::new();
        dragged(&mut materials, [20.0, 4.0], [60.0, 12.0]);
        assert_near(materials[0].values, [20.0, 60.0]);
        assert_near(materials[0].changes, [4.0, 12.0]);
        dragged(&mut materials, [40.0, 8.0], [50.0, 9.0]);
        assert_near(materials[0].values, [30.0, 70.0]);
        assert_near(materials[0].changes, [5.0, 13.0]);
        dragged(&mut materials, [30.0, 9.0], [90.0, 9.0]);
        assert_near(materials[0].values, [70.0, 90.0]);
        assert_near(materials[0].changes, [5.0, 13.0]);
        dragged(&mut materials, [90.0, 13.0], [100.0, 20.0]);
        assert_eq!([materials[0].values[1], materials[0].changes[1]], [100.0, 100.0], "open at the borders");
        dragged(&mut materials, [80.0, 15.0], [10.0, 3.0]);
        assert_near(materials[0].values, [0.0, 30.0]);
        assert_eq!(materials.len(), 1);
    }

    #[test]
    fn a_curve_becomes_the_material_of_its_visible_values() {
        let point = |value, opacity| ControlPoint::new(value, [0.2, 0.4, 0.6], opacity);
        let points = vec![point(0.0, 0.0), point(50.0, 0.0), point(60.0, 0.8), point(100.0, 0.8)];
        let curve = TransferFunction { points, ..TransferFunction::default() };
        let found = material_of_curve(&curve, RANGE);
        assert_near(found.values, [51.2, 100.0]);
        assert_eq!((found.color, found.opacity, found.changes), ([0.2, 0.4, 0.6], 0.8, [0.0, 100.0]));
        let empty = material_of_curve(&TransferFunction::default(), RANGE);
        assert_eq!((empty.values, empty.opacity), ([40.0, 100.0], 0.5));
    }
}
