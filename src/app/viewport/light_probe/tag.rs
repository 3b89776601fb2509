//! The tag beside the pointer, or beside the place that was clicked: the cause in one sentence, what is known, and what
//! helps.

use eframe::egui::{self, Id, Order, Pos2, Rect, RichText, Ui, Vec2, vec2};

use super::cause::{Cause, Cure};
use crate::app::common::frame::PROBE_TAG;
use crate::app::text;

/// Points from the place to the tag.
const ASIDE: f32 = 18.0;
/// Points of the widest tag.
const WIDEST: f32 = 320.0;

/// What a tag says.
pub(super) struct Tag {
    /// What is there, by its name: of label maps, the label.
    pub subject: Option<String>,
    pub cause: Option<Cause>,
    /// What helps.
    pub cures: Vec<Cure>,
    /// The cause in words.
    pub sentence: String,
    /// What is known, a line each.
    pub facts: String,
    /// How far it is from the place that was clicked before.
    pub distance: Option<String>,
    /// Where light is lost, as seen from the place: the tag lies on the other side.
    pub lost: Option<Vec2>,
    /// The place was clicked: there is time for buttons.
    pub is_pinned: bool,
}

/// Shows the tag beside a place of the picture; what the user wants to be done.
pub(super) fn show(ui: &Ui, picture: Rect, at: Pos2, tag: &Tag) -> Option<Cure> {
    let mut chosen = None;
    // Away from what it speaks of, or on the side where there is more room.
    let is_right = tag.lost.map_or(at.x < picture.center().x, |lost| lost.x < 0.0);
    let is_below = tag.lost.map_or(at.y < picture.center().y, |lost| lost.y < 0.0);
    let pivot = match (is_right, is_below) {
        (true, true) => egui::Align2::LEFT_TOP,
        (true, false) => egui::Align2::LEFT_BOTTOM,
        (false, true) => egui::Align2::RIGHT_TOP,
        (false, false) => egui::Align2::RIGHT_BOTTOM,
    };
    let side = |positive: bool| if positive { ASIDE } else { -ASIDE };
    let place = at + vec2(side(is_right), side(is_below));
    let area = egui::Area::new(Id::unique(PROBE_TAG))
        .order(Order::Middle)
        .fixed_pos(place)
        .pivot(pivot)
        .constrain_to(picture.shrink(4.0))
        .interactable(tag.is_pinned);
    area.show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(WIDEST.min(picture.width() - 40.0));
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
                // Where nothing is seen, nothing is dark.
                if tag.cause.is_some() {
                    ui.weak(text::probe::CLICK);
                }
                return;
            }
            ui.weak(&tag.facts);
            if tag.cures.is_empty() {
                return;
            }
            ui.horizontal_wrapped(|ui| {
                for &cure in &tag.cures {
                    let text::Named { name, tip } = cure.named();
                    if ui.button(name).on_hover_text(tip).clicked() {
                        chosen = Some(cure);
                    }
                }
            });
        });
    });
    chosen
}
