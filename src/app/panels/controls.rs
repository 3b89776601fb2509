//! The rows of the side panel: label, control with typed value and unit, reset.

use std::ops::RangeInclusive;

use eframe::egui::TextStyle::Button as BUTTON;
use eframe::egui::{self, Align, Layout, Response, Slider, Ui, Vec2};

use super::super::text::{self, Named};
use crate::app::common::elide::text_width;
use crate::app::common::reveal;
use crate::app::common::theme;

/// A number with a slider.
#[derive(Debug, Clone)]
pub(super) struct Number {
    named: Named,
    range: RangeInclusive<f64>,
    unit: &'static str,
    log: bool,
    decimals: usize,
}

impl Number {
    /// A slider over a range.
    pub(super) fn new(named: Named, range: RangeInclusive<f64>) -> Self {
        Self { named, range, unit: "", log: false, decimals: 2 }
    }

    /// Behind the number.
    pub(super) fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Equal ratios have equal lengths.
    pub(super) fn log(mut self) -> Self {
        self.log = true;
        self
    }

    /// Digits behind the point.
    pub(super) fn decimals(mut self, decimals: usize) -> Self {
        self.decimals = decimals;
        self
    }

    /// Shows the row. `default`: what the reset button puts back, the value of the first look or, where that has none, of
    /// what was added.
    pub(super) fn show(self, ui: &mut Ui, value: &mut f64, default: f64) -> Response {
        let Self { named, range, unit, log, decimals } = self;
        row(ui, named, |ui| {
            let spacing = ui.spacing().item_spacing.x;
            let typed = text_width(ui, &format!("{value:.decimals$}{unit}"), &BUTTON);
            let width = theme::VALUE_WIDTH.max(typed + 2.0 * ui.spacing().button_padding.x);
            let room = room(ui) - width - theme::RESET_WIDTH - 3.0 * spacing;
            ui.spacing_mut().slider_width = room.max(30.0);
            ui.spacing_mut().interact_size.x = width;
            let slider = Slider::new(value, range).suffix(unit).logarithmic(log).fixed_decimals(decimals);
            // Settings from files may lie beyond the slider: they stay until the user moves it.
            let slider = slider.clamping(egui::SliderClamping::Edits);
            let response = ui.name_inputs(named.name, |ui| ui.add(slider)).on_hover_text(named.tip);
            let back = differs(*value, default).then(|| value_of(default, decimals, unit));
            if reset(ui, named.name, back.as_deref()) || response.double_clicked() {
                *value = default;
            }
            response
        })
    }
}

/// The unit in which lengths of the scene are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SceneUnit {
    /// How many of it are one unit of the scene.
    pub per_scene: f64,
    /// Behind a number.
    pub suffix: &'static str,
}

impl Number {
    /// Shows the row of a length; value, default and range are in units of the scene.
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

/// Relative difference from which on a value is another: more than rounding of numbers that are shown in other units.
const ROUNDING: f64 = 1e-6;

/// Whether a value is another than what would be put back.
fn differs(value: f64, default: f64) -> bool {
    (value - default).abs() > ROUNDING * default.abs().max(1e-3)
}

/// A value as its row shows it; with more digits where those of the row would be zeros only.
fn value_of(value: f64, decimals: usize, unit: &str) -> String {
    let words = format!("{value:.decimals$}");
    let is_lost = value != 0.0 && words.chars().all(|c| "-0.".contains(c));
    let words = if is_lost { short(value) } else { words };
    format!("{words}{unit}")
}

/// Points by which what is being shown is indented in its section.
fn indentation(ui: &Ui) -> f32 {
    let left = ui.data(|data| data.get_temp::<f32>(left_id())).unwrap_or(ui.max_rect().left());
    // A part of the label is always left.
    (ui.max_rect().left() - left).clamp(0.0, theme::LABEL_WIDTH / 2.0)
}

/// Shows rows that belong to the one above them; their controls stand where those of other rows do.
pub(super) fn indented<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    ui.scope(|ui| {
        ui.spacing_mut().indent = theme::INDENT;
        ui.indent(0, add).inner
    })
    .inner
}

/// A row: a label of the usual width, then what `add` shows.
pub(super) fn row<R>(ui: &mut Ui, named: Named, add: impl FnOnce(&mut Ui) -> R) -> R {
    let width = theme::LABEL_WIDTH - indentation(ui);
    let shown = ui.horizontal(|ui| {
        let size = Vec2::new(width, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(width);
            ui.add(egui::Label::new(named.name).truncate().selectable(false)).on_hover_text(named.tip);
        });
        add(ui)
    });
    reveal::glow(ui, section_of(ui), named.name, shown.response.rect);
    shown.inner
}

/// A row whose control says by itself what it is, in as many lines as it needs.
pub(super) fn unlabelled<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    row(ui, Named { name: "", tip: "" }, |ui| {
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Wrap);
        add(ui)
    })
}

/// Points that are left of a row: where something before it was wider than the panel, no more than can be seen.
fn room(ui: &Ui) -> f32 {
    ui.available_width().min(ui.clip_rect().right() - ui.cursor().left())
}

/// The button that puts a value back; `back` says to what. It is there only when there is something to put back.
pub(super) fn reset(ui: &mut Ui, label: &str, back: Option<&str>) -> bool {
    let size = Vec2::new(theme::RESET_WIDTH, ui.spacing().interact_size.y);
    let Some(back) = back else {
        ui.allocate_exact_size(size, egui::Sense::hover());
        return false;
    };
    let (_, response) = ui.allocate_exact_size(size, egui::Sense::click());
    reset_button(ui, response, label, &text::common::reset_to(back))
}

/// Paints a button that puts something back; whether it was clicked.
fn reset_button(ui: &Ui, response: Response, label: &str, tip: &str) -> bool {
    let area = response.rect;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, text::common::reset(label)));
    let lit = response.hovered() || response.has_focus();
    let ink = if lit { theme::accent(ui.visuals()) } else { ui.visuals().weak_text_color() };
    circular_arrow(ui, area.center(), ink);
    response.on_hover_text(tip).clicked()
}

/// Three quarters of a circle with an arrowhead, turning back.
fn circular_arrow(ui: &Ui, middle: egui::Pos2, ink: egui::Color32) {
    const RADIUS: f32 = 4.5;
    let at = |turn: f32, radius: f32| middle + radius * Vec2::angled(turn * std::f32::consts::TAU);
    let arc: Vec<egui::Pos2> = (0..=18).map(|i| at(-0.2 + 0.75 * i as f32 / 18.0, RADIUS)).collect();
    ui.painter().line(arc, egui::Stroke::new(1.4, ink));
    let tip = at(-0.32, RADIUS);
    let head = vec![tip, at(-0.2, RADIUS + 3.0), at(-0.2, RADIUS - 3.0)];
    ui.painter().add(egui::Shape::convex_polygon(head, ink, egui::Stroke::NONE));
}

/// One of a few values, side by side.
pub(super) fn choice<T: PartialEq + Copy>(
    ui: &mut Ui,
    named: Named,
    value: &mut T,
    options: &[(T, Named)],
) -> bool {
    choice_with(ui, named, value, options, |_| None)
}

/// One of a few values, side by side or, where the row is too narrow for all of their words, in a list that opens; what
/// more there is to say of each.
pub(super) fn choice_with<T: PartialEq + Copy>(
    ui: &mut Ui,
    named: Named,
    value: &mut T,
    options: &[(T, Named)],
    more: impl Fn(&T) -> Option<String>,
) -> bool {
    row(ui, named, |ui| {
        let spacing = ui.spacing().item_spacing.x;
        ui.spacing_mut().item_spacing.x = 2.0;
        if options.len() > 3 {
            // Four words would be wider than the panel otherwise.
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
                    ui.selectable_label(value == option, of_option.name).on_hover_text(of_option.tip);
                if let Some(more) = more(option) {
                    response = response.on_hover_text(more);
                }
                if response.clicked() && value != option {
                    *value = *option;
                    changed = true;
                }
            }
        };
        // There is no space behind the last, and places are rounded to pixels.
        if needed - ui.spacing().item_spacing.x + 1.0 <= room(ui) {
            pick(ui);
        } else {
            let width = room(ui) - theme::RESET_WIDTH - spacing;
            let list = egui::ComboBox::from_id_salt(named.name).selected_text(shown).width(width).truncate();
            let list = ui.name_inputs(named.name, |ui| list.show_ui(ui, pick));
            list.response.on_hover_text(named.tip);
        }
        changed
    })
}

/// A number with as many digits as it needs.
pub(super) fn short(value: f64) -> String {
    let digits = format!("{value:.4}");
    if value.abs() >= 1e6 || (value != 0.0 && value.abs() < 1e-3) {
        return format!("{value:.3e}");
    }
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Distances between voxels, in the unit that suits them.
pub(super) fn spacing(spacing_mm: [f64; 3], is_unknown: bool) -> String {
    let unit = text::data::unit_of_spacing(spacing_mm, is_unknown);
    text::data::spacing(&spacing_mm.map(|length| short(length / unit.mm)), unit)
}

/// A switch.
pub(super) fn switch(ui: &mut Ui, named: Named, value: &mut bool) -> Response {
    let response = ui.checkbox(value, named.name).on_hover_text(named.tip);
    reveal::glow(ui, section_of(ui), named.name, response.rect);
    response
}

/// An sRGB colour, stored as the button shows it.
pub(in crate::app) fn color(ui: &mut Ui, name: &str, srgb: &mut [f32; 3]) -> Response {
    let mut bytes = srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    let response = ui.name_inputs(name, |ui| ui.color_edit_button_srgb(&mut bytes));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColorWell, true, name));
    if response.changed() {
        *srgb = bytes.map(|c| f32::from(c) / 255.0);
    }
    response.on_hover_text(name)
}

/// What the header of a section shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Header {
    /// It is open until somebody closes it.
    pub open: bool,
    /// Something is on in it.
    pub is_active: bool,
    /// There is something to put back.
    pub can_reset: bool,
}

/// A section of the panel. While it opens it is scrolled into sight: all of it, or as much as there is room for. Whoever is
/// led to it finds its title at the top.
/// `is_active`: a dot says that something is on in it. `can_reset`: there is something to put back; returns whether that is
/// wanted.
pub(super) fn section(
    ui: &mut Ui,
    title: &'static str,
    Header { open, is_active, can_reset }: Header,
    add: impl FnOnce(&mut Ui),
) -> bool {
    let header = egui::CollapsingHeader::new(egui::RichText::new(title).strong());
    let header = header.open(reveal::opens(ui.ctx(), title, false).then_some(true));
    let left = ui.max_rect().left();
    ui.data_mut(|data| {
        data.insert_temp(section_id(), title);
        data.insert_temp(left_id(), left);
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
        dot.on_hover_text(text::sections::active(title));
    }
    let mut resets = false;
    if can_reset {
        let right = ui.max_rect().right() - theme::RESET_WIDTH;
        let area = egui::Rect::from_center_size(
            egui::pos2(right, row.center().y),
            Vec2::new(theme::RESET_WIDTH, row.height()),
        );
        let button = ui.interact(area, ui.scope_id().with((title, "reset")), egui::Sense::click());
        resets = reset_button(ui, button, title, &text::common::reset_to_first_look(title));
    }
    let id = shown.header_response.id.with("openness");
    let before = ui.data(|data| data.get_temp::<f32>(id)).unwrap_or(shown.openness);
    ui.data_mut(|data| data.insert_temp(id, shown.openness));
    let header = shown.header_response.rect;
    let is_led_to = reveal::lead_to_section(ui, title, header, shown.openness >= 1.0);
    if shown.openness > before && !is_led_to {
        let whole = shown.body_response.map_or(header, |body| header.union(body.rect));
        let has_room = whole.height() <= ui.clip_rect().height();
        let (rect, align) = if has_room { (whole, None) } else { (header, Some(Align::TOP)) };
        ui.scroll_to_rect(rect, align);
    }
    ui.separator();
    resets
}

/// Where the title is kept of the section that is being shown.
fn section_id() -> egui::Id {
    egui::Id::unique("section of the panel")
}

/// Where the left border is kept of the section that is being shown.
fn left_id() -> egui::Id {
    egui::Id::unique("left border of the section")
}

/// The title of the section that is being shown.
fn section_of(ui: &Ui) -> &'static str {
    ui.data(|data| data.get_temp(section_id())).unwrap_or_default()
}

/// Rarely needed things, folded away.
pub(super) fn advanced(ui: &mut Ui, salt: &str, add: impl FnOnce(&mut Ui)) {
    let header = egui::CollapsingHeader::new(text::common::ADVANCED).id_salt(salt);
    let opens = reveal::opens(ui.ctx(), section_of(ui), true);
    header.open(opens.then_some(true)).show_unindented(ui, add);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_say_to_what_and_only_beside_other_values() {
        assert!(!differs(0.1, 0.1) && !differs(f64::from(0.1f32), 0.1), "rounding is nobody's doing");
        assert!(differs(0.11, 0.1) && differs(0.0, 1e-3) && differs(1e-3, 0.0));
        assert_eq!(value_of(0.1, 2, ""), "0.10");
        assert_eq!(value_of(45.0, 1, "°"), "45.0°");
        assert_eq!(value_of(0.0, 2, ""), "0.00");
        assert_eq!(value_of(0.0021, 2, " mm"), "0.0021 mm");
    }
}
