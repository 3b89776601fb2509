//! The transfer function editor: wide and low, values run horizontally and need room.
//!
//! Both curves share one plot: the eye's, filled with its colours, and the lighting one as a single
//! amber line, dashed while it follows the eye's.

mod menus;
mod plot;
mod zoom;

use eframe::egui::{self, DragValue, Key, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo};

use self::plot::Axes;
use self::zoom::Zoom;
use super::commands::Command;
use super::panels::controls::color;
use super::theme;
use super::volume_facts::VolumeFacts;
use crate::model::{ControlPoint, Settings, TransferFunction};

/// Which curve is edited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Curve {
    /// What the eye sees.
    #[default]
    Eye,
    /// What light meets.
    Light,
}

/// State of the editor between frames.
#[derive(Debug)]
pub(super) struct TransferEditor {
    curve: Curve,
    selected: Option<usize>,
    /// Rare values are raised so that they can be seen.
    log_histogram: bool,
    /// Values that are shown, if not all.
    zoom: Zoom,
}

impl Default for TransferEditor {
    fn default() -> Self {
        Self { curve: Curve::Eye, selected: None, log_histogram: true, zoom: Zoom::default() }
    }
}

/// The steps of the arrow keys: shares of the axes.
const NUDGE: [f64; 2] = [1.0 / 256.0, 0.01];

impl TransferEditor {
    /// Shows the editor in the whole of `ui`.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        settings: &mut Settings,
        volume: &VolumeFacts,
        marked: Option<f64>,
        commands: &mut Vec<Command>,
    ) {
        if settings.lighting.linked {
            self.curve = Curve::Eye;
        }
        ui.horizontal(|ui| self.tools(ui, settings, volume, commands));
        let size = ui.available_size();
        let (area, response) = ui.allocate_exact_size(size.max(Vec2::splat(20.0)), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Transfer function"));
        self.zoom.ui(ui, &response, area, volume.range);
        let axes = Axes::new(area, self.zoom.shown(volume.range));
        self.paint(ui, &axes, settings, volume);
        let light = self.curve == Curve::Light;
        let name = if light { "Light point" } else { "Eye point" };
        let function = if light { &mut settings.lighting.curve } else { &mut settings.transfer };
        self.add_point(&response, &axes, function);
        self.edit_points(ui, &axes, function, name);
        plot::readout(ui, &axes, &response, settings);
        plot::mark(ui, &axes, marked);
    }

    fn tools(
        &mut self,
        ui: &mut Ui,
        settings: &mut Settings,
        volume: &VolumeFacts,
        commands: &mut Vec<Command>,
    ) {
        let before = self.curve;
        ui.selectable_value(&mut self.curve, Curve::Eye, "Eye").on_hover_text("Edit what the eye sees");
        ui.add_enabled_ui(!settings.lighting.linked, |ui| {
            let label = ui.selectable_value(&mut self.curve, Curve::Light, "Light");
            label
                .on_hover_text("Edit what light meets")
                .on_disabled_hover_text("Light follows the eye's opacity; unlink it in the section Shadows");
        });
        if self.curve != before {
            self.selected = None;
        }
        ui.separator();
        let light = self.curve == Curve::Light;
        let function = if light { &mut settings.lighting.curve } else { &mut settings.transfer };
        self.selected = self.selected.filter(|&index| index < function.points.len());
        if let Some(index) = self.selected {
            self.point_fields(ui, function, index, volume.range, light);
        } else {
            menus::whole_curve(ui, function, volume.range);
            let fit = ui.button("Fit").on_hover_text("Spreads the points over the values that occur");
            if fit.clicked() {
                menus::fit(function, volume);
            }
            let bump = ui.button("Bump").on_hover_text("Adds a smooth bump of opacity: a band of values");
            if bump.clicked() {
                menus::add_bump(function, self.zoom.shown(volume.range));
            }
            ui.add(
                egui::Label::new(egui::RichText::new("Click adds a point, wheel zooms").weak()).truncate(),
            );
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let button = ui.button("Automatic").on_hover_text("Puts the automatic transfer function back");
            if button.clicked() {
                self.selected = None;
                commands.push(Command::AutomaticTransfer);
            }
            ui.checkbox(&mut self.log_histogram, "Log histogram")
                .on_hover_text("Raises rare values in the histogram");
            menus::colors(ui, commands);
            menus::presets(ui, commands);
            self.zoom.button(ui);
        });
    }

    fn point_fields(
        &mut self,
        ui: &mut Ui,
        function: &mut TransferFunction,
        index: usize,
        range: (f64, f64),
        light: bool,
    ) {
        let (low, high) = neighbours(function, index, range);
        let point = &mut function.points[index];
        let label = ui.label("Value");
        let speed = (range.1 - range.0).max(1e-12) / 500.0;
        ui.add(DragValue::new(&mut point.value).range(low..=high).speed(speed)).labelled_by(label.id);
        let label = ui.label("Opacity");
        ui.add(DragValue::new(&mut point.opacity).range(0.0..=1.0).speed(0.005).max_decimals(3))
            .labelled_by(label.id);
        if !light {
            color(ui, "Colour of the point", &mut point.color);
        }
        if ui.add_enabled(function.points.len() > 1, egui::Button::new("Remove")).clicked() {
            self.remove(function, index);
        }
    }

    fn paint(&self, ui: &Ui, axes: &Axes, settings: &Settings, volume: &VolumeFacts) {
        let painter = ui.painter_at(axes.area);
        plot::checkerboard(&painter, axes.area);
        let bars =
            plot::bars(&volume.histogram, volume.levels, axes.width() * self.zoom.factor(volume.range));
        plot::histogram(&painter, axes, volume.range, &bars, self.log_histogram);
        plot::eye_curve(&painter, axes, &settings.transfer, self.curve == Curve::Eye);
        plot::light_curve(&painter, axes, settings, self.curve == Curve::Light);
        plot::labels(&painter, axes);
    }

    fn add_point(&mut self, response: &Response, axes: &Axes, function: &mut TransferFunction) {
        if !response.clicked() {
            return;
        }
        if let Some(at) = response.interact_pointer_pos() {
            let (value, opacity) = axes.values(at);
            let index = function.points.partition_point(|point| point.value <= value);
            let color = plot::srgb(function.at(value).0);
            function.points.insert(index, ControlPoint::new(value, color, opacity));
            self.selected = Some(index);
        }
    }

    fn edit_points(&mut self, ui: &Ui, axes: &Axes, function: &mut TransferFunction, name: &str) {
        let painter = ui.painter_at(axes.area.expand(theme::POINT_RADIUS + 2.0));
        let mut removed = None;
        for index in 0..function.points.len() {
            if !axes.shows(function.points[index].value) {
                continue;
            }
            let at = axes.position(function.points[index].value, function.points[index].opacity);
            let area = Rect::from_center_size(at, Vec2::splat(2.0 * theme::POINT_RADIUS + 6.0));
            let id = ui.scope_id().with((name, index));
            let response = ui.interact(area, id, Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, format!("{name} {}", index + 1)));
            if response.clicked() || response.drag_started() {
                self.selected = Some(index);
                response.request_focus();
            }
            if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
                let (low, high) = neighbours(function, index, axes.range);
                let (value, opacity) = axes.values(pointer);
                let point = &mut function.points[index];
                (point.value, point.opacity) = (value.clamp(low, high), opacity);
            }
            if response.has_focus() {
                nudge(ui, id, axes, function, index);
            }
            let focused = response.has_focus() || self.selected == Some(index);
            let deletes = |input: &egui::InputState| {
                input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace)
            };
            let delete = focused && !typing_elsewhere(ui, id) && ui.input(deletes);
            if response.double_clicked() || delete {
                removed = Some(index);
            }
            if response.hovered() || response.dragged() {
                ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
            }
            let point = function.points[index];
            plot::point(
                &painter,
                axes.position(point.value, point.opacity),
                theme::POINT_RADIUS + if response.hovered() { 1.0 } else { 0.0 },
                theme::color(point.color),
                focused,
            );
        }
        if let Some(index) = removed {
            self.remove(function, index);
        }
    }

    fn remove(&mut self, function: &mut TransferFunction, index: usize) {
        // A function without points would be invisible for good.
        if function.points.len() > 1 {
            function.points.remove(index);
            self.selected = None;
        }
    }
}

/// Whether another widget has the keyboard.
fn typing_elsewhere(ui: &Ui, id: egui::Id) -> bool {
    ui.memory(egui::Memory::focused).is_some_and(|focused| focused != id)
}

/// The values between which a point can be moved.
fn neighbours(function: &TransferFunction, index: usize, range: (f64, f64)) -> (f64, f64) {
    let points = &function.points;
    let low = index.checked_sub(1).map_or(range.0, |before| points[before].value);
    let high = points.get(index + 1).map_or(range.1, |after| after.value);
    // Points from a preset may lie beyond this volume's values.
    let value = points[index].value;
    (low.min(value), high.max(value))
}

/// Arrow keys move the focused point.
fn nudge(ui: &Ui, id: egui::Id, axes: &Axes, function: &mut TransferFunction, index: usize) {
    let arrows = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
    let presses = |less: Key, more: Key| {
        ui.input(|input| input.num_presses(more) as f64 - input.num_presses(less) as f64)
    };
    let (right, up) = (presses(Key::ArrowLeft, Key::ArrowRight), presses(Key::ArrowDown, Key::ArrowUp));
    if right != 0.0 || up != 0.0 {
        let (low, high) = neighbours(function, index, axes.range);
        let point = &mut function.points[index];
        let span = axes.range.1 - axes.range.0;
        point.value = (point.value + right * NUDGE[0] * span).clamp(low, high);
        point.opacity = (point.opacity + up * NUDGE[1]).clamp(0.0, 1.0);
    }
}
