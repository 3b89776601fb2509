//! Menus of the transfer function editor: colour maps, shapes, and fields that transform the whole curve.

use eframe::egui::{self, Color32, DragValue, Mesh, Rect, Response, Sense, Ui, vec2};

use super::super::text::{self, ControlText};
use super::zoom::ShownValues;
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::{VolumeFacts, range_decimals};
use crate::app::common::{overlay_windows, reveal, theme};
use chiaroscuro_scene::{COLOR_MAPS, ColorMap, ColorMixing, ControlPoint, Easing, TransferFunction};
use chiaroscuro_volume::ValueRange;

/// Size of the swatch of a colour map, in points.
const SWATCH_SIZE: egui::Vec2 = vec2(96.0, 14.0);

/// Menu of the colour maps, with swatches, and of transfer function files.
pub(super) fn color_map_menu(ui: &mut Ui, function: &mut TransferFunction, commands: &mut Vec<AppCommand>) {
    overlay_windows::scrolling_menu(ui, text::transfer::COLORS, |ui| {
        for (at, map) in COLOR_MAPS.iter().enumerate() {
            ui.horizontal(|ui| {
                color_map_swatch(ui, map);
                if ui.button(map.name).on_hover_text(text::transfer::COLOR_MAP_TIP).clicked() {
                    commands.push(AppCommand::UseColors(at, false));
                }
                let reversed = ui.small_button(text::transfer::REVERSED);
                if reversed.on_hover_text(text::transfer::reversed_tip(map.name)).clicked() {
                    commands.push(AppCommand::UseColors(at, true));
                }
            });
        }
        ui.separator();
        for command in [AppCommand::ImportTransfer, AppCommand::ExportTransfer] {
            let button = ui.button(&*command.label()).on_hover_text(text::transfer::FILES_TIP);
            if button.clicked() {
                commands.push(command);
            }
        }
        let mut seen = function.mixing == ColorMixing::Seen;
        let mix = text::transfer::PERCEPTUAL_BLENDING;
        if ui.checkbox(&mut seen, mix.name).on_hover_text(mix.tooltip).changed() {
            function.mixing = if seen { ColorMixing::Seen } else { ColorMixing::Light };
        }
        let invert = text::transfer::INVERT;
        if ui.button(invert.name).on_hover_text(invert.tooltip).clicked() {
            commands.push(AppCommand::InvertTransfer);
        }
    });
}

fn color_map_swatch(ui: &mut Ui, map: &ColorMap) {
    let (area, _) = ui.allocate_exact_size(SWATCH_SIZE, Sense::hover());
    let mut mesh = Mesh::default();
    for i in 0..8 {
        let left = area.min.x + SWATCH_SIZE.x * i as f32 / 8.0;
        let part =
            Rect::from_min_size(egui::pos2(left, area.min.y), vec2(SWATCH_SIZE.x / 8.0, SWATCH_SIZE.y));
        let ink = |stop: i32| -> Color32 { theme::color(map.at(f64::from(stop) / 8.0)) };
        let base = mesh.vertices.len() as u32;
        for (corner, color) in [
            (part.left_top(), ink(i)),
            (part.right_top(), ink(i + 1)),
            (part.left_bottom(), ink(i)),
            (part.right_bottom(), ink(i + 1)),
        ] {
            mesh.colored_vertex(corner, color);
        }
        mesh.add_triangle(base, base + 1, base + 2);
        mesh.add_triangle(base + 1, base + 3, base + 2);
    }
    ui.painter().add(mesh);
}

/// Highlights a control for a moment if the user has searched for it.
pub(super) fn highlight_if_searched(ui: &Ui, named: ControlText, control: &Response) {
    reveal::highlight_row(ui, text::transfer::TITLE, named.name, control.rect);
}

/// Fields that move the whole curve, stretch it, or scale its opacity. Limits keep points near the volume's values.
pub(super) fn curve_fields(ui: &mut Ui, function: &mut TransferFunction, range: ValueRange) {
    let (Some(&first), Some(&last)) = (function.points.first(), function.points.last()) else { return };
    let span = (range.high - range.low).max(1e-12);
    let (middle, width) = (f64::midpoint(first.value, last.value), last.value - first.value);
    let (mut new_middle, mut new_width) = (middle, width);
    let max_opacity = function.points.iter().map(|point| point.opacity).fold(0.0, f64::max);
    let mut opacity = max_opacity;
    let label = ui.label(text::transfer::OPACITY.name);
    let field = DragValue::new(&mut opacity).speed(0.005).range(0.001..=1.0).fixed_decimals(3);
    // A value from a file stays until the user changes it.
    let field = field.clamp_existing_to_range(false);
    let field = ui.add_enabled(max_opacity > 0.0, field).labelled_by(label.id);
    highlight_if_searched(ui, text::transfer::OPACITY, &field.on_hover_text(text::transfer::OPACITY.tooltip));
    if opacity != max_opacity && max_opacity > 0.0 {
        for point in &mut function.points {
            point.opacity = (point.opacity * opacity / max_opacity).min(1.0);
        }
    }
    let label = ui.label(text::transfer::LEVEL.name);
    let level = DragValue::new(&mut new_middle)
        .speed(span / 400.0)
        .range(range.low - span..=range.high + span)
        .max_decimals(range_decimals(range))
        .clamp_existing_to_range(false);
    let level = ui.add(level).labelled_by(label.id).on_hover_text(text::transfer::LEVEL.tooltip);
    highlight_if_searched(ui, text::transfer::LEVEL, &level);
    let label = ui.label(text::transfer::WINDOW.name);
    let window = DragValue::new(&mut new_width)
        .speed(span / 400.0)
        .range(span / 1000.0..=4.0 * span)
        .max_decimals(range_decimals(range))
        .clamp_existing_to_range(false);
    let window = ui.add(window).labelled_by(label.id).on_hover_text(text::transfer::WINDOW.tooltip);
    highlight_if_searched(ui, text::transfer::WINDOW, &window);
    if new_middle != middle || (new_width != width && width > 0.0) {
        let stretch = if width > 0.0 { new_width / width } else { 1.0 };
        function.shift_and_stretch(new_middle - middle, stretch);
    }
}

/// Menu of changes to the curve's shape; returns true if materials are to take its place. `shown`: values that the plot
/// shows.
pub(super) fn shape_menu(
    ui: &mut Ui,
    function: &mut TransferFunction,
    volume: &VolumeFacts,
    shown: ShownValues,
    commands: &mut Vec<AppCommand>,
) -> bool {
    let menu = overlay_windows::scrolling_menu(ui, text::transfer::SHAPE, |ui| {
        let clicked =
            |ui: &mut Ui, named: ControlText| ui.button(named.name).on_hover_text(named.tooltip).clicked();
        if clicked(ui, text::transfer::FIT) {
            fit_to_values(function, volume);
        }
        if clicked(ui, text::transfer::BUMP) {
            add_bump(function, shown);
        }
        if clicked(ui, text::transfer::BOX) {
            add_box(function, shown);
        }
        ui.separator();
        // Clicks in the picture are on the first layer.
        if volume.layer == 0 && clicked(ui, text::materials::PICK) {
            commands.push(AppCommand::PickMaterials);
        }
        clicked(ui, text::materials::USE_MATERIALS)
    });
    highlight_if_searched(ui, text::materials::USE_MATERIALS, &menu.response);
    menu.inner == Some(true)
}

/// Stretches the points over the values that occur: without 2 % of the voxels at the low end, since most volumes have
/// much empty space, and 0.2 % at the high end.
fn fit_to_values(function: &mut TransferFunction, volume: &VolumeFacts) {
    let value = |share: f64| {
        volume.range.low + volume.histogram.percentile(share) * (volume.range.high - volume.range.low)
    };
    let (low, high) = (value(0.02), value(0.998));
    let (Some(first), Some(last)) = (function.points.first(), function.points.last()) else { return };
    let (from, to) = (first.value, last.value);
    if high > low && to > from {
        function.shift_and_stretch(
            f64::midpoint(low, high) - f64::midpoint(from, to),
            (high - low) / (to - from),
        );
    }
}

/// Adds a smooth bump of opacity in the middle of the shown values.
fn add_bump(function: &mut TransferFunction, shown: ShownValues) {
    let (middle, width) = (f64::midpoint(shown.low, shown.high), (shown.high - shown.low) / 10.0);
    let (first, last) = (middle - 1.25 * width, middle + 1.25 * width);
    clear_band(function, first, last);
    let before = function.clone();
    // A Gaussian, sampled at multiples of half its standard deviation.
    for step in -4_i32..=4 {
        let at = f64::from(step) * 0.5;
        let point = before.point_at(middle + at * width * 0.5);
        let opacity = (0.7 * (-0.5 * at * at).exp()).max(point.opacity);
        let index = function.points.partition_point(|other| other.value <= point.value);
        function.points.insert(index, ControlPoint { opacity, ..point });
    }
}

/// Adds a band of constant opacity with sharp ends in the middle of the shown values.
fn add_box(function: &mut TransferFunction, shown: ShownValues) {
    let (middle, half) = (f64::midpoint(shown.low, shown.high), (shown.high - shown.low) / 20.0);
    let first = clear_band(function, middle - half, middle + half);
    let begin = function.points[first];
    let inside = ControlPoint { opacity: begin.opacity.max(0.7), easing: Easing::Step, ..begin };
    function.points.insert(first + 1, inside);
}

/// Cuts a band out of the curve: sets points on it at both ends of the band and removes those between. Returns the
/// index of the first end, from which a straight line leads to the second.
fn clear_band(function: &mut TransferFunction, low: f64, high: f64) -> usize {
    function.split_at(high);
    function.split_at(low);
    function.points.retain(|point| point.value <= low || point.value >= high);
    let first = function.points.partition_point(|point| point.value <= low) - 1;
    function.points[first].easing = Easing::Linear;
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn added_box_is_rectangular() {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let mut function = TransferFunction {
            points: vec![point(0.0, 0.0), point(49.0, 0.1), point(100.0, 0.2)],
            ..TransferFunction::default()
        };
        let before = function.clone();
        add_box(&mut function, ShownValues { low: 0.0, high: 100.0, is_whole: true });
        assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
        for value in [45.001, 50.0, 54.999] {
            assert!((function.opacity_at(value) - 0.7).abs() < 1e-9, "{value}");
        }
        for value in [0.0, 30.0, 44.999, 55.0, 80.0] {
            let apart = (function.opacity_at(value) - before.opacity_at(value)).abs();
            assert!(apart < 2e-3, "{value}: {apart}");
        }
    }

    #[test]
    fn added_bump_is_symmetric() {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let mut function = TransferFunction {
            points: vec![point(0.0, 0.0), point(100.0, 0.2)],
            ..TransferFunction::default()
        };
        add_bump(&mut function, ShownValues { low: 0.0, high: 100.0, is_whole: true });
        assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value));
        assert!((function.opacity_at(50.0) - 0.7).abs() < 1e-9);
        for value in [20.0, 37.0, 63.0, 80.0] {
            let expected = 0.002 * value;
            let found = function.opacity_at(value);
            assert!((found - expected).abs() < 2e-3, "elsewhere nothing has changed: {found} at {value}");
        }
        let (left, right) = (function.opacity_at(47.0), function.opacity_at(53.0));
        assert!((left - right).abs() < 0.01 && left > 0.3, "both sides: {left} and {right}");
    }
}
