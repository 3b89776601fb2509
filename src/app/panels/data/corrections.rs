//! Corrections of a volume's metadata, a part of the section "Data".

use eframe::egui::{self, DragValue, Ui};

use super::super::controls::{
    format_number, format_spacing as spacing_in_words, reset_button_cell, row, switch_row, unlabelled_row,
};
use crate::app::common::reveal;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{
    AnatomicalAxes, AxisOrder, Corrections, Orientation, PaddingValue, SpacingUnit, ValueScale, Volume,
};

/// Share of a number by which a drag of one point changes it: 200 points double it.
const DRAG_SPEED: f64 = 1.0 / 200.0;

/// Width of a spacing field, in points; three of them fit in a row.
const SPACING_FIELD_WIDTH: f32 = 48.0;

/// Width of a drop-down list, in points.
const LIST_WIDTH: f32 = 120.0;

/// Shows the corrections. An edit is applied when the pointer is released or a number has been typed: it is one undo
/// step, and the volume is recomputed once.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, volume: &VolumeFacts) {
    let header = egui::CollapsingHeader::new(text::corrections::TITLE).id_salt("corrections");
    let opens = reveal::should_open(ui.ctx(), text::sections::DATA, true);
    header.open(opens.then_some(true)).show_unindented(ui, |ui| {
        let pending_id = ui.scope_id().with("held");
        let known = settings.volume;
        let mut edited = ui.data(|data| data.get_temp(pending_id)).unwrap_or(known);
        rows(ui, &mut edited, &volume.volume, settings);
        edited.sanitise();
        let is_held = ui.ctx().dragged_id().is_some();
        if is_held && edited != known {
            ui.data_mut(|data| data.insert_temp(pending_id, edited));
        } else {
            ui.data_mut(|data| data.remove::<Corrections>(pending_id));
            if edited != known {
                settings.apply_corrections(edited, &volume.volume);
            }
        }
    });
}

fn rows(ui: &mut Ui, by: &mut Corrections, volume: &Volume, settings: &Settings) {
    let uncorrected = volume.as_opened();
    spacing(ui, by, uncorrected);
    unit(ui, by, uncorrected);
    flip(ui, by);
    axis_order(ui, by);
    orientation(ui, by, uncorrected);
    padding(ui, by, uncorrected);
    value_scale(ui, &mut by.value_scale);
    table(ui, by, volume, settings);
    unlabelled_row(ui, |ui| {
        let button = egui::Button::new(text::corrections::RESET.name);
        let response = ui.add_enabled(!by.is_none(), button);
        if response.on_hover_text(text::corrections::RESET.tooltip).clicked() {
            *by = Corrections::default();
        }
    });
}

/// Shows a row whose tooltip states the value in the file; returns true if the reset button was clicked.
fn corrected_row(
    ui: &mut Ui,
    named: ControlText,
    in_file: &str,
    differs: bool,
    add: impl FnOnce(&mut Ui, &str),
) -> bool {
    let tip = text::corrections::tooltip_with_metadata(named, in_file);
    row(ui, named, |ui| {
        add(ui, &tip);
        reset_button_cell(ui, named.name, differs.then_some(in_file))
    })
}

fn spacing(ui: &mut Ui, by: &mut Corrections, opened: &Volume) {
    let in_file: [f64; 3] = opened.file_spacing_mm().into();
    let file_text = spacing_in_words(in_file, opened.has_unknown_scale());
    let mut lengths = by.spacing.unwrap_or(in_file);
    let is_reset =
        corrected_row(ui, text::corrections::SPACING, &file_text, by.spacing.is_some(), |ui, tip| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for (axis, length) in text::corrections::AXES.into_iter().zip(&mut lengths) {
                let speed = *length * DRAG_SPEED;
                let field = DragValue::new(length)
                    .speed(speed)
                    .range(1e-9..=1e9)
                    .max_decimals(6)
                    .update_while_editing(false)
                    .clamp_existing_to_range(false);
                let size = [SPACING_FIELD_WIDTH, ui.spacing().interact_size.y];
                let name = text::corrections::spacing_along(axis);
                ui.name_inputs(&name, |ui| ui.add_sized(size, field)).on_hover_text(tip);
            }
        });
    if is_reset {
        by.spacing = None;
    } else if lengths != by.spacing.unwrap_or(in_file) {
        by.spacing = Some(lengths);
    }
}

/// Shows a drop-down list of choices, the first of which keeps the value in the file.
fn choice_list<T: PartialEq + Copy>(
    ui: &mut Ui,
    named: ControlText,
    tip: &str,
    chosen: &mut T,
    options: &[(T, String)],
) {
    let shown = options.iter().find(|(option, _)| option == chosen).map_or("", |(_, name)| name);
    let combo = egui::ComboBox::from_id_salt(named.name).selected_text(shown).width(LIST_WIDTH);
    let response = ui.name_inputs(named.name, |ui| {
        combo.show_ui(ui, |ui| {
            for (option, name) in options {
                ui.selectable_value(chosen, *option, name);
            }
        })
    });
    response.response.on_hover_text(tip);
}

fn unit(ui: &mut Ui, by: &mut Corrections, opened: &Volume) {
    let in_file = opened.file_spacing_mm().into();
    let said = text::data::unit_of_spacing(in_file, opened.has_unknown_scale()).symbol();
    let units = SpacingUnit::ALL.map(|unit| (Some(unit), text::corrections::unit(unit).to_owned()));
    let options: Vec<_> =
        std::iter::once((None, text::corrections::IN_FILE.to_owned())).chain(units).collect();
    let differs = by.unit.is_some();
    if corrected_row(ui, text::corrections::UNIT, said, differs, |ui, tip| {
        choice_list(ui, text::corrections::UNIT, tip, &mut by.unit, &options);
    }) {
        by.unit = None;
    }
}

fn flip(ui: &mut Ui, by: &mut Corrections) {
    let named = text::corrections::FLIP;
    row(ui, named, |ui| {
        let axes = [&mut by.flip.x, &mut by.flip.y, &mut by.flip.z];
        for (axis, is_flipped) in text::corrections::AXES.into_iter().zip(axes) {
            let response = ui.checkbox(is_flipped, axis).on_hover_text(named.tooltip);
            let name = text::corrections::flip(axis);
            let is_flipped = *is_flipped;
            response
                .widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_flipped, &name));
        }
    });
}

fn axis_order(ui: &mut Ui, by: &mut Corrections) {
    let options = AxisOrder::ALL.map(|order| (order, text::corrections::order(order).to_owned()));
    let (named, file) = (text::corrections::AXIS_ORDER, AxisOrder::default());
    let differs = by.axis_order != file;
    if corrected_row(ui, named, text::corrections::order(file), differs, |ui, tip| {
        choice_list(ui, named, tip, &mut by.axis_order, &options);
    }) {
        by.axis_order = file;
    }
}

fn orientation(ui: &mut Ui, by: &mut Corrections, opened: &Volume) {
    let axes = opened.world_from_index().matrix3;
    let said = if opened.is_anatomical() {
        AnatomicalAxes::nearest([axes.x_axis, axes.y_axis, axes.z_axis]).to_string()
    } else {
        text::corrections::NO_METADATA.to_owned()
    };
    let mut options = vec![
        (None, text::corrections::IN_FILE.to_owned()),
        (Some(Orientation::Unknown), text::corrections::UNKNOWN.to_owned()),
    ];
    options.extend(Orientation::all_anatomical().map(|towards| (Some(towards), towards.to_string())));
    let differs = by.orientation.is_some();
    let named = text::corrections::ORIENTATION;
    if corrected_row(ui, named, &said, differs, |ui, tip| {
        choice_list(ui, named, tip, &mut by.orientation, &options);
    }) {
        by.orientation = None;
    }
}

fn padding(ui: &mut Ui, by: &mut Corrections, opened: &Volume) {
    let in_file = opened.padding_value();
    let said = in_file.map_or_else(|| text::corrections::NO_PADDING.to_owned(), format_number);
    // Initial value of the typed padding: the one the file declares, or the lowest value, which usually surrounds
    // objects.
    let first = in_file.unwrap_or_else(|| opened.value_range().low);
    let typed = match by.padding_value {
        PaddingValue::Value(value) => value,
        PaddingValue::InFile | PaddingValue::Nothing => by.value_scale.value_from_number(first),
    };
    let options = [
        (PaddingValue::InFile, text::corrections::IN_FILE.to_owned()),
        (PaddingValue::Nothing, text::corrections::NO_PADDING.to_owned()),
        (PaddingValue::Value(typed), text::corrections::PADDING_TYPED.to_owned()),
    ];
    let differs = by.padding_value != PaddingValue::InFile;
    let named = text::corrections::PADDING;
    if corrected_row(ui, named, &said, differs, |ui, tip| {
        choice_list(ui, named, tip, &mut by.padding_value, &options);
    }) {
        by.padding_value = PaddingValue::InFile;
    }
    if let PaddingValue::Value(value) = &mut by.padding_value {
        unlabelled_row(ui, |ui| {
            let named = text::corrections::PADDING_VALUE;
            let speed = opened.value_range().span().max(1.0) * DRAG_SPEED;
            let field = DragValue::new(value).speed(speed).max_decimals(6).update_while_editing(false);
            ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip);
        });
    }
}

/// Shows the switch that hides the table under a body, and whether one was found.
fn table(ui: &mut Ui, by: &mut Corrections, volume: &Volume, settings: &Settings) {
    let mut is_hidden = by.hidden_table.is_some();
    if switch_row(ui, text::corrections::HIDE_TABLE, &mut is_hidden).changed() {
        by.hidden_table = is_hidden.then(|| settings.material_threshold(volume));
    }
    if volume.lacks_table() {
        ui.weak(text::corrections::NO_TABLE);
    }
}

fn value_scale(ui: &mut Ui, scale: &mut ValueScale) {
    let (said, differs) = (text::corrections::NO_SCALE, !scale.is_none());
    if corrected_row(ui, text::corrections::VALUE_SCALE, said, differs, |ui, tip| {
        let numbers = [
            (text::corrections::TIMES, text::corrections::SLOPE, &mut scale.slope, 0.01),
            (text::corrections::PLUS, text::corrections::INTERCEPT, &mut scale.intercept, 1.0),
        ];
        for (sign, name, number, speed) in numbers {
            ui.weak(sign);
            let field = DragValue::new(number).speed(speed).max_decimals(6).update_while_editing(false);
            ui.name_inputs(name, |ui| ui.add(field)).on_hover_text(tip);
        }
    }) {
        *scale = ValueScale::default();
    }
}
