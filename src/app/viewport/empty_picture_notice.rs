//! Notice over the picture when a look shows nothing of the volume, with buttons that remedy it.

use eframe::egui::{self, Align, Layout, Rect, RichText, Ui, UiBuilder, Vec2};

use super::RendererStatus;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::Volume;

/// Size of the notice, in points.
const SIZE: Vec2 = Vec2::new(340.0, 84.0);

/// Shows the notice if nothing of the volume is visible.
pub(crate) fn show_empty_picture_notice(
    ui: &mut Ui,
    picture: Rect,
    settings: &mut Settings,
    defaults: &Settings,
    volume: &Volume,
    facts: &RendererStatus,
) {
    if !facts.is_empty {
        return;
    }
    let area = Rect::from_center_size(picture.center(), SIZE.min(picture.size()));
    ui.painter_at(picture).rect_filled(area, 8.0, theme::OUTLINE.gamma_multiply(0.78));
    let layout = Layout::top_down(Align::Center);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(area.shrink(10.0)).layout(layout).id_salt("nothing"));
    ui.label(RichText::new(text::picture::NOTHING_VISIBLE).color(theme::PICTURE_TEXT));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let [something, reset] = [text::picture::SHOW_SOMETHING, text::picture::RESET_TRANSFER];
        if ui.add(egui::Button::new(something.name)).on_hover_text(something.tooltip).clicked() {
            *settings = first_look::with_visible_transfer(settings, volume);
        }
        if ui.add(egui::Button::new(reset.name)).on_hover_text(reset.tooltip).clicked() {
            settings.layer_mut().clone_from(defaults.layer());
        }
    });
}
