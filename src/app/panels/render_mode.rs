//! Rows of the render mode, at the top of the section "Shading".

use eframe::egui::{self, Ui};

use super::PanelContext;
use super::controls::{choice_row, format_number, reset_button_cell, row, switch_row};
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_scene::{RenderMode, Settings};

/// Share of the range by which a drag of one point changes the isovalue: 500 points cover it.
const DRAG_SPEED: f64 = 1.0 / 500.0;

/// Shows the choice of the mode and what it needs.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let settings = &mut *panels.settings;
    // Labels have no order, in which a value could be the largest.
    let is_by_value = settings.layer().labels.is_empty();
    let modes = RenderMode::ALL.map(|mode| (mode, text::shading::mode_text(mode)));
    ui.add_enabled_ui(is_by_value, |ui| choice_row(ui, text::shading::MODE, &mut settings.mode.kind, &modes));
    match settings.render_mode() {
        RenderMode::Surface => isovalue_row(ui, settings, panels.volume),
        RenderMode::Maximum => drop(switch_row(ui, text::shading::LIT, &mut settings.mode.lit)),
        RenderMode::Matter | RenderMode::Minimum | RenderMode::Mean => {}
    }
    if settings.is_unlit() {
        ui.weak(text::shading::UNLIT);
    }
}

/// Shows the value of the surface, with a button that takes it from the curve again.
fn isovalue_row(ui: &mut Ui, settings: &mut Settings, volume: Option<&VolumeFacts>) {
    let named = text::shading::ISOVALUE;
    let span = volume.map_or(1.0, |volume| settings.shown_range(&volume.ranges).span());
    row(ui, named, |ui| {
        let mut value = settings.isovalue();
        let field = egui::DragValue::new(&mut value).speed(span.max(f64::MIN_POSITIVE) * DRAG_SPEED);
        let field = field.custom_formatter(|value, _| format_number(value));
        if ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip).changed() {
            settings.mode.isovalue = Some(value);
        }
        let from_curve = settings.mode.isovalue.map(|_| text::shading::ISOVALUE_OF_CURVE);
        if reset_button_cell(ui, named.name, from_curve) {
            settings.mode.isovalue = None;
        }
    });
}
