//! Rows of the side panel: label, control with typed value and unit, and reset button.

use std::ops::RangeInclusive;

use eframe::egui::TextStyle::Button as BUTTON;
use eframe::egui::{self, Align, Layout, Response, Slider, Ui, Vec2};

use super::super::text::{self, ControlText};
use crate::app::common::elide::text_width;
use crate::app::common::reveal;
use crate::app::common::theme;

/// Builder of a row with a slider for a number.
#[derive(Debug, Clone)]
pub(super) struct NumberRow {
    named: ControlText,
    range: RangeInclusive<f64>,
    unit: &'static str,
    log: bool,
    decimals: usize,
}

impl NumberRow {
    /// Creates a linear slider over a range, with two decimals.
    pub(super) fn new(named: ControlText, range: RangeInclusive<f64>) -> Self {
        Self { named, range, unit: "", log: false, decimals: 2 }
    }

    /// Sets the unit that is shown behind the number.
    pub(super) fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Makes the slider logarithmic: equal ratios have equal lengths.
    pub(super) fn logarithmic(mut self) -> Self {
        self.log = true;
        self
    }

    /// Sets the number of decimals shown.
    pub(super) fn decimals(mut self, decimals: usize) -> Self {
        self.decimals = decimals;
        self
    }

    /// Shows the row. `default`: value that the reset button restores, from the first look or, where that has none,
    /// from the time the object was added.
    pub(super) fn show(self, ui: &mut Ui, value: &mut f64, default: f64) -> Response {
        let Self { named, range, unit, log, decimals } = self;
        row(ui, named, |ui| {
            let spacing = ui.spacing().item_spacing.x;
            let typed = text_width(ui, &format!("{value:.decimals$}{unit}"), &BUTTON);
            let width = theme::VALUE_WIDTH.max(typed + 2.0 * ui.spacing().button_padding.x);
            let room = available_row_width(ui) - width - theme::RESET_WIDTH - 3.0 * spacing;
            ui.spacing_mut().slider_width = room.max(30.0);
            ui.spacing_mut().interact_size.x = width;
            let slider = Slider::new(value, range).suffix(unit).logarithmic(log).fixed_decimals(decimals);
            // Settings from files may lie beyond the slider's range; they stay until the user moves it.
            let slider = slider.clamping(egui::SliderClamping::Edits);
            let response = ui.name_inputs(named.name, |ui| ui.add(slider)).on_hover_text(named.tooltip);
            let default_text =
                differs_from_default(*value, default).then(|| format_row_value(default, decimals, unit));
            if reset_button_cell(ui, named.name, default_text.as_deref()) || response.double_clicked() {
                *value = default;
            }
            response
        })
    }
}

/// Unit in which lengths of the scene are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SceneUnit {
    /// Number of these units in one scene unit (half of the volume's longest edge).
    pub per_scene: f64,
    /// Suffix shown behind a number, such as " mm".
    pub suffix: &'static str,
}

impl NumberRow {
    /// Shows the row of a length; value, default and range are in scene units.
    pub(super) fn show_length(self, ui: &mut Ui, value: &mut f64, default: f64, unit: SceneUnit) {
        let SceneUnit { per_scene, suffix } = unit;
        let range = self.range.start() * per_scene..=self.range.end() * per_scene;
        let mut length = *value * per_scene;
        let before = length;
        Self { range, unit: suffix, decimals: 1, ..self }.show(ui, &mut length, default * per_scene);
        if length != before {
            *value = length / per_scene;
        }
    }
}

/// Relative difference from which on two values differ: larger than the rounding of numbers converted between units.
const EQUALITY_TOLERANCE: f64 = 1e-6;

/// Returns true if a value differs from its default by more than rounding.
fn differs_from_default(value: f64, default: f64) -> bool {
    (value - default).abs() > EQUALITY_TOLERANCE * default.abs().max(1e-3)
}

/// Formats a value as its row shows it; with more digits if those of the row would all be zeros.
fn format_row_value(value: f64, decimals: usize, unit: &str) -> String {
    let words = format!("{value:.decimals$}");
    let is_lost = value != 0.0 && words.chars().all(|c| "-0.".contains(c));
    let words = if is_lost { format_number(value) } else { words };
    format!("{words}{unit}")
}

/// Indentation of the current row within its section, in points.
fn indentation(ui: &Ui) -> f32 {
    let left = ui.data(|data| data.get_temp::<f32>(section_left_id())).unwrap_or(ui.max_rect().left());
    // Some of the label always remains visible.
    (ui.max_rect().left() - left).clamp(0.0, theme::LABEL_WIDTH / 2.0)
}

/// Shows rows that are subordinate to the row above them; only their labels are indented, their controls stay
/// aligned.
pub(super) fn indented_rows<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    ui.scope(|ui| {
        ui.spacing_mut().indent = theme::INDENT;
        ui.indent(0, add).inner
    })
    .inner
}

/// Shows a row: a label of the usual width, then the widgets of `add`.
pub(super) fn row<R>(ui: &mut Ui, named: ControlText, add: impl FnOnce(&mut Ui) -> R) -> R {
    let width = theme::LABEL_WIDTH - indentation(ui);
    let shown = ui.horizontal(|ui| {
        let size = Vec2::new(width, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(width);
            ui.add(egui::Label::new(named.name).truncate().selectable(false)).on_hover_text(named.tooltip);
        });
        add(ui)
    });
    reveal::highlight_row(ui, current_section(ui), named.name, shown.response.rect);
    shown.inner
}

/// Shows a row whose control names itself, wrapped over as many lines as it needs.
pub(super) fn unlabelled_row<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    row(ui, ControlText { name: "", tooltip: "" }, |ui| {
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Wrap);
        add(ui)
    })
}

/// Width left in a row, in points; clipped to the visible part where wider content has stretched the panel.
fn available_row_width(ui: &Ui) -> f32 {
    ui.available_width().min(ui.clip_rect().right() - ui.cursor().left())
}

/// Shows the reset button of a row; `back` is the value that it restores, in words. Without one, its place stays
/// empty.
pub(super) fn reset_button_cell(ui: &mut Ui, label: &str, back: Option<&str>) -> bool {
    let size = Vec2::new(theme::RESET_WIDTH, ui.spacing().interact_size.y);
    let Some(back) = back else {
        ui.allocate_exact_size(size, egui::Sense::hover());
        return false;
    };
    let (_, response) = ui.allocate_exact_size(size, egui::Sense::click());
    paint_reset_button(ui, response, label, &text::common::reset_tooltip(back))
}

/// Paints a reset button; returns true if it was clicked.
fn paint_reset_button(ui: &Ui, response: Response, label: &str, tip: &str) -> bool {
    let area = response.rect;
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, text::common::reset_name(label)));
    let lit = response.hovered() || response.has_focus();
    let ink = if lit { theme::accent(ui.visuals()) } else { ui.visuals().weak_text_color() };
    circular_arrow(ui, area.center(), ink);
    response.on_hover_text(tip).clicked()
}

/// Paints the reset icon: three quarters of a circle with an arrowhead, counterclockwise.
fn circular_arrow(ui: &Ui, middle: egui::Pos2, ink: egui::Color32) {
    const RADIUS: f32 = 4.5;
    let at = |turn: f32, radius: f32| middle + radius * Vec2::angled(turn * std::f32::consts::TAU);
    let arc: Vec<egui::Pos2> = (0..=18).map(|i| at(-0.2 + 0.75 * i as f32 / 18.0, RADIUS)).collect();
    ui.painter().line(arc, egui::Stroke::new(1.4, ink));
    let tip = at(-0.32, RADIUS);
    let head = vec![tip, at(-0.2, RADIUS + 3.0), at(-0.2, RADIUS - 3.0)];
    ui.painter().add(egui::Shape::convex_polygon(head, ink, egui::Stroke::NONE));
}

/// Shows a choice between a few values, side by side. Returns true if it changed.
pub(super) fn choice_row<T: PartialEq + Copy>(
    ui: &mut Ui,
    named: ControlText,
    value: &mut T,
    options: &[(T, ControlText)],
) -> bool {
    choice_row_with_tips(ui, named, value, options, |_| None)
}

/// Shows a choice between a few values with an extra tooltip for each: side by side or, where the row is too narrow,
/// as a drop-down list. Returns true if it changed.
pub(super) fn choice_row_with_tips<T: PartialEq + Copy>(
    ui: &mut Ui,
    named: ControlText,
    value: &mut T,
    options: &[(T, ControlText)],
    more: impl Fn(&T) -> Option<String>,
) -> bool {
    row(ui, named, |ui| {
        let spacing = ui.spacing().item_spacing.x;
        ui.spacing_mut().item_spacing.x = 2.0;
        if options.len() > 3 {
            // Four words would otherwise be wider than the panel.
            ui.spacing_mut().button_padding.x *= 0.7;
        }
        let padding = 2.0 * ui.spacing().button_padding.x + ui.spacing().item_spacing.x;
        let needed: f32 =
            options.iter().map(|(_, named)| text_width(ui, named.name, &BUTTON) + padding).sum();
        let chosen = options.iter().find(|(option, _)| *option == *value);
        let shown = chosen.map_or("", |(_, of_option)| of_option.name);
        let mut changed = false;
        let mut pick = |ui: &mut Ui| {
            for (option, of_option) in options {
                let mut response =
                    ui.selectable_label(value == option, of_option.name).on_hover_text(of_option.tooltip);
                if let Some(more) = more(option) {
                    response = response.on_hover_text(more);
                }
                if response.clicked() && value != option {
                    *value = *option;
                    changed = true;
                }
            }
        };
        // The last option is not followed by a gap, and positions are rounded to pixels.
        if needed - ui.spacing().item_spacing.x + 1.0 <= available_row_width(ui) {
            pick(ui);
        } else {
            let width = available_row_width(ui) - theme::RESET_WIDTH - spacing;
            let list = egui::ComboBox::from_id_salt(named.name).selected_text(shown).width(width).truncate();
            let list = ui.name_inputs(named.name, |ui| list.show_ui(ui, pick));
            list.response.on_hover_text(named.tooltip);
        }
        changed
    })
}

/// Formats a number with at most four decimals, without trailing zeros; very large and very small ones in scientific
/// notation.
pub(super) fn format_number(value: f64) -> String {
    let digits = format!("{value:.4}");
    if value.abs() >= 1e6 || (value != 0.0 && value.abs() < 1e-3) {
        return format!("{value:.3e}");
    }
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Formats the spacing of voxels in the unit that suits it.
pub(super) fn format_spacing(spacing_mm: [f64; 3], is_unknown: bool) -> String {
    let unit = text::data::unit_of_spacing(spacing_mm, is_unknown);
    text::data::spacing(&spacing_mm.map(|length| format_number(length / unit.mm)), unit)
}

/// Shows a checkbox row for a boolean setting.
pub(super) fn switch_row(ui: &mut Ui, named: ControlText, value: &mut bool) -> Response {
    let response = ui.checkbox(value, named.name).on_hover_text(named.tooltip);
    reveal::highlight_row(ui, current_section(ui), named.name, response.rect);
    response
}

/// Shows a colour button for an sRGB colour, stored in the 8-bit steps that the button shows.
pub(crate) fn color_button(ui: &mut Ui, name: &str, srgb: &mut [f32; 3]) -> Response {
    let mut bytes = srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    let response = ui.name_inputs(name, |ui| ui.color_edit_button_srgb(&mut bytes));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColorWell, true, name));
    if response.changed() {
        *srgb = bytes.map(|c| f32::from(c) / 255.0);
    }
    response.on_hover_text(name)
}

/// State of the header of a section.
#[derive(Debug, Clone, Copy)]
pub(super) struct SectionHeader {
    /// True if the section is open until the user closes it.
    pub open: bool,
    /// True if something is switched on in the section.
    pub is_active: bool,
    /// True if the section differs from the first look, so that it can be reset.
    pub can_reset: bool,
}

/// Shows a collapsible section of the side panel, and returns true if its reset button was clicked. While it opens,
/// the panel scrolls until all of it is visible, or as much as fits; if it was opened by a command, its title comes
/// to the top.
///
/// `is_active` shows a dot in the header: something is on in the section. `can_reset` shows the reset button.
pub(super) fn section(
    ui: &mut Ui,
    title: &'static str,
    SectionHeader { open, is_active, can_reset }: SectionHeader,
    add: impl FnOnce(&mut Ui),
) -> bool {
    let header = egui::CollapsingHeader::new(egui::RichText::new(title).strong());
    let header = header.open(reveal::should_open(ui.ctx(), title, false).then_some(true));
    let left = ui.max_rect().left();
    ui.data_mut(|data| {
        data.insert_temp(current_section_id(), title);
        data.insert_temp(section_left_id(), left);
    });
    let shown = header.default_open(open).show_unindented(ui, |ui| {
        add(ui);
        ui.add_space(4.0);
    });
    let row = shown.header_response.rect;
    if is_active {
        let middle = egui::pos2(row.right() + 8.0, row.center().y);
        let dot = ui.interact(
            egui::Rect::from_center_size(middle, Vec2::splat(12.0)),
            ui.scope_id().with((title, "on")),
            egui::Sense::hover(),
        );
        ui.painter().circle_filled(middle, 3.5, theme::ACCENT);
        dot.on_hover_text(text::sections::active_name(title));
    }
    let mut resets = false;
    if can_reset {
        let right = ui.max_rect().right() - theme::RESET_WIDTH;
        let area = egui::Rect::from_center_size(
            egui::pos2(right, row.center().y),
            Vec2::new(theme::RESET_WIDTH, row.height()),
        );
        let button = ui.interact(area, ui.scope_id().with((title, "reset")), egui::Sense::click());
        resets = paint_reset_button(ui, button, title, &text::common::reset_section_tooltip(title));
    }
    let id = shown.header_response.id.with("openness");
    let before = ui.data(|data| data.get_temp::<f32>(id)).unwrap_or(shown.openness);
    ui.data_mut(|data| data.insert_temp(id, shown.openness));
    let header = shown.header_response.rect;
    let is_led_to = reveal::scroll_to_section(ui, title, header, shown.openness >= 1.0);
    if shown.openness > before && !is_led_to {
        let whole = shown.body_response.map_or(header, |body| header.union(body.rect));
        let has_room = whole.height() <= ui.clip_rect().height();
        let (rect, align) = if has_room { (whole, None) } else { (header, Some(Align::TOP)) };
        ui.scroll_to_rect(rect, align);
    }
    ui.separator();
    resets
}

/// Key in egui's memory of the title of the section that is being shown.
fn current_section_id() -> egui::Id {
    egui::Id::unique("section of the panel")
}

/// Key in egui's memory of the left border of the section that is being shown, in points.
fn section_left_id() -> egui::Id {
    egui::Id::unique("left border of the section")
}

/// Title of the section that is being shown.
fn current_section(ui: &Ui) -> &'static str {
    ui.data(|data| data.get_temp(current_section_id())).unwrap_or_default()
}

/// Shows a collapsed part of a section, for settings that are rarely needed.
pub(super) fn advanced_group(ui: &mut Ui, salt: &str, add: impl FnOnce(&mut Ui)) {
    let header = egui::CollapsingHeader::new(text::common::ADVANCED).id_salt(salt);
    let opens = reveal::should_open(ui.ctx(), current_section(ui), true);
    header.open(opens.then_some(true)).show_unindented(ui, add);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reset_buttons_state_the_default_of_changed_values() {
        assert!(
            !differs_from_default(0.1, 0.1) && !differs_from_default(f64::from(0.1f32), 0.1),
            "rounding is nobody's doing"
        );
        assert!(
            differs_from_default(0.11, 0.1)
                && differs_from_default(0.0, 1e-3)
                && differs_from_default(1e-3, 0.0)
        );
        assert_eq!(format_row_value(0.1, 2, ""), "0.10");
        assert_eq!(format_row_value(45.0, 1, "°"), "45.0°");
        assert_eq!(format_row_value(0.0, 2, ""), "0.00");
        assert_eq!(format_row_value(0.0021, 2, " mm"), "0.0021 mm");
    }
}
