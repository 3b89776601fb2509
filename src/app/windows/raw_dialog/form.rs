//! Form of the raw import dialog: dimensions, voxel type, byte order, header size and spacing of a file.

use std::cmp::Ordering;

use eframe::egui::{self, DragValue, Response, Ui};

use crate::app::common::theme;
use crate::app::text;
use crate::app::text::raw::{RawLengthText, RawSpacingUnit};
use chiaroscuro_volume::VoxelType;
use chiaroscuro_volume_io::{Endian, RawGuess, RawLayout, raw::LayoutProposal};

/// Longest edge that can be typed, in voxels.
const MAX_EDGE: usize = 65_536;

/// Values of the form, and the known length of the file.
#[derive(Debug)]
pub(super) struct RawImportForm {
    guess: RawGuess,
    layout: RawLayout,
    /// Spacing of voxels in `unit`; kept while the unit is unknown.
    spacing: [f64; 3],
    unit: RawSpacingUnit,
    file_length: Option<RawLengthText>,
    /// True once the user has edited a value; then none is changed automatically.
    is_edited: bool,
}

impl RawImportForm {
    pub(super) fn new(guess: RawGuess) -> Self {
        let exact = RawLengthText { bytes: guess.file_bytes, is_exact: true };
        Self {
            guess,
            layout: guess.layout,
            spacing: [1.0; 3],
            unit: RawSpacingUnit::Unknown,
            file_length: (!guess.is_gzip).then_some(exact),
            is_edited: false,
        }
    }

    pub(super) fn is_gzip(&self) -> bool {
        self.guess.is_gzip
    }

    /// Layout of the file as currently entered.
    pub(super) fn layout(&self) -> RawLayout {
        let spacing_mm = self.unit.mm().map(|mm| self.spacing.map(|spacing| spacing * mm));
        RawLayout { spacing_mm, ..self.layout }
    }

    /// Takes over the length of the file and, unless the user has edited a value, the first proposal.
    pub(super) fn set_analysis(&mut self, length: Option<RawLengthText>, first: Option<&LayoutProposal>) {
        self.file_length = length.or(self.file_length);
        if let Some(first) = first.filter(|_| !self.is_edited) {
            self.layout = first.layout;
        }
    }

    /// Takes over a proposal; the spacing stays.
    pub(super) fn set_layout(&mut self, layout: &RawLayout) {
        self.layout = *layout;
        self.is_edited = true;
    }

    /// Returns true if the form matches a proposal.
    pub(super) fn has_layout(&self, layout: &RawLayout) -> bool {
        self.layout == *layout
    }

    /// Shows the fields, and returns the first of them.
    pub(super) fn show_fields(&mut self, ui: &mut Ui) -> Response {
        let before = self.layout;
        let grid = egui::Grid::new("raw layout").num_columns(2).spacing([12.0, 5.0]).show(ui, |ui| {
            ui.label(text::raw::VOXELS);
            let first = self.dims(ui);
            ui.end_row();
            ui.label(text::raw::NUMBER_TYPE);
            self.voxel_type(ui);
            ui.end_row();
            ui.label(text::raw::BYTE_ORDER);
            self.byte_order(ui);
            ui.end_row();
            ui.label(text::raw::HEADER);
            ui.horizontal(|ui| {
                let field = DragValue::new(&mut self.layout.offset);
                ui.name_inputs(text::raw::HEADER_BYTES, |ui| ui.add(field));
                ui.weak(text::raw::HEADER_UNIT);
            });
            ui.end_row();
            ui.label(text::raw::SPACING);
            self.spacing(ui);
            ui.end_row();
            first
        });
        self.is_edited |= self.layout != before;
        grid.inner
    }

    fn dims(&mut self, ui: &mut Ui) -> Response {
        let row = ui.horizontal(|ui| {
            let mut first = None;
            for (axis, n) in text::raw::AXES.into_iter().zip(&mut self.layout.dims) {
                let field = ui.name_inputs(text::raw::voxels_along(axis), |ui| {
                    ui.add(DragValue::new(n).range(1..=MAX_EDGE))
                });
                first.get_or_insert(field);
            }
            let label = ui.weak(text::raw::FASTEST_AXIS).on_hover_text(text::raw::FASTEST_AXIS_TIP);
            first.unwrap_or(label)
        });
        row.inner
    }

    fn voxel_type(&mut self, ui: &mut Ui) {
        let combo = egui::ComboBox::from_id_salt("voxel type").selected_text(self.layout.voxel_type.name());
        let shown = combo.show_ui(ui, |ui| {
            for voxel_type in VoxelType::ALL {
                ui.selectable_value(&mut self.layout.voxel_type, voxel_type, voxel_type.name());
            }
        });
        let named = || egui::WidgetInfo::labeled(egui::Role::ComboBox, true, text::raw::NUMBER_TYPE);
        shown.response.widget_info(named);
    }

    fn byte_order(&mut self, ui: &mut Ui) {
        let has_order = self.layout.voxel_type.bytes() > 1;
        ui.add_enabled_ui(has_order, |ui| {
            ui.horizontal(|ui| {
                for (endian, order) in [(Endian::Little, text::raw::LITTLE), (Endian::Big, text::raw::BIG)] {
                    let choice = ui.selectable_value(&mut self.layout.endian, endian, order.name);
                    choice.on_hover_text(order.tooltip).on_disabled_hover_text(text::raw::NO_ORDER);
                }
            });
        });
    }

    fn spacing(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.add_enabled_ui(self.unit != RawSpacingUnit::Unknown, |ui| {
                for (axis, spacing) in text::raw::AXES.into_iter().zip(&mut self.spacing) {
                    let field = DragValue::new(spacing).range(1e-6..=1e6).speed(0.01).max_decimals(6);
                    ui.name_inputs(text::raw::spacing_along(axis), |ui| ui.add(field));
                }
            });
            let combo =
                egui::ComboBox::from_id_salt("spacing unit").selected_text(self.unit.name()).width(80.0);
            let shown = combo.show_ui(ui, |ui| {
                for unit in RawSpacingUnit::ALL {
                    ui.selectable_value(&mut self.unit, unit, unit.name());
                }
            });
            let named = || egui::WidgetInfo::labeled(egui::Role::ComboBox, true, text::raw::SPACING_UNIT);
            shown.response.widget_info(named);
            shown.response.clone().on_hover_text(text::raw::SPACING_UNIT_TIP);
        });
    }

    /// Shows whether the file's length matches, with remedies; returns true if it does, or may.
    pub(super) fn show_length_check(&mut self, ui: &mut Ui) -> bool {
        let Some(RawLengthText { bytes: found, is_exact }) = self.file_length else {
            ui.weak(text::raw::COMPRESSED);
            return true;
        };
        let visuals = ui.visuals();
        let (good, warning, wrong) = (theme::good(visuals), visuals.warn_fg_color, visuals.error_fg_color);
        let Some(expected) = self.layout.file_bytes() else {
            ui.colored_label(wrong, text::raw::TOO_MANY);
            return false;
        };
        match expected.cmp(&found) {
            Ordering::Equal => ui.colored_label(good, text::raw::length_matches(found, is_exact)),
            Ordering::Less => ui.colored_label(warning, text::raw::surplus_bytes(found - expected)),
            Ordering::Greater => ui.colored_label(wrong, text::raw::missing_bytes(found, expected)),
        };
        ui.horizontal_wrapped(|ui| self.show_remedies(ui, found, expected));
        // The length in the trailer of a compressed file may be wrong.
        expected == found || !is_exact
    }

    /// Shows buttons that make the values match the file's length.
    fn show_remedies(&mut self, ui: &mut Ui, found: u64, expected: u64) {
        let before = self.layout;
        if expected < found && ui.small_button(text::raw::SKIP_SURPLUS).clicked() {
            self.layout.offset += found - expected;
        }
        if expected == found {
            return;
        }
        let [x, y, bytes] = [before.dims[0], before.dims[1], before.voxel_type.bytes()].map(|n| n as u64);
        let slice_bytes = (x * y * bytes).max(1);
        let voxel_bytes = found.saturating_sub(before.offset);
        let slices = voxel_bytes / slice_bytes;
        let is_possible = voxel_bytes.is_multiple_of(slice_bytes) && (1..=MAX_EDGE as u64).contains(&slices);
        if is_possible && ui.small_button(text::raw::with_slices(slices)).clicked() {
            self.layout.dims[2] = slices as usize;
        }
        let without_header = RawLayout { offset: 0, ..before };
        if before.offset > 0
            && without_header.file_bytes() == Some(found)
            && ui.small_button(text::raw::WITHOUT_HEADER).clicked()
        {
            self.layout.offset = 0;
        }
        self.is_edited |= self.layout != before;
    }
}
