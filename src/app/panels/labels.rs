//! Section "Labels": what labels look like, a row for each.

use eframe::egui::{self, DragValue, Id, ScrollArea, TextEdit, Ui};

use super::super::text;
use super::Panels;
use super::controls::color;
use crate::app::common::volume_facts::LabelRow;
use crate::model::{LabelLook, LabelTable, MAX_NAME};

/// Rows that are seen at once; with more of them there is a filter.
const ROWS: usize = 12;

/// Points of width of a number, of five digits.
const NUMBER_WIDTH: f32 = 42.0;

/// Points of width of an opacity.
const OPACITY_WIDTH: f32 = 40.0;

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let Some(volume) = panels.volume else { return };
    let table = &mut panels.settings.labels;
    let listed = listed(ui, table, &volume.labels);
    tools(ui, table, &listed, volume.labels.len());
    let height = ui.spacing().interact_size.y;
    let room = (height + ui.spacing().item_spacing.y) * ROWS as f32;
    let area = ScrollArea::vertical().id_salt("labels").max_height(room).auto_shrink([false, true]);
    area.show_rows(ui, height, listed.len(), |ui, rows| {
        let mut only = None;
        for label in listed.get(rows).unwrap_or_default() {
            ui.push_id(label.number, |ui| {
                if row(ui, table, label) {
                    only = Some(label.stands_for);
                }
            });
        }
        if let Some(number) = only {
            for label in &*volume.labels {
                set_visible(table, label.stands_for, label.stands_for == number);
            }
        }
    });
}

/// The labels that the filter lets through. There is one where not all can be seen.
fn listed<'a>(ui: &mut Ui, table: &LabelTable, all: &'a [LabelRow]) -> Vec<&'a LabelRow> {
    if all.len() <= ROWS {
        return all.iter().collect();
    }
    let id = Id::unique("filter of labels");
    let mut filter = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let words = text::labels::FILTER;
    let field = TextEdit::singleline(&mut filter).hint_text(text::labels::FILTER_HINT).char_limit(MAX_NAME);
    let response = ui.add(field.desired_width(ui.available_width() - 8.0));
    name_text(&response, words.name);
    // Which also takes the focus away.
    if response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        filter.clear();
    }
    response.on_hover_text(words.tip);
    let wanted = filter.trim().to_lowercase();
    ui.data_mut(|data| data.insert_temp(id, filter));
    let is_wanted = |label: &&LabelRow| {
        wanted.is_empty()
            || label.number.to_string().contains(&wanted)
            || label.name(table).to_lowercase().contains(&wanted)
    };
    all.iter().filter(is_wanted).collect()
}

/// What changes all of them.
fn tools(ui: &mut Ui, table: &mut LabelTable, listed: &[&LabelRow], all: usize) {
    ui.horizontal(|ui| {
        for (words, visible) in [(text::labels::SHOW_ALL, true), (text::labels::HIDE_ALL, false)] {
            if ui.button(words.name).on_hover_text(words.tip).clicked() {
                for label in listed.iter().filter(|label| !visible || label.stands_for > 0) {
                    set_visible(table, label.stands_for, visible);
                }
            }
        }
        ui.weak(text::labels::count(listed.len(), all));
    });
}

/// A label, on one line. Whether it is to be the only one.
fn row(ui: &mut Ui, table: &mut LabelTable, label: &LabelRow) -> bool {
    let number = label.number;
    let before = table.look(label.stands_for).into_owned();
    let mut look = before.clone();
    let has_own_look = label.stands_for == number;
    let mut only = false;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let words = text::labels::visible(number);
        let shown = ui.name_inputs(words, |ui| ui.checkbox(&mut look.visible, ""));
        shown.on_hover_text(text::labels::VISIBLE_TIP);
        color(ui, &text::labels::color(number), &mut look.color);
        let size = egui::vec2(NUMBER_WIDTH, ui.spacing().interact_size.y);
        let button = ui.add_sized(size, egui::Button::new(number.to_string()).small().truncate());
        button
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, text::labels::only(number)));
        let shares_with = (!has_own_look).then_some(label.stands_for);
        let facts = text::labels::facts(&label.name(table), label.voxels, shares_with);
        only = button.on_hover_text(format!("{}\n{facts}", text::labels::ONLY_TIP)).clicked();
        let room = ui.available_width() - OPACITY_WIDTH - 3.0 * ui.spacing().item_spacing.x;
        let mut name = label.name(table);
        let field = TextEdit::singleline(&mut name).char_limit(MAX_NAME).hint_text(text::labels::NAME_HINT);
        let response = ui.add_enabled(has_own_look, field.desired_width((room - 8.0).max(30.0)));
        name_text(&response, &text::labels::name(number));
        if response.changed() {
            look.name = name;
        }
        let words = text::labels::opacity(number);
        ui.spacing_mut().interact_size.x = OPACITY_WIDTH;
        let field = DragValue::new(&mut look.opacity).range(0.0..=1.0).speed(0.005).fixed_decimals(3);
        ui.name_inputs(words, |ui| ui.add(field)).on_hover_text(text::labels::OPACITY_TIP);
    });
    if look != before {
        *table.entry(label.stands_for) = look;
    }
    only
}

/// What screen readers call a field of text, instead of what stands in it while it is empty.
fn name_text(field: &egui::Response, name: &str) {
    let is_enabled = field.enabled();
    field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, is_enabled, name));
}

/// Shows or hides a label. What looks so already needs no entry.
fn set_visible(table: &mut LabelTable, number: i64, visible: bool) {
    if table.look(number).visible != visible {
        *table.entry(number) = LabelLook { visible, ..table.look(number).into_owned() };
    }
}
