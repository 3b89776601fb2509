//! Fields for the selected control points: value, opacity, colour, and the interpolation to the next point.

use eframe::egui::{self, DragValue, Slider, Ui};

use super::super::panels::controls::color_button;
use super::super::text;
use super::super::text::common::DEGREES;
use crate::app::common::overlay_windows;
use crate::app::common::volume_facts::range_decimals;
use chiaroscuro_scene::{
    ControlPoint, Easing, TransferFunction, lab_from_lch, lch_from_lab, linear_from_oklab, linear_from_srgb,
    oklab_from_linear, srgb_from_linear,
};
use chiaroscuro_volume::ValueRange;

/// Interpolations from a point to the next, with their names.
const EASINGS: [(Easing, &str); 3] = [
    (Easing::Linear, text::transfer::LINEAR),
    (Easing::Smooth, text::transfer::SMOOTH),
    (Easing::Step, text::transfer::STEP),
];

/// Largest chroma of the slider (Oklab); the most saturated colours of displays have about this.
const MAX_CHROMA: f64 = 0.33;

/// Value ranges of the fields of a volume's control points.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointFieldRanges {
    /// Values that the axis of the plot spans.
    pub span: ValueRange,
    /// Values within which points can be moved.
    pub limits: ValueRange,
}

/// Shows the fields of one point, or of several at once; returns true if the points are to be removed.
pub(super) fn point_fields(
    ui: &mut Ui,
    function: &mut TransferFunction,
    selected: &[usize],
    values: PointFieldRanges,
    has_colors: bool,
) -> bool {
    let Some(&first) = selected.first() else { return false };
    let mut point = function.points[first];
    let before = point;
    if selected.len() == 1 {
        let (low, high) = point_value_range(function, first, values.limits);
        let label = ui.label(text::transfer::POINT_VALUE);
        let speed = values.span.span().max(1e-12) / 500.0;
        let field = DragValue::new(&mut point.value).range(low..=high).speed(speed);
        ui.add(field.max_decimals(range_decimals(values.span))).labelled_by(label.id);
    } else {
        ui.label(text::transfer::point_count(selected.len()));
    }
    let label = ui.label(text::transfer::POINT_OPACITY);
    ui.add(DragValue::new(&mut point.opacity).range(0.0..=1.0).speed(0.005).fixed_decimals(3))
        .labelled_by(label.id);
    if has_colors {
        color_button(ui, text::transfer::POINT_COLOR, &mut point.color);
        oklch_menu(ui, &mut point.color);
    }
    easing_menu(ui, &mut point.easing);
    // Edited fields apply to all selected points; each keeps its own value.
    for &index in selected {
        let other = &mut function.points[index];
        if point.opacity != before.opacity {
            other.opacity = point.opacity;
        }
        if point.color != before.color {
            other.color = point.color;
        }
        if point.easing != before.easing {
            other.easing = point.easing;
        }
    }
    function.points[first].value = point.value;
    ui.add_enabled(function.points.len() > 1, egui::Button::new(text::transfer::REMOVE)).clicked()
}

/// Sliders for lightness, chroma and hue (Oklab `LCh`), to match the lightness or saturation of other colours.
fn oklch_menu(ui: &mut Ui, srgb: &mut [f32; 3]) {
    let menu = overlay_windows::scrolling_menu(ui, text::transfer::OKLCH.name, |ui| {
        let linear = srgb.map(|c| linear_from_srgb(f64::from(c)));
        let mut lch = lch_from_lab(oklab_from_linear(linear));
        let mut changed = false;
        let [lightness, chroma, hue] = &mut lch;
        egui::Grid::new("lightness, chroma, hue").num_columns(2).show(ui, |ui| {
            for (value, maximum, name, unit) in [
                (lightness, 1.0, text::transfer::LIGHTNESS, ""),
                (chroma, MAX_CHROMA, text::transfer::CHROMA, ""),
                (hue, 360.0, text::transfer::HUE, DEGREES),
            ] {
                ui.label(name);
                let slider = Slider::new(value, 0.0..=maximum).suffix(unit).max_decimals(3);
                // Showing a colour must not round it; only edits are clamped.
                let slider = slider.clamping(egui::SliderClamping::Edits);
                changed |= ui.name_inputs(name, |ui| ui.add(slider)).changed();
                ui.end_row();
            }
        });
        if changed {
            *srgb = linear_from_oklab(lab_from_lch(lch)).map(|c| srgb_from_linear(c) as f32);
        }
    });
    menu.response.on_hover_text(text::transfer::OKLCH.tooltip);
}

fn easing_menu(ui: &mut Ui, easing: &mut Easing) {
    let name = EASINGS.iter().find(|(way, _)| way == easing).map_or("", |(_, name)| name);
    let menu = overlay_windows::scrolling_menu(ui, name, |ui| {
        for (way, name) in EASINGS {
            if ui.selectable_label(*easing == way, name).clicked() {
                *easing = way;
                ui.close();
            }
        }
    });
    menu.response.on_hover_text(text::transfer::INTERPOLATION_TIP);
}

/// Values between which a point can be moved: its neighbours, or the ends of the range.
fn point_value_range(function: &TransferFunction, index: usize, range: ValueRange) -> (f64, f64) {
    let points: &[ControlPoint] = &function.points;
    let low = index.checked_sub(1).map_or(range.low, |before| points[before].value);
    let high = points.get(index + 1).map_or(range.high, |after| after.value);
    // Points from a preset may lie beyond this volume's values.
    let value = points[index].value;
    (low.min(value), high.max(value))
}
