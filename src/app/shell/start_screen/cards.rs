//! Cards of the built-in scenes: a picture each, with the name and a line, in a grid whose last place opens files.

use eframe::egui::{
    self, Align2, Color32, Rect, Response, Role, Sense, Stroke, StrokeKind, Vec2, WidgetInfo, vec2,
};

use super::live_card::{LiveCard, PointedCard};
use super::scene_pictures::ScenePictures;
use super::{focus_by_arrow_key, open_buttons, scenes};
use crate::app::common::commands::AppCommand;
use crate::app::common::theme;
use crate::app::text;

/// Least width of a card, in points: its line fits into it.
const MIN_WIDTH: f32 = 190.0;

/// Largest width of a card, in points: beyond it the pictures would be enlarged on usual screens.
const MAX_WIDTH: f32 = 480.0;

/// Largest number of cards side by side: with the place for files, six make two rows.
const MAX_COLUMNS: usize = 3;

/// Gap between cards, in points.
const GAP: f32 = 14.0;

/// Height of a card's name and line below the picture, in points: two lines of text, and space around them.
const CAPTION_HEIGHT: f32 = 44.0;

/// Radius of a picture's corners, in points.
const CORNER_RADIUS: f32 = 6.0;

/// Grid of the cards.
pub(super) struct CardGrid<'a> {
    /// Pictures of the scenes.
    pub pictures: &'a ScenePictures,
    /// Scene that is rendered live, in place of its picture.
    pub live: &'a LiveCard,
}

/// Returns the number of columns, and the width of a card, that fill a width.
fn columns(room: f32) -> (usize, f32) {
    let count = ((room + GAP) / (MIN_WIDTH + GAP)).floor().clamp(1.0, MAX_COLUMNS as f32);
    let width = ((room + GAP) / count - GAP).clamp(1.0, MAX_WIDTH);
    (count as usize, width.floor())
}

impl CardGrid<'_> {
    /// Shows the cards, adds the command of the one that is clicked, and returns the one under the pointer.
    pub(super) fn show(&self, ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) -> Option<PointedCard> {
        let (columns, width) = columns(ui.available_width());
        // 4:3, as the pictures are.
        let size = vec2(width, (width * 0.75).round() + CAPTION_HEIGHT);
        let pixels = (size - vec2(0.0, CAPTION_HEIGHT)) * ui.pixels_per_point();
        let pixels = [pixels.x, pixels.y].map(|length| length.round() as u32);
        let (mut first, mut pointed) = (None, None);
        egui::Grid::new("scene cards").spacing([GAP, GAP]).show(ui, |ui| {
            let mut place = 0;
            for (scene, volume) in scenes() {
                let card = self.card(ui, size, volume, scene.title);
                first.get_or_insert(card.id);
                if card.clicked() {
                    commands.push(AppCommand::OpenScene(scene));
                }
                if card.hovered() {
                    pointed = Some(PointedCard { scene, volume, size: pixels });
                }
                place += 1;
                if place % columns == 0 {
                    ui.end_row();
                }
            }
            let (place, _) = ui.allocate_exact_size(size, Sense::hover());
            // As large as a picture, beside the others.
            open_buttons(ui, place.with_max_y(place.bottom() - CAPTION_HEIGHT), commands);
        });
        if let Some(first) = first {
            focus_by_arrow_key(ui, first);
        }
        pointed
    }

    /// Shows a card of some size: the picture of a scene, its name and its line.
    fn card(&self, ui: &mut egui::Ui, size: Vec2, volume: &str, title: &str) -> Response {
        let line = text::start_screen::scene_line(volume);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Button, true, text::start_screen::card(title, line)));
        if !ui.is_rect_visible(rect) {
            return response;
        }
        let picture = Rect::from_min_size(rect.min, rect.size() - vec2(0.0, CAPTION_HEIGHT));
        match self.live.picture(volume).or_else(|| self.pictures.get(volume)) {
            Some(texture) => {
                let image = egui::Image::new((texture.id(), picture.size())).corner_radius(CORNER_RADIUS);
                image.paint_at(ui, picture);
            }
            None => {
                ui.painter().rect_filled(picture, CORNER_RADIUS, ui.visuals().extreme_bg_color);
            }
        }
        let edge = if response.has_focus() {
            Some(Stroke::new(2.5, theme::ACCENT))
        } else if response.hovered() {
            Some(Stroke::new(1.5, ui.visuals().strong_text_color()))
        } else {
            None
        };
        if let Some(edge) = edge {
            ui.painter().rect_stroke(picture, CORNER_RADIUS, edge, StrokeKind::Inside);
        }
        caption(ui, Rect::from_min_max(picture.left_bottom(), rect.max), title, line);
        response
    }
}

/// Writes the name of a scene and its line into the lower part of a card.
fn caption(ui: &egui::Ui, area: Rect, title: &str, line: &str) {
    let painter = ui.painter().with_clip_rect(area);
    let write = |y: f32, words: &str, style: egui::TextStyle, color: Color32| {
        let font = style.resolve(ui.style());
        painter.text(egui::pos2(area.left() + 1.0, y), Align2::LEFT_TOP, words, font, color).bottom()
    };
    let top = area.top() + 5.0;
    let below = write(top, title, egui::TextStyle::Body, ui.visuals().strong_text_color());
    write(below + 1.0, line, egui::TextStyle::Small, ui.visuals().weak_text_color());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cards_fill_the_width_that_there_is() {
        for room in 100..2000 {
            let room = room as f32;
            let (columns, width) = columns(room);
            assert!((1..=MAX_COLUMNS).contains(&columns), "{room}");
            assert!(columns as f32 * (width + GAP) - GAP <= room, "{room}: {columns} of {width}");
            assert!(columns == 1 || width >= MIN_WIDTH.floor(), "{room}: {width}");
            let is_full = width >= MAX_WIDTH || columns as f32 * (width + 1.0 + GAP) - GAP > room;
            assert!(is_full, "{room}: {columns} of {width}");
        }
    }
}
