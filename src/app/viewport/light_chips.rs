//! Light chips at the top of the picture: one per light, showing its name, whether it is on and which is selected.

use eframe::egui::{self, Rect, Sense, Ui, UiBuilder, vec2};

use super::RendererStatus;
use crate::app::common::commands::AppCommand;
use crate::app::common::elide::elide_middle;
use crate::app::common::light_keys::solo;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{LightSettings, MAX_LIGHTS, Settings};

/// Width of the widest name, in points; longer names are elided in the middle and complete in the chip's tooltip.
const MAX_NAME_WIDTH: f32 = 140.0;

/// Shows the light chips and returns the rectangle that they cover.
pub(crate) fn show(
    ui: &mut Ui,
    picture: Rect,
    settings: &mut Settings,
    selected: &mut usize,
    facts: &RendererStatus,
    commands: &mut Vec<AppCommand>,
) -> Rect {
    let area =
        Rect::from_min_size(picture.min + vec2(8.0, 8.0), vec2((picture.width() - 130.0).max(80.0), 24.0));
    let mut ui = ui.new_child(UiBuilder::new().max_rect(area).id_salt("light chips"));
    ui.set_clip_rect(picture);
    let shown = ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(5.0, 5.0);
        let mut alone = None;
        for at in 0..settings.lights.len() {
            let is_selected = *selected == at;
            let volume = facts.light_volumes.get(at).copied().flatten();
            let response = chip(ui, &settings.lights[at], is_selected);
            let response = response.on_hover_text(chip_tip(&settings.lights[at], volume));
            if response.clicked() {
                *selected = at;
            }
            response.context_menu(|ui| {
                let light = &mut settings.lights[at];
                if ui.button(if light.on { text::lights::MUTE } else { text::lights::UNMUTE }).clicked() {
                    light.on ^= true;
                }
                if ui.button(text::lights::SOLO).clicked() {
                    alone = Some(at);
                }
                ui.checkbox(&mut light.casts_shadows, text::lights::CASTS_SHADOWS.name);
                let intensity = egui::Slider::new(&mut light.intensity, 0.0..=4.0);
                ui.add(intensity.text(text::lights::INTENSITY.name));
            });
        }
        if let Some(at) = alone {
            solo(&mut settings.lights, at);
        }
        if settings.lights.len() < MAX_LIGHTS {
            let plus = egui::RichText::new(text::lights::ADD_CHIP).color(theme::PICTURE_TEXT);
            let add = ui.add(egui::Button::new(plus).small().fill(chip_background(false)));
            let cost = facts.light_cost().map(|cost| text::shadows::cost(cost.ms, cost.mebibytes));
            if add.on_hover_text(text::lights::add_tip(cost.as_deref())).clicked() {
                commands.push(AppCommand::AddLight);
            }
        }
        // The row itself extends over the full available width.
        ui.min_rect()
    });
    shown.inner
}

fn chip_background(selected: bool) -> egui::Color32 {
    theme::OUTLINE.gamma_multiply(if selected { 0.9 } else { 0.6 })
}

/// Shows one chip: a dot in the light's colour, dimmed with its intensity and hollow if it is off, and the light's
/// name.
fn chip(ui: &mut Ui, light: &LightSettings, selected: bool) -> egui::Response {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let name = if light.name.is_empty() { text::lights::UNNAMED } else { &light.name };
    let ink = match (selected, light.on) {
        (true, _) => theme::ACCENT,
        (false, true) => theme::PICTURE_TEXT,
        (false, false) => theme::GUIDE.gamma_multiply(0.6),
    };
    let shown = elide_middle(ui, name, &egui::TextStyle::Button, MAX_NAME_WIDTH);
    let galley = ui.painter().layout_no_wrap(shown, font, ink);
    let size = vec2(galley.size().x + 30.0, 20.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let spoken = text::lights::chip(name, light.on);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::RadioButton, true, selected, &spoken));
    let painter = ui.painter();
    painter.rect_filled(rect, 10.0, chip_background(selected || response.hovered()));
    if selected || response.has_focus() {
        let stroke = egui::Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.8));
        painter.rect_stroke(rect, 10.0, stroke, egui::StrokeKind::Inside);
    }
    let dot = rect.left_center() + vec2(12.0, 0.0);
    let color = theme::color(light.color);
    if light.on {
        let strength = (0.35 + 0.65 * (light.intensity as f32).min(1.0)).min(1.0);
        painter.circle_filled(dot, 5.0, color.gamma_multiply(strength));
    } else {
        painter.circle_stroke(dot, 4.5, egui::Stroke::new(1.2, color.gamma_multiply(0.6)));
    }
    painter.galley(rect.left_center() + vec2(22.0, -galley.size().y / 2.0), galley, ink);
    response
}

/// Returns the tooltip of a light's chip: name, intensity, and the cost of its shadows.
fn chip_tip(light: &LightSettings, volume: Option<super::LightVolumeStatistics>) -> String {
    let shadows = match volume {
        _ if !light.casts_shadows => text::lights::NO_SHADOWS.to_owned(),
        None => text::lights::SHADOWS_PENDING.to_owned(),
        Some(volume) => {
            let mebibytes = volume.bytes as f64 / f64::from(1 << 20);
            text::lights::light_volume(volume.is_complete, volume.fill_ms, mebibytes)
        }
    };
    text::lights::chip_tip(&light.name, light.intensity, &shadows)
}
