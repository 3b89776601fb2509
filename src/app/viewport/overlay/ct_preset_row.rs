//! Row of CT presets at the bottom of the picture, one click each, with a button that hides the table under the body;
//! shown for every CT volume until the user closes it.

use std::path::PathBuf;

use eframe::egui::{self, Align, Color32, Layout, Rect, RichText, Stroke, Ui, UiBuilder, vec2};

use crate::app::common::commands::AppCommand;
use crate::app::common::preset_match::PresetMatchCache;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_scene::{PRESETS, Settings};

/// Height of the row, and distance from its bottom to the bottom of the picture, which leaves space for the
/// orientation letters; both in points.
const HEIGHT: f32 = 30.0;
const BOTTOM_MARGIN: f32 = 34.0;

/// Padding beside the row's contents, and gap between its items, both in points.
const MARGIN: f32 = 10.0;
const GAP: f32 = 4.0;

/// State of the row of CT presets between frames.
#[derive(Debug, Default)]
pub(crate) struct CtPresetRow {
    closed_for: Option<PathBuf>,
    active_preset: PresetMatchCache,
}

impl CtPresetRow {
    /// Shows the row over pictures of a CT that are large enough.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        picture: Rect,
        settings: &Settings,
        volume: &VolumeFacts,
        commands: &mut Vec<AppCommand>,
    ) {
        let presets =
            PRESETS.into_iter().filter(|preset| preset.domain() == "ct" && preset.suits_data(&volume.kind));
        let presets: Vec<_> = presets.collect();
        if presets.is_empty() || self.closed_for.as_ref() == Some(&volume.source) {
            return;
        }
        self.active_preset.update(ui, settings, &volume.ranges);
        let font = egui::TextStyle::Button.resolve(ui.style());
        let padding = ui.spacing().button_padding.x;
        let width_of = |words: &str| {
            let laid = ui.painter().layout_no_wrap(words.to_owned(), font.clone(), theme::PICTURE_TEXT);
            laid.size().x + GAP
        };
        // Buttons have padding around their titles.
        let titles: f32 = presets.iter().map(|preset| width_of(preset.title) + 2.0 * padding).sum();
        let width = width_of(text::picture::CT_LOOKS) + titles + width_of(text::picture::CLOSE_CT_LOOKS_SIGN);
        // Narrow pictures have the presets alone.
        let table = width_of(text::picture::HIDE_TABLE.name) + 2.0 * padding;
        let has_table = picture.width() >= width + table - GAP + 4.0 * MARGIN;
        let width = if has_table { width + table } else { width };
        let size = vec2(width - GAP + 2.0 * MARGIN, HEIGHT);
        if picture.width() < size.x + 2.0 * MARGIN || picture.height() < 8.0 * HEIGHT {
            return;
        }
        let foot = picture.center_bottom() - vec2(0.0, BOTTOM_MARGIN + HEIGHT / 2.0);
        let area = Rect::from_center_size(foot, size);
        ui.painter_at(picture).rect_filled(area, 8.0, theme::OUTLINE.gamma_multiply(0.78));
        let layout = Layout::left_to_right(Align::Center);
        let inside = area.shrink2(vec2(MARGIN, 0.0));
        let mut ui = ui.new_child(UiBuilder::new().max_rect(inside).layout(layout).id_salt("ct looks"));
        ui.spacing_mut().item_spacing.x = GAP;
        ui.label(RichText::new(text::picture::CT_LOOKS).color(theme::PICTURE_TEXT));
        for preset in presets {
            let button = switch_button(&mut ui, preset.title, self.active_preset.is_in_use(&preset));
            // The description is parsed from the preset's text, hence only when the tooltip opens.
            let button = button.on_hover_ui(|ui| {
                ui.label(preset.description());
            });
            if button.clicked() {
                commands.push(AppCommand::UsePreset(preset));
            }
        }
        if has_table {
            let named = text::picture::HIDE_TABLE;
            let button = switch_button(&mut ui, named.name, settings.volume.hidden_table.is_some());
            if button.on_hover_text(named.tooltip).clicked() {
                commands.push(AppCommand::ToggleTable);
            }
        }
        let close = egui::Button::new(RichText::new(text::picture::CLOSE_CT_LOOKS_SIGN).color(theme::GUIDE));
        let close = ui.add(close.frame(false)).on_hover_text(text::picture::CLOSE_CT_LOOKS);
        close.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, true, text::picture::CLOSE_CT_LOOKS)
        });
        if close.clicked() {
            self.closed_for = Some(volume.source.clone());
        }
    }
}

/// Button that is filled while what it does is in use.
fn switch_button(ui: &mut Ui, title: &str, is_used: bool) -> egui::Response {
    let (ink, fill) =
        if is_used { (theme::OUTLINE, theme::ACCENT) } else { (theme::ACCENT, Color32::TRANSPARENT) };
    let words = RichText::new(title).color(ink);
    let button = ui.add(egui::Button::new(words).fill(fill).stroke(Stroke::NONE).corner_radius(5.0));
    button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_used, title));
    button
}
