//! Preview of an export's marks over the window's picture, which has the exported aspect ratio meanwhile.

use eframe::egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};

use crate::data::Volume;
use crate::export::{Rows, marks_of_size};
use crate::model::{ImageSpec, Settings};

/// Longest edge of the marks' texture, in pixels: the width of a wide screen.
const LONGEST_EDGE: f32 = 2048.0;

/// Cache key of the drawn marks: everything that they depend on.
#[derive(Debug, Clone, PartialEq)]
struct Drawn {
    shot: ImageSpec,
    size: [u32; 2],
    settings: Settings,
    volume: u64,
}

/// Preview of an export's marks, with the texture that was drawn last.
#[derive(Default)]
pub(crate) struct ExportMarks {
    drawn: Option<(Drawn, TextureHandle)>,
}

impl ExportMarks {
    /// Shows the marks of an exported picture over the window's picture, which has the same aspect ratio.
    pub(in crate::app) fn show(
        &mut self,
        ui: &Ui,
        picture: Rect,
        shot: &ImageSpec,
        settings: &Settings,
        volume: &Volume,
    ) {
        if shot.marks.is_none() || shot.size.contains(&0) {
            self.drawn = None;
            return;
        }
        let pixels = picture.size() * ui.pixels_per_point();
        let pixels = pixels * (LONGEST_EDGE / pixels.max_elem()).min(1.0);
        let size = [pixels.x, pixels.y].map(|edge| (edge.round() as u32).max(1));
        let wanted = Drawn { shot: *shot, size, settings: settings.clone(), volume: volume.opened_id() };
        if self.drawn.as_ref().is_none_or(|(drawn, _)| *drawn != wanted) {
            let image = draw(&wanted, volume);
            let texture = match self.drawn.take() {
                Some((_, mut texture)) => {
                    texture.set(image, TextureOptions::LINEAR);
                    texture
                }
                None => ui.ctx().load_texture("export marks", image, TextureOptions::LINEAR),
            };
            self.drawn = Some((wanted, texture));
        }
        if let Some((_, texture)) = &self.drawn {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter_at(picture).image(texture.id(), picture, whole, Color32::WHITE);
        }
    }
}

/// Draws the marks on a transparent image.
fn draw(wanted: &Drawn, volume: &Volume) -> ColorImage {
    let Drawn { shot, size, settings, volume: _ } = wanted;
    let [width, height] = size.map(|edge| edge as usize);
    let mut rows = Rows::Bytes(vec![0; width * height * 4]);
    let layer = marks_of_size(shot, *size, settings, volume);
    layer.lay_over(&ImageSpec { size: *size, ..*shot }, 0, &mut rows);
    match rows {
        Rows::Bytes(shown) => ColorImage::from_rgba_unmultiplied([width, height], &shown),
        Rows::Floats(_) => ColorImage::filled([width, height], Color32::TRANSPARENT),
    }
}
