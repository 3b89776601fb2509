//! Comparison of two looks in one picture: left and right of a divider, or as an amplified difference. Two views
//! stand side by side, each centred in its part.

use eframe::egui::{self, Align2, CursorIcon, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2};
use eframe::egui::{WidgetInfo, pos2, vec2};

use super::{ViewportPictures, paint_callback};
use crate::app::common::theme;
use crate::app::text;
use crate::app::worker::request::ComparedLooks;
use chiaroscuro_render::PictureDistance;
use chiaroscuro_scene::{ComparisonVariant, Settings};

/// Half width of the divider's drag area, in points.
const DIVIDER_HALF_WIDTH: f32 = 7.0;
/// Radius of the divider's handle, in points.
const DIVIDER_HANDLE_RADIUS: f32 = 9.0;
/// Distance of labels from the border of the picture, in points.
const LABEL_MARGIN: f32 = 8.0;
/// Padding between a label and the border of its dark background, in points.
const LABEL_PADDING: Vec2 = Vec2::new(6.0, 3.0);

/// Settings of the comparison: its two sides and how they are displayed.
#[derive(Debug, Clone)]
pub(crate) struct Compare {
    /// True if two looks are compared.
    pub on: bool,
    /// Variant of the look left of the divider.
    pub left: ComparisonVariant,
    /// Variant of the look right of the divider.
    pub right: ComparisonVariant,
    /// Shows the amplified difference of the two pictures instead of both.
    pub difference: bool,
    /// Names of the looks on the left and on the right, if they are named looks.
    pub names: [Option<String>; 2],
    /// Position of the divider, as a fraction of the picture's width.
    divider: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            on: false,
            left: ComparisonVariant::Current,
            right: ComparisonVariant::Off,
            difference: false,
            names: [None, None],
            divider: 0.5,
        }
    }
}

impl Compare {
    /// Starts a comparison of the current look, on the left, with another one on the right.
    pub(crate) fn start_with(&mut self, look: Settings) {
        (self.on, self.left, self.right) =
            (true, ComparisonVariant::Current, ComparisonVariant::Look(Box::new(look)));
        self.names = [None, None];
    }

    /// Starts a comparison of two saved views or looks, or of the current look (`None`) on the left with one of them.
    pub(crate) fn start_with_saved(&mut self, settings: &Settings, left: Option<usize>, right: usize) {
        let variant = |at: usize| {
            settings.kept.get(at).map(|kept| match kept.as_look() {
                Some(look) => ComparisonVariant::Look(Box::new(look.clone())),
                None => ComparisonVariant::View(Box::new(kept.camera().clone())),
            })
        };
        let name = |at: usize| settings.kept.get(at).map(|kept| kept.name.clone());
        let names = [left.and_then(name), name(right)];
        let left = match left {
            Some(at) => variant(at),
            None => Some(ComparisonVariant::Current),
        };
        if let Some((left, right)) = left.zip(variant(right)) {
            (self.on, self.left, self.right) = (true, left, right);
            self.names = names;
        }
    }

    /// Ends a comparison with a look of several layers: they name their volumes by place, and others are shown now.
    pub(crate) fn leave_layered_looks(&mut self) {
        let is_layered = |side: &ComparisonVariant| matches!(side, ComparisonVariant::Look(look) if look.layers.count() > 1);
        if is_layered(&self.left) || is_layered(&self.right) {
            *self = Self { divider: self.divider, ..Self::default() };
        }
    }

    /// Returns the looks to be rendered: the current one, or the left and the right one of a comparison.
    pub(crate) fn looks(&self, settings: &Settings) -> ComparedLooks {
        // Kept views and looks do not affect the picture.
        let settings = Settings { kept: Vec::new(), ..settings.clone() };
        if self.on {
            ComparedLooks { left: self.left.apply(&settings), right: Some(self.right.apply(&settings)) }
        } else {
            ComparedLooks { left: settings, right: None }
        }
    }

    /// Returns the shapes of one or two pictures, each with the part of `rect` to which it is clipped.
    pub(crate) fn shapes(&self, rect: Rect, pictures: &ViewportPictures) -> [(Rect, Shape); 2] {
        let nothing = || (rect, Shape::Noop);
        let opaque = |picture| paint_callback::picture_shape(rect, picture, u8::MAX);
        let Some(left) = &pictures.left else {
            return [(rect, Shape::rect_filled(rect, 0.0, theme::EMPTY_CANVAS)), nothing()];
        };
        let Some(other) = pictures.compared.as_ref().filter(|_| self.on) else {
            let fading = pictures.fading.as_ref();
            let faded =
                fading.map(|(before, left)| (rect, paint_callback::picture_shape(rect, before, *left)));
            return [(rect, opaque(left)), faded.unwrap_or_else(nothing)];
        };
        if self.difference {
            return [(rect, opaque(&other.difference)), nothing()];
        }
        let (left_part, right_part) = rect.split_left_right_at_fraction(self.divider);
        let parts = [(left_part, left), (right_part, &other.right)];
        parts.map(|(part, picture)| {
            let moved = if self.shows_two_views() { part.center().x - rect.center().x } else { 0.0 };
            (part, paint_callback::shifted_picture_shape(rect, picture, moved / rect.width()))
        })
    }

    /// Returns true if the two sides have different cameras: then no overlay of the window fits both of them.
    pub(crate) fn shows_two_views(&self) -> bool {
        self.on && !self.difference && [&self.left, &self.right].iter().any(|side| is_view(side))
    }

    /// Returns the part of the picture that the comparison's labels leave free: without one row at the top and one at
    /// the bottom.
    pub(crate) fn area_without_labels(&self, ui: &Ui, rect: Rect) -> Rect {
        let font = egui::TextStyle::Small.resolve(ui.style());
        let row = ui.ctx().fonts_mut(|fonts| fonts.row_height(&font));
        rect.shrink2(vec2(0.0, if self.on { LABEL_MARGIN + row + 2.0 * LABEL_PADDING.y } else { 0.0 }))
    }

    /// Returns the names of the left and the right side.
    pub(crate) fn side_names(&self) -> [String; 2] {
        let sides = [(&self.left, &self.names[0]), (&self.right, &self.names[1])];
        sides.map(|(variant, name)| match (variant, name) {
            (ComparisonVariant::Look(_) | ComparisonVariant::View(_), Some(name)) => name.clone(),
            _ => text::comparison::variant_name(variant).to_owned(),
        })
    }

    /// Shows the divider, the names of both sides and the measured difference, over the picture.
    pub(crate) fn show(&mut self, ui: &Ui, rect: Rect, pictures: &ViewportPictures) {
        if !self.on || rect.width() < 4.0 * DIVIDER_HALF_WIDTH {
            return;
        }
        if !self.difference {
            self.drag_divider(ui, rect);
        }
        let [left, right] = &self.side_names();
        let label = |at: Pos2, align: Align2, text: &str| paint_label(ui, at, align, text);
        let top = rect.top() + LABEL_MARGIN;
        if self.difference {
            let words = text::picture::difference(left, right);
            label(pos2(rect.center().x, top), Align2::CENTER_TOP, &words);
        } else {
            // Beside the divider, since light chips and the orientation cube occupy the corners.
            let x = rect.left() + self.divider * rect.width();
            label(pos2(x - DIVIDER_HALF_WIDTH, top), Align2::RIGHT_TOP, left);
            label(pos2(x + DIVIDER_HALF_WIDTH, top), Align2::LEFT_TOP, right);
        }
        if let Some(other) = pictures.compared.as_ref().filter(|_| !self.shows_two_views()) {
            let PictureDistance { rmse, max: largest } = other.distance;
            let words = text::picture::error_metrics(rmse, largest);
            label(pos2(rect.center().x, rect.bottom() - LABEL_MARGIN), Align2::CENTER_BOTTOM, &words);
        }
    }

    /// Shows the divider line and lets the user drag it.
    fn drag_divider(&mut self, ui: &Ui, rect: Rect) {
        let x = rect.left() + self.divider * rect.width();
        let grip = Rect::from_x_y_ranges(x - DIVIDER_HALF_WIDTH..=x + DIVIDER_HALF_WIDTH, rect.y_range());
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
        painter.circle(middle, DIVIDER_HANDLE_RADIUS, theme::OUTLINE, Stroke::new(1.5, ink));
        for side in [-1.0, 1.0] {
            let tip = middle + vec2(side * 6.0, 0.0);
            let base = middle + vec2(side * 2.5, 0.0);
            let head = vec![tip, base + vec2(0.0, 3.5), base - vec2(0.0, 3.5)];
            painter.add(Shape::convex_polygon(head, ink, Stroke::NONE));
        }
        response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    }
}

fn is_view(variant: &ComparisonVariant) -> bool {
    matches!(variant, ComparisonVariant::View(_))
}

/// Paints a short label on a dark background.
fn paint_label(ui: &Ui, at: Pos2, align: Align2, text: &str) {
    let font = egui::TextStyle::Small.resolve(ui.style());
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(text.to_owned(), font, theme::PICTURE_TEXT);
    let rect = align.anchor_size(at, galley.size() + 2.0 * LABEL_PADDING);
    painter.rect_filled(rect, 4.0, theme::OUTLINE.gamma_multiply(0.8));
    painter.galley(rect.min + LABEL_PADDING, galley, theme::PICTURE_TEXT);
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
            assert_eq!(compare.area_without_labels(ui, rect), rect);
            compare.on = true;
            let left = compare.area_without_labels(ui, rect);
            assert_eq!((left.x_range(), left.center()), (rect.x_range(), rect.center()));
            let words =
                LABEL_MARGIN + 2.0 * LABEL_PADDING.y + egui::TextStyle::Small.resolve(ui.style()).size;
            assert!(left.top() - rect.top() > words && left.height() > 200.0, "{left}");
        });
        output.textures_delta.clear();
    }
}
