//! Table of the labels of a segmentation, shown in place of the curve: one row for the look of each.

use eframe::egui::{
    self, Align, Button, DragValue, Id, Layout, RichText, ScrollArea, TextEdit, Ui, Vec2, WidgetInfo,
};

use super::super::text::{self, ControlText};
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::{LabelRow, VolumeFacts};
use crate::app::panels::controls::color_button;
use chiaroscuro_scene::{LabelLook, LabelTable, MAX_NAME_CHARS, Settings};

/// Number of labels from which on a filter is shown: fewer are visible at once.
const MIN_FILTERED_LABELS: usize = 7;

/// Widths of the columns, in points: enough for their headers, six-digit labels, and the voxel counts of large scans.
const SHOW_WIDTH: f32 = 38.0;
const COLOR_WIDTH: f32 = 48.0;
const NUMBER_WIDTH: f32 = 56.0;
const VOXELS_WIDTH: f32 = 84.0;
const OPACITY_WIDTH: f32 = 62.0;

/// Range of the width of the name column, in points: the remaining width, limited to what is read at a glance.
const NAME_WIDTHS: std::ops::RangeInclusive<f32> = 90.0..=320.0;

/// Gap between two columns, in points.
const COLUMN_GAP: f32 = 10.0;

/// Width of the filter field, in points.
const FILTER_WIDTH: f32 = 180.0;

/// Shows the table of labels in the whole of `ui`.
pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    volume: &VolumeFacts,
    commands: &mut Vec<AppCommand>,
) {
    let mut use_curve = false;
    let listed = ui.horizontal(|ui| {
        let listed = filtered_labels(ui, &settings.layer_at(volume.layer).labels, &volume.labels);
        label_tools(ui, &mut settings.layer_at_mut(volume.layer).labels, &listed, volume.labels.len());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let curve = text::labels::USE_CURVE;
            use_curve = ui.button(curve.name).on_hover_text(curve.tooltip).clicked();
            let automatic = text::labels::AUTOMATIC;
            if ui.button(automatic.name).on_hover_text(automatic.tooltip).clicked() {
                commands.push(AppCommand::AutomaticTransfer);
            }
        });
        listed
    });
    let (table, listed) = (&mut settings.layer_at_mut(volume.layer).labels, listed.inner);
    let fixed = SHOW_WIDTH + COLOR_WIDTH + NUMBER_WIDTH + VOXELS_WIDTH + OPACITY_WIDTH + 6.0 * COLUMN_GAP;
    let name_width = (ui.available_width() - fixed).clamp(*NAME_WIDTHS.start(), *NAME_WIDTHS.end());
    table_header(ui, name_width);
    ui.separator();
    let height = ui.spacing().interact_size.y;
    let area = ScrollArea::vertical().id_salt("labels").auto_shrink(false);
    area.show_rows(ui, height, listed.len(), |ui, rows| {
        let mut only = None;
        for label in listed.get(rows).unwrap_or_default() {
            ui.push_id(label.number, |ui| {
                if label_row(ui, table, label, name_width) {
                    only = Some(label.look_number);
                }
            });
        }
        if let Some(number) = only {
            for label in &*volume.labels {
                set_visible(table, label.look_number, label.look_number == number);
            }
        }
    });
    if use_curve {
        *table = LabelTable::default();
    }
}

/// Shows one cell of a row, as wide as its column; numbers are right-aligned.
fn table_cell<R>(ui: &mut Ui, width: f32, is_number: bool, add: impl FnOnce(&mut Ui) -> R) -> R {
    let size = Vec2::new(width, ui.spacing().interact_size.y);
    let layout =
        if is_number { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    let shown = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(width);
        add(ui)
    });
    shown.inner
}

/// Shows the header row with the column titles.
fn table_header(ui: &mut Ui, name_width: f32) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = COLUMN_GAP;
        ui.spacing_mut().interact_size.y = 14.0;
        let columns: [(f32, bool, ControlText); 6] = [
            (SHOW_WIDTH, false, text::labels::SHOW_COLUMN),
            (COLOR_WIDTH, false, text::labels::COLOR_COLUMN),
            (NUMBER_WIDTH, false, text::labels::NUMBER_COLUMN),
            (name_width, false, text::labels::NAME_COLUMN),
            (VOXELS_WIDTH, true, text::labels::VOXELS_COLUMN),
            (OPACITY_WIDTH, false, text::labels::OPACITY_COLUMN),
        ];
        for (width, is_number, ControlText { name, tooltip: tip }) in columns {
            let words = egui::Label::new(RichText::new(name).small().weak()).selectable(false);
            table_cell(ui, width, is_number, |ui| ui.add(words)).on_hover_text(tip);
        }
    });
}

/// Shows the filter if there are many labels, and returns the labels that match it.
fn filtered_labels<'a>(ui: &mut Ui, table: &LabelTable, all: &'a [LabelRow]) -> Vec<&'a LabelRow> {
    if all.len() < MIN_FILTERED_LABELS {
        return all.iter().collect();
    }
    let id = Id::unique("filter of labels");
    let mut filter = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let words = text::labels::FILTER;
    let field =
        TextEdit::singleline(&mut filter).hint_text(text::labels::FILTER_HINT).char_limit(MAX_NAME_CHARS);
    let response = ui.add(field.desired_width(FILTER_WIDTH));
    name_text_field(&response, words.name);
    // Escape also takes the focus away.
    if response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        filter.clear();
    }
    response.on_hover_text(words.tooltip);
    let filter_text = filter.trim().to_lowercase();
    ui.data_mut(|data| data.insert_temp(id, filter));
    let is_wanted = |label: &&LabelRow| {
        filter_text.is_empty()
            || label.number.to_string().contains(&filter_text)
            || label.name(table).to_lowercase().contains(&filter_text)
    };
    all.iter().filter(is_wanted).collect()
}

/// Shows the buttons that change all listed labels, and their count.
fn label_tools(ui: &mut Ui, table: &mut LabelTable, listed: &[&LabelRow], all: usize) {
    for (words, visible) in [(text::labels::SHOW_ALL, true), (text::labels::HIDE_ALL, false)] {
        if ui.button(words.name).on_hover_text(words.tooltip).clicked() {
            for label in listed.iter().filter(|label| !visible || label.look_number > 0) {
                set_visible(table, label.look_number, visible);
            }
        }
    }
    ui.weak(text::labels::count(listed.len(), all));
}

/// Shows one label in a row; returns true if only this label is to remain visible.
fn label_row(ui: &mut Ui, table: &mut LabelTable, label: &LabelRow, name_width: f32) -> bool {
    let number = label.number;
    let before = table.look_or_default(label.look_number).into_owned();
    let mut look = before.clone();
    let has_own_look = label.look_number == number;
    let mut only = false;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = COLUMN_GAP;
        table_cell(ui, SHOW_WIDTH, false, |ui| {
            let words = text::labels::visible(number);
            let shown = ui.name_inputs(words, |ui| ui.checkbox(&mut look.visible, ""));
            shown.on_hover_text(text::labels::VISIBLE_TIP);
        });
        table_cell(ui, COLOR_WIDTH, false, |ui| {
            color_button(ui, &text::labels::color(number), &mut look.color)
        });
        let size = Vec2::new(NUMBER_WIDTH, ui.spacing().interact_size.y);
        let button = ui.add_sized(size, Button::new(number.to_string()).small().truncate());
        button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, text::labels::only_name(number)));
        let shares_with = (!has_own_look).then_some(label.look_number);
        let facts = text::labels::tooltip(&label.name(table), label.voxels, shares_with);
        only = button.on_hover_text(format!("{}\n{facts}", text::labels::ONLY_TIP)).clicked();
        let mut name = label.name(table);
        let field =
            TextEdit::singleline(&mut name).char_limit(MAX_NAME_CHARS).hint_text(text::labels::NAME_HINT);
        // A text field adds its margin on both sides to its text's width.
        let field = field.desired_width(name_width - 8.0);
        let response = table_cell(ui, name_width, false, |ui| ui.add_enabled(has_own_look, field));
        name_text_field(&response, &text::labels::name(number));
        if response.changed() {
            look.name = name;
        }
        table_cell(ui, VOXELS_WIDTH, true, |ui| ui.label(text::labels::voxels(label.voxels)));
        table_cell(ui, OPACITY_WIDTH, false, |ui| {
            let words = text::labels::opacity(number);
            ui.spacing_mut().interact_size.x = OPACITY_WIDTH;
            let field = DragValue::new(&mut look.opacity).range(0.0..=1.0).speed(0.005).fixed_decimals(3);
            ui.name_inputs(words, |ui| ui.add(field)).on_hover_text(text::labels::OPACITY_TIP);
        });
    });
    if look != before {
        *table.entry_mut(label.look_number) = look;
    }
    only
}

/// Names a text field for screen readers, which would otherwise read its contents, empty or not.
fn name_text_field(field: &egui::Response, name: &str) {
    let is_enabled = field.enabled();
    field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, is_enabled, name));
}

/// Shows or hides a label; adds no table entry if its visibility is that already.
fn set_visible(table: &mut LabelTable, number: i64, visible: bool) {
    if table.look_or_default(number).visible != visible {
        *table.entry_mut(number) = LabelLook { visible, ..table.look_or_default(number).into_owned() };
    }
}
