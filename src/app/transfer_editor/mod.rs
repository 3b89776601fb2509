//! Transfer function editor: wide and low, because values run horizontally and need room.
//!
//! Both curves share one plot: the eye's, filled with its colours, and the lighting curve as a single amber line,
//! dashed while it is linked to the eye's.

mod backdrop;
mod freehand;
mod label_table;
mod layer_tabs;
mod link_button;
mod materials;
mod menus;
pub(super) mod plot;
mod point_fields;
mod preset_menu;
mod preset_thumbnails;
mod selection;
mod zoom;

use eframe::egui::{self, Key, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo};

use self::backdrop::{HistogramBars, PlotBackdrop};
use self::freehand::FreehandDrawing;
use self::materials::MaterialEditor;
use self::plot::{PlotAxes, PlotMarks};
use self::preset_menu::PresetMenu;
use self::selection::{PointSelection, PointShift};
use self::zoom::{AxisSpan, PlotZoom, point_limits};
use super::common::commands::AppCommand;
use super::common::theme;
use super::common::volume_facts::VolumeFacts;
use super::text;
use crate::app::panels::set_linked;
use chiaroscuro_render::WindowPainter;
use chiaroscuro_scene::{Settings, TransferFunction};
use chiaroscuro_volume::ValueRange;

/// Curve that the editor edits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum EditedCurve {
    /// Transfer function that the eye sees.
    #[default]
    Eye,
    /// Lighting curve: opacity for the light pass.
    Light,
}

/// State of the editor between frames.
#[derive(Debug)]
pub(super) struct TransferEditor {
    curve: EditedCurve,
    /// Index of the layer of the last frame.
    layer: usize,
    selection: PointSelection,
    /// Curve as the last frame left it; the selection refers to its points.
    last_curve: TransferFunction,
    /// True for a logarithmic histogram, so that rare values are visible.
    log_histogram: bool,
    /// Range of values that the plot shows, if not all.
    zoom: PlotZoom,
    axis_span: AxisSpan,
    backdrop: PlotBackdrop,
    freehand: FreehandDrawing,
    presets: PresetMenu,
    materials: MaterialEditor,
}

impl TransferEditor {
    /// Creates the editor for a window.
    pub(super) fn new(window: WindowPainter) -> Self {
        Self {
            backdrop: PlotBackdrop::new(window),
            curve: EditedCurve::Eye,
            layer: 0,
            selection: PointSelection::default(),
            last_curve: TransferFunction::default(),
            log_histogram: true,
            zoom: PlotZoom::default(),
            axis_span: AxisSpan::default(),
            freehand: FreehandDrawing::default(),
            presets: PresetMenu::default(),
            materials: MaterialEditor::default(),
        }
    }
}

/// Steps of the arrow keys along value and opacity, as shares of the axes.
const KEY_STEP: [f64; 2] = [1.0 / 256.0, 0.01];

/// Width at which all tools fit side by side, in points: those of the curve take at most 590, the others 510.
const WIDE_LAYOUT_WIDTH: f32 = 1100.0;

impl TransferEditor {
    /// Takes layer and index of the material under the pointer, if the plane of materials has just been shown.
    pub(super) fn take_hovered_material(&mut self) -> Option<(usize, usize)> {
        Some((self.layer, self.materials.take_hovered()?))
    }

    /// Shows the editor of the selected layer in the whole of `ui`. `volume`: facts about the first volume; `marks`:
    /// what the picture marks of it.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        settings: &mut Settings,
        (volume, selected_layer): (&VolumeFacts, &mut usize),
        marks: PlotMarks,
        commands: &mut Vec<AppCommand>,
    ) {
        layer_tabs::show(ui, settings, volume, selected_layer);
        let volume = volume.of_layer(*selected_layer);
        let marks = if volume.layer == 0 { marks } else { PlotMarks::default() };
        if std::mem::replace(&mut self.layer, volume.layer) != volume.layer {
            self.selection.clear();
            self.zoom = PlotZoom::default();
            self.axis_span = AxisSpan::default();
        }
        if volume.is_shown_by_label(settings) {
            return label_table::show(ui, settings, volume, commands);
        }
        if settings.layer_at(volume.layer).has_materials() {
            return self.materials.show(ui, settings.layer_at_mut(volume.layer), volume, marks, commands);
        }
        if settings.layer_at(volume.layer).lighting.linked {
            self.curve = EditedCurve::Eye;
        }
        if *self.edited_curve(settings, volume.layer) != self.last_curve {
            // The curve was changed elsewhere: its points may be others.
            self.selection.clear();
        }
        // Held also in the frame of the release, in which the last movement counts.
        let is_held = ui.input(|input| input.pointer.any_down() || input.pointer.any_released());
        let span = self.axis_span.update(is_held, volume.ranges, volume.range);
        let letters = egui::TextStyle::Button.resolve(ui.style()).size / theme::FONT_SIZE;
        let is_wide = ui.available_width() >= WIDE_LAYOUT_WIDTH * letters;
        let from_the_right = egui::Layout::right_to_left(egui::Align::Center);
        ui.horizontal(|ui| {
            let is_whole = self.curve_tools(ui, settings, volume, span, commands);
            if is_wide {
                ui.with_layout(from_the_right, |ui| {
                    self.plot_tools(ui, settings, volume, commands);
                    if is_whole {
                        self.show_hint(ui);
                    }
                });
            }
        });
        if !is_wide {
            let row = Vec2::new(ui.available_width(), ui.spacing().interact_size.y);
            ui.allocate_ui_with_layout(row, from_the_right, |ui| {
                self.plot_tools(ui, settings, volume, commands);
            });
        }
        let size = ui.available_size();
        let (area, response) = ui.allocate_exact_size(size.max(Vec2::splat(20.0)), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, text::transfer::PLOT));
        self.zoom.ui(ui, &response, area, span);
        let axes =
            PlotAxes::new(area, self.zoom.visible_range(span), theme::PlotColors::for_visuals(ui.visuals()));
        self.paint(ui, &axes, settings, volume);
        let name = if self.curve == EditedCurve::Light {
            text::transfer::LIGHT_POINT
        } else {
            text::transfer::EYE_POINT
        };
        let function = self.edited_curve(settings, volume.layer);
        if self.freehand.is_active {
            self.selection.clear();
            self.freehand.draw(ui, &response, &axes, function);
        } else {
            self.add_point(&response, &axes, function);
            self.selection.rubber_band(ui, &response, &axes, function);
            self.selection.select_by_keys(ui, &response, function.points.len());
            let limits = point_limits(volume.ranges, span);
            self.edit_points(ui, &axes, function, name, limits, response.contains_pointer());
        }
        self.last_curve = self.edited_curve(settings, volume.layer).clone();
        plot::paint_readout(ui, &axes, &response, &settings.layer_at(volume.layer).transfer);
        plot::paint_value_mark(ui, &axes, marks.value);
    }

    /// Shows the tools that edit the curve or the selected points; returns true if no point is selected. `span`:
    /// values that the axis spans.
    fn curve_tools(
        &mut self,
        ui: &mut Ui,
        settings: &mut Settings,
        volume: &VolumeFacts,
        span: ValueRange,
        commands: &mut Vec<AppCommand>,
    ) -> bool {
        let before = self.curve;
        let eye = ui.selectable_value(&mut self.curve, EditedCurve::Eye, text::transfer::EYE.name);
        eye.on_hover_text(text::transfer::EYE.tooltip);
        link_button::show(ui, settings.layer_at_mut(volume.layer));
        let light = ui.selectable_value(&mut self.curve, EditedCurve::Light, text::transfer::LIGHT.name);
        let is_linked = settings.layer_at(volume.layer).lighting.linked;
        let tip = if is_linked { text::transfer::LINKED_TIP } else { text::transfer::LIGHT.tooltip };
        if light.on_hover_text(tip).clicked() && is_linked {
            // Selecting the lighting curve to edit it implies a separate curve.
            set_linked(settings.layer_at_mut(volume.layer), false);
        }
        if self.curve != before {
            self.selection.clear();
        }
        ui.separator();
        // With coloured shadows, light that passes material takes its hue.
        let has_colors = self.curve == EditedCurve::Eye || settings.has_colored_shadows();
        let layer = settings.layer_at_mut(volume.layer);
        let (function, materials) = match self.curve {
            EditedCurve::Eye => (&mut layer.transfer, &mut layer.materials),
            EditedCurve::Light => (&mut layer.lighting.curve, &mut layer.materials),
        };
        let selected = self.selection.retained_indices(function.points.len());
        if selected.is_empty() {
            menus::curve_fields(ui, function, span);
            if menus::shape_menu(ui, function, volume, self.zoom.visible_range(span), commands) {
                materials.push(materials::material_of_curve(function, volume.range));
            }
            let draw = text::transfer::FREEHAND;
            let draws = ui.toggle_value(&mut self.freehand.is_active, draw.name).on_hover_text(draw.tooltip);
            menus::highlight_if_searched(ui, draw, &draws);
        } else if point_fields::point_fields(
            ui,
            function,
            &selected,
            point_fields::PointFieldRanges { span, limits: point_limits(volume.ranges, span) },
            has_colors,
        ) {
            self.selection.remove_points(function);
        }
        selected.is_empty()
    }

    /// Shows the hint for the plot's gestures, truncated to the width that is left.
    fn show_hint(&self, ui: &mut Ui) {
        let hint = if self.freehand.is_active { text::transfer::DRAW_HINT } else { text::transfer::HINT };
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.add(egui::Label::new(egui::RichText::new(hint).weak()).truncate());
        });
    }

    /// Returns the curve of a layer that is being edited.
    fn edited_curve<'a>(&self, settings: &'a mut Settings, layer: usize) -> &'a mut TransferFunction {
        match self.curve {
            EditedCurve::Eye => &mut settings.layer_at_mut(layer).transfer,
            EditedCurve::Light => &mut settings.layer_at_mut(layer).lighting.curve,
        }
    }

    /// Shows the tools that replace the whole curve, and the options of the plot.
    fn plot_tools(
        &mut self,
        ui: &mut Ui,
        settings: &mut Settings,
        volume: &VolumeFacts,
        commands: &mut Vec<AppCommand>,
    ) {
        let function = self.edited_curve(settings, volume.layer);
        let automatic = text::transfer::AUTOMATIC;
        if ui.button(automatic.name).on_hover_text(automatic.tooltip).clicked() {
            self.selection.clear();
            commands.push(AppCommand::AutomaticTransfer);
        }
        let log = text::transfer::LOG_HISTOGRAM;
        let tick = ui.checkbox(&mut self.log_histogram, log.name).on_hover_text(log.tooltip);
        menus::highlight_if_searched(ui, log, &tick);
        menus::color_map_menu(ui, function, commands);
        self.presets.show(ui, settings, volume, commands);
        self.zoom.show_reset_button(ui);
    }

    fn paint(&mut self, ui: &Ui, axes: &PlotAxes, settings: &Settings, volume: &VolumeFacts) {
        let painter = ui.painter_at(axes.area);
        let counts = plot::histogram_bars(
            &volume.histogram,
            volume.levels,
            axes.width() * self.zoom.zoom_factor(volume.range),
        );
        let bars = HistogramBars { range: volume.range, counts, log: self.log_histogram };
        let layer = settings.layer_at(volume.layer);
        painter.add(self.backdrop.shape(axes, ui.pixels_per_point(), bars, &layer.transfer));
        plot::paint_eye_curve(&painter, axes, &layer.transfer, self.curve == EditedCurve::Eye);
        plot::paint_light_curve(&painter, axes, layer, self.curve == EditedCurve::Light);
        plot::paint_axis_labels(&painter, axes, text::transfer::OPACITY_ONE);
    }

    fn add_point(&mut self, response: &Response, axes: &PlotAxes, function: &mut TransferFunction) {
        if !response.clicked() {
            return;
        }
        if let Some(at) = response.interact_pointer_pos() {
            let (value, opacity) = axes.value_and_opacity_at(at);
            let index = function.add_point(value, opacity, axes.range);
            self.selection.select_only(index);
        }
    }

    /// Shows the points and handles their selection, movement and removal. `range`: values within which they can be
    /// moved; `hovered`: the pointer is on the plot.
    fn edit_points(
        &mut self,
        ui: &Ui,
        axes: &PlotAxes,
        function: &mut TransferFunction,
        name: &str,
        range: ValueRange,
        hovered: bool,
    ) {
        let painter = ui.painter_at(axes.area.expand(theme::POINT_RADIUS + 2.0));
        let id_of = |index: usize| ui.scope_id().with((name, index));
        let focused = ui.memory(egui::Memory::focused);
        let on_point = (0..function.points.len()).any(|index| focused == Some(id_of(index)));
        let deletes =
            |input: &egui::InputState| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace);
        // The user may be typing in a field, or working elsewhere.
        let mut removes = (on_point || (focused.is_none() && hovered)) && ui.input(deletes);
        for index in 0..function.points.len() {
            if !axes.contains_value(function.points[index].value) {
                continue;
            }
            let at = axes.position(function.points[index].value, function.points[index].opacity);
            let area = Rect::from_center_size(at, Vec2::splat(2.0 * theme::POINT_RADIUS + 6.0));
            let id = id_of(index);
            let response = ui.interact(area, id, Sense::click_and_drag());
            response.widget_info(|| {
                WidgetInfo::labeled(Role::Slider, true, text::transfer::point_name(name, index + 1))
            });
            let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
            if response.clicked() && adds {
                self.selection.toggle(index);
            } else if response.clicked() || (response.drag_started() && !self.selection.contains(index)) {
                self.selection.select_only(index);
            }
            let is_focused = self.selection.wants_focus && self.selection.contains(index);
            if ((response.clicked() || response.drag_started()) && self.selection.contains(index))
                || is_focused
            {
                self.selection.wants_focus = false;
                response.request_focus();
            } else if response.gained_focus() && !self.selection.contains(index) {
                // Focused by the keyboard.
                self.selection.select_only(index);
            }
            if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
                let (value, opacity) = axes.value_and_opacity_at(pointer);
                let point = function.points[index];
                let by = PointShift { value: value - point.value, opacity: opacity - point.opacity };
                self.selection.move_points(function, range, by);
            }
            if response.has_focus() {
                self.nudge_selected(ui, id, axes, function, range);
            }
            let selected = self.selection.contains(index);
            if response.double_clicked() {
                self.selection.select_only(index);
                removes = true;
            }
            if response.hovered() || response.dragged() {
                ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
            }
            let point = function.points[index];
            plot::paint_point(
                &painter,
                &axes.ink,
                (
                    axes.position(point.value, point.opacity),
                    theme::POINT_RADIUS + if response.hovered() { 1.0 } else { 0.0 },
                ),
                theme::color(point.color),
                selected || response.has_focus(),
            );
        }
        if removes {
            self.selection.remove_points(function);
        }
    }

    /// Moves the selected points by the arrow keys.
    fn nudge_selected(
        &mut self,
        ui: &Ui,
        id: egui::Id,
        axes: &PlotAxes,
        function: &mut TransferFunction,
        range: ValueRange,
    ) {
        let arrows =
            egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        let presses = |less: Key, more: Key| {
            ui.input(|input| input.num_presses(more) as f64 - input.num_presses(less) as f64)
        };
        let (right, up) = (presses(Key::ArrowLeft, Key::ArrowRight), presses(Key::ArrowDown, Key::ArrowUp));
        if right != 0.0 || up != 0.0 {
            let span = axes.range.high - axes.range.low;
            let by = PointShift { value: right * KEY_STEP[0] * span, opacity: up * KEY_STEP[1] };
            self.selection.move_points(function, range, by);
        }
    }
}
