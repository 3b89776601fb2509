//! Notice over the picture when a look shows nothing of the volume, with buttons that remedy it.

use eframe::egui::{self, Align, Layout, Rect, RichText, Ui, UiBuilder, Vec2};

use super::Facts;
use crate::app::common::theme;
use crate::app::text;
use crate::data::Volume;
use crate::model::{Settings, auto};

/// Size of the notice, in points.
const SIZE: Vec2 = Vec2::new(340.0, 84.0);

/// Shows the notice if nothing of the volume is visible.
pub(crate) fn show(
    ui: &mut Ui,
    picture: Rect,
    settings: &mut Settings,
    defaults: &Settings,
    volume: &Volume,
    facts: &Facts,
) {
    if !facts.shows_nothing {
        return;
    }
    let area = Rect::from_center_size(picture.center(), SIZE.min(picture.size()));
    ui.painter_at(picture).rect_filled(area, 8.0, theme::OUTLINE.gamma_multiply(0.78));
    let layout = Layout::top_down(Align::Center);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(area.shrink(10.0)).layout(layout).id_salt("nothing"));
    ui.label(RichText::new(text::picture::NOTHING_SEEN).color(theme::EYE_CURVE));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let [something, reset] = [text::picture::SHOW_SOMETHING, text::picture::RESET_TRANSFER];
        if ui.add(egui::Button::new(something.name)).on_hover_text(something.tip).clicked() {
            *settings = auto::show_something(settings, volume);
        }
        if ui.add(egui::Button::new(reset.name)).on_hover_text(reset.tip).clicked() {
            settings.range = defaults.range;
            settings.transfer = defaults.transfer.clone();
            settings.labels = defaults.labels.clone();
            settings.lighting = defaults.lighting.clone();
            settings.opacity_unit = defaults.opacity_unit;
        }
    });
}
