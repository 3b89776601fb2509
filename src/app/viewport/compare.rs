//! Two looks in one picture: left and right of a divider, or what lies between them. Two views are beside each other,
//! each with its middle in that of its part.

use eframe::egui::{self, Align2, CursorIcon, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2};
use eframe::egui::{WidgetInfo, pos2, vec2};

use super::{Pictures, paint_callback};
use crate::app::common::theme;
use crate::app::text;
use crate::app::worker::request::Looks;
use crate::gpu::Distance;
use crate::model::{Settings, Variant};

/// Points to either side of the divider in which it can be taken.
const GRIP: f32 = 7.0;
/// Radius of its handle.
const HANDLE: f32 = 9.0;
/// Points from the edge of the picture to words over it.
const MARGIN: f32 = 8.0;
/// Points around words, on their dark background.
const PADDING: Vec2 = Vec2::new(6.0, 3.0);

/// What is compared, and how.
#[derive(Debug, Clone)]
pub(crate) struct Compare {
    /// Whether two looks are shown.
    pub on: bool,
    /// The look left of the divider.
    pub left: Variant,
    /// The look right of the divider.
    pub right: Variant,
    /// Show what lies between them instead.
    pub difference: bool,
    /// What the looks on the left and on the right are called, where they are looks that have names.
    pub names: [Option<String>; 2],
    /// The divider's place, as a share of the width.
    divider: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            on: false,
            left: Variant::Current,
            right: Variant::Off,
            difference: false,
            names: [None, None],
            divider: 0.5,
        }
    }
}

impl Compare {
    /// Shows the current look on the left and another one on the right.
    pub(crate) fn with(&mut self, look: Settings) {
        (self.on, self.left, self.right) = (true, Variant::Current, Variant::Look(Box::new(look)));
        self.names = [None, None];
    }

    /// What is to be rendered: the look, or the left and the right one.
    pub(crate) fn looks(&self, settings: &Settings) -> Looks {
        // What is kept is no part of a picture.
        let settings = Settings { kept: Vec::new(), ..settings.clone() };
        if self.on {
            Looks { left: self.left.of(&settings), right: Some(self.right.of(&settings)) }
        } else {
            Looks { left: settings, right: None }
        }
    }

    /// The picture, or two of them, and the part of the rectangle in which each is seen.
    pub(crate) fn shapes(&self, rect: Rect, pictures: &Pictures) -> [(Rect, Shape); 2] {
        let nothing = || (rect, Shape::Noop);
        let opaque = |picture| paint_callback::picture(rect, picture, u8::MAX);
        let Some(left) = &pictures.left else {
            return [(rect, Shape::rect_filled(rect, 0.0, theme::EMPTY_CANVAS)), nothing()];
        };
        let Some(other) = pictures.other.as_ref().filter(|_| self.on) else {
            let fading = pictures.fading.as_ref();
            let faded = fading.map(|(before, left)| (rect, paint_callback::picture(rect, before, *left)));
            return [(rect, opaque(left)), faded.unwrap_or_else(nothing)];
        };
        if self.difference {
            return [(rect, opaque(&other.difference)), nothing()];
        }
        let (left_part, right_part) = rect.split_left_right_at_fraction(self.divider);
        let parts = [(left_part, left), (right_part, &other.right)];
        parts.map(|(part, picture)| {
            let moved = if self.shows_two_views() { part.center().x - rect.center().x } else { 0.0 };
            (part, paint_callback::moved_picture(rect, picture, moved / rect.width()))
        })
    }

    /// Whether the two are seen from different places: then nothing in the window lies over both of them.
    pub(crate) fn shows_two_views(&self) -> bool {
        self.on && !self.difference && [&self.left, &self.right].iter().any(|side| is_view(side))
    }

    /// What the words of a comparison leave of the picture: its middle, without a row at the top and one at the bottom.
    pub(crate) fn beside_words(&self, ui: &Ui, rect: Rect) -> Rect {
        let font = egui::TextStyle::Small.resolve(ui.style());
        let row = ui.ctx().fonts_mut(|fonts| fonts.row_height(&font));
        rect.shrink2(vec2(0.0, if self.on { MARGIN + row + 2.0 * PADDING.y } else { 0.0 }))
    }

    /// What the left and the right one are called.
    pub(crate) fn called(&self) -> [String; 2] {
        let sides = [(&self.left, &self.names[0]), (&self.right, &self.names[1])];
        sides.map(|(variant, name)| match (variant, name) {
            (Variant::Look(_) | Variant::View(_), Some(name)) => name.clone(),
            _ => text::compared::variant(variant).to_owned(),
        })
    }

    /// The divider and what is known of the difference, over the picture.
    pub(crate) fn ui(&mut self, ui: &Ui, rect: Rect, pictures: &Pictures) {
        if !self.on || rect.width() < 4.0 * GRIP {
            return;
        }
        if !self.difference {
            self.divide(ui, rect);
        }
        let [left, right] = &self.called();
        let label = |at: Pos2, align: Align2, text: &str| chip(ui, at, align, text);
        let top = rect.top() + MARGIN;
        if self.difference {
            let words = text::picture::difference(left, right);
            label(pos2(rect.center().x, top), Align2::CENTER_TOP, &words);
        } else {
            // Beside the divider: lights and cube have the corners.
            let x = rect.left() + self.divider * rect.width();
            label(pos2(x - GRIP, top), Align2::RIGHT_TOP, left);
            label(pos2(x + GRIP, top), Align2::LEFT_TOP, right);
        }
        if let Some(other) = pictures.other.as_ref().filter(|_| !self.shows_two_views()) {
            let Distance { rmse, largest } = other.distance;
            let words = text::picture::distance(rmse, largest);
            label(pos2(rect.center().x, rect.bottom() - MARGIN), Align2::CENTER_BOTTOM, &words);
        }
    }

    /// The line that can be dragged.
    fn divide(&mut self, ui: &Ui, rect: Rect) {
        let x = rect.left() + self.divider * rect.width();
        let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
        let response = ui.interact(grip, ui.scope_id().with("divider"), Sense::drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, text::picture::DIVIDER));
        if let Some(pointer) = response.interact_pointer_pos() {
            self.divider = ((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
        }
        let active = response.hovered() || response.dragged();
        let ink = if active { theme::ACCENT } else { theme::GUIDE };
        let x = rect.left() + self.divider * rect.width();
        let painter = ui.painter();
        painter.vline(x, rect.y_range(), Stroke::new(3.0, theme::OUTLINE));
        painter.vline(x, rect.y_range(), Stroke::new(1.0, ink));
        let middle = pos2(x, rect.center().y);
        painter.circle(middle, HANDLE, theme::OUTLINE, Stroke::new(1.5, ink));
        for side in [-1.0, 1.0] {
            let tip = middle + vec2(side * 6.0, 0.0);
            let base = middle + vec2(side * 2.5, 0.0);
            let head = vec![tip, base + vec2(0.0, 3.5), base - vec2(0.0, 3.5)];
            painter.add(Shape::convex_polygon(head, ink, Stroke::NONE));
        }
        response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    }
}

fn is_view(variant: &Variant) -> bool {
    matches!(variant, Variant::View(_))
}

/// A few words on a dark background.
fn chip(ui: &Ui, at: Pos2, align: Align2, text: &str) {
    let font = egui::TextStyle::Small.resolve(ui.style());
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(text.to_owned(), font, theme::EYE_CURVE);
    let rect = align.anchor_size(at, galley.size() + 2.0 * PADDING);
    painter.rect_filled(rect, 4.0, theme::OUTLINE.gamma_multiply(0.8));
    painter.galley(rect.min + PADDING, galley, theme::EYE_CURVE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_leave_a_picture_without_two_rows() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(400.0, 300.0));
        let ctx = egui::Context::default();
        let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
            let mut compare = Compare::default();
            assert_eq!(compare.beside_words(ui, rect), rect);
            compare.on = true;
            let left = compare.beside_words(ui, rect);
            assert_eq!((left.x_range(), left.center()), (rect.x_range(), rect.center()));
            let words = MARGIN + 2.0 * PADDING.y + egui::TextStyle::Small.resolve(ui.style()).size;
            assert!(left.top() - rect.top() > words && left.height() > 200.0, "{left}");
        });
        output.textures_delta.clear();
    }
}
