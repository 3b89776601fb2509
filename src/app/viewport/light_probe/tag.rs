//! Tag of the light probe beside the pointer or the clicked point: the cause in one sentence, details, and remedies.

use eframe::egui::{self, Id, Order, Pos2, Rect, RichText, Ui, Vec2, vec2};

use super::diagnosis::{BrightnessCause, BrightnessRemedy};
use crate::app::common::overlay_windows::PROBE_TAG;
use crate::app::text;

/// Distance from the probed point to the tag, in points.
const TAG_OFFSET: f32 = 18.0;
/// Maximum width of the tag, in points.
const MAX_WIDTH: f32 = 320.0;

/// Contents of the light probe's tag.
pub(super) struct ProbeTag {
    /// Name of the probed material: in label maps, the label.
    pub subject: Option<String>,
    pub cause: Option<BrightnessCause>,
    /// Remedies that are offered as buttons.
    pub remedies: Vec<BrightnessRemedy>,
    /// Cause of the brightness, in one sentence.
    pub sentence: String,
    /// Details of the probed point, one per line.
    pub facts: String,
    /// Distance from the previously clicked point, with its unit.
    pub distance: Option<String>,
    /// Offset from the probed point to the occluder, in points: the tag lies on the other side.
    pub occluder_offset: Option<Vec2>,
    /// True if the point was clicked, so that the tag stays and can have buttons.
    pub is_pinned: bool,
}

/// Shows the tag beside a position of the picture; returns the remedy that the user clicked.
pub(super) fn show_probe_tag(ui: &Ui, picture: Rect, at: Pos2, tag: &ProbeTag) -> Option<BrightnessRemedy> {
    let mut chosen = None;
    // Away from the occluder, or on the side with more space.
    let is_right = tag.occluder_offset.map_or(at.x < picture.center().x, |lost| lost.x < 0.0);
    let is_below = tag.occluder_offset.map_or(at.y < picture.center().y, |lost| lost.y < 0.0);
    let pivot = match (is_right, is_below) {
        (true, true) => egui::Align2::LEFT_TOP,
        (true, false) => egui::Align2::LEFT_BOTTOM,
        (false, true) => egui::Align2::RIGHT_TOP,
        (false, false) => egui::Align2::RIGHT_BOTTOM,
    };
    let side = |positive: bool| if positive { TAG_OFFSET } else { -TAG_OFFSET };
    let place = at + vec2(side(is_right), side(is_below));
    let area = egui::Area::new(Id::unique(PROBE_TAG))
        .order(Order::Middle)
        .fixed_pos(place)
        .pivot(pivot)
        .constrain_to(picture.shrink(4.0))
        .interactable(tag.is_pinned);
    area.show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(MAX_WIDTH.min(picture.width() - 40.0));
            match &tag.subject {
                Some(subject) => {
                    ui.label(RichText::new(subject).strong());
                    ui.label(&tag.sentence);
                }
                None => {
                    ui.label(RichText::new(&tag.sentence).strong());
                }
            }
            if let Some(distance) = &tag.distance {
                ui.label(distance);
            }
            if !tag.is_pinned {
                // No hint to click where nothing is visible.
                if tag.cause.is_some() {
                    ui.weak(text::probe::CLICK);
                }
                return;
            }
            ui.weak(&tag.facts);
            if tag.remedies.is_empty() {
                return;
            }
            ui.horizontal_wrapped(|ui| {
                for &cure in &tag.remedies {
                    let text::ControlText { name, tooltip: tip } = cure.label();
                    if ui.button(name).on_hover_text(tip).clicked() {
                        chosen = Some(cure);
                    }
                }
            });
        });
    });
    chosen
}
