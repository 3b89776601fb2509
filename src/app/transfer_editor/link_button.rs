//! Link button between the curves of eye and light: a chain, closed while light uses the eye's curve.

use eframe::egui::{self, Pos2, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};
use std::f32::consts::{PI, TAU};

use super::super::text;
use crate::app::common::theme;
use crate::app::panels::set_linked;
use chiaroscuro_scene::VolumeLayer;

/// Size of the button, half the straight length of a link, and the radius of its round ends, in points.
const BUTTON_SIZE: Vec2 = Vec2::new(20.0, 18.0);
const LINK_HALF_LENGTH: f32 = 2.0;
const LINK_RADIUS: f32 = 2.8;

/// Shows the button; a click links the two curves, or gives light a curve of its own.
pub(super) fn show(ui: &mut Ui, layer: &mut VolumeLayer) {
    let is_linked = layer.lighting.linked;
    let (rect, response) = ui.allocate_exact_size(BUTTON_SIZE, Sense::click());
    let named = text::transfer::LINK;
    response.widget_info(|| WidgetInfo::selected(egui::Role::CheckBox, true, is_linked, named.name));
    let ink = if response.hovered() || response.has_focus() {
        ui.visuals().strong_text_color()
    } else if is_linked {
        theme::accent(ui.visuals())
    } else {
        ui.visuals().weak_text_color()
    };
    // Closed links overlap; open ones are apart.
    let apart = if is_linked { 3.0 } else { 5.5 };
    for side in [-1.0, 1.0] {
        let middle = rect.center() + vec2(side * apart, 0.0);
        ui.painter().add(Shape::closed_line(link_outline(middle), Stroke::new(1.4, ink)));
    }
    let tip = if is_linked { text::transfer::UNLINK_TIP } else { named.tooltip };
    if response.on_hover_text(tip).clicked() {
        set_linked(layer, !is_linked);
    }
}

/// Outline of one horizontal link around its centre.
fn link_outline(middle: Pos2) -> Vec<Pos2> {
    let half_circle = |from: f32, x: f32| {
        (0..=8).map(move |at| {
            let (sine, cosine) = (from + PI * at as f32 / 8.0).sin_cos();
            middle + vec2(x + LINK_RADIUS * cosine, LINK_RADIUS * sine)
        })
    };
    half_circle(0.75 * TAU, LINK_HALF_LENGTH).chain(half_circle(0.25 * TAU, -LINK_HALF_LENGTH)).collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::Rect;

    use super::*;

    #[test]
    fn links_reach_into_each_other() {
        let bounds = Rect::from_points(&link_outline(Pos2::ZERO));
        assert!((bounds.width() - 2.0 * (LINK_HALF_LENGTH + LINK_RADIUS)).abs() < 1e-3, "{bounds:?}");
        assert!(
            (bounds.height() - 2.0 * LINK_RADIUS).abs() < 1e-3 && bounds.center().distance(Pos2::ZERO) < 1e-3
        );
    }
}
