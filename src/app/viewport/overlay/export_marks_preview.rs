//! Preview of an export's marks over the window's picture, which has the exported aspect ratio meanwhile.

use eframe::egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};

use chiaroscuro_media::{PixelRows, marks_layer_of_size};
use chiaroscuro_scene::{ImageSpec, Settings};
use chiaroscuro_volume::Volume;

/// Longest edge of the marks' texture, in pixels: the width of a wide screen.
const LONGEST_EDGE: f32 = 2048.0;

/// Cache key of the drawn marks: everything that they depend on.
#[derive(Debug, Clone, PartialEq)]
struct ExportMarksKey {
    image: ImageSpec,
    size: [u32; 2],
    settings: Settings,
    volume: u64,
}

/// Preview of an export's marks, with the texture that was drawn last.
#[derive(Default)]
pub(crate) struct ExportMarksPreview {
    cached: Option<(ExportMarksKey, TextureHandle)>,
}

impl ExportMarksPreview {
    /// Shows the marks of an exported picture over the window's picture, which has the same aspect ratio.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        picture: Rect,
        image_spec: &ImageSpec,
        settings: &Settings,
        volume: &Volume,
    ) {
        if image_spec.marks.is_none() || image_spec.size.contains(&0) {
            self.cached = None;
            return;
        }
        let pixels = picture.size() * ui.pixels_per_point();
        let pixels = pixels * (LONGEST_EDGE / pixels.max_elem()).min(1.0);
        let size = [pixels.x, pixels.y].map(|edge| (edge.round() as u32).max(1));
        let wanted = ExportMarksKey {
            image: *image_spec,
            size,
            settings: settings.clone(),
            volume: volume.opened_id(),
        };
        if self.cached.as_ref().is_none_or(|(drawn, _)| *drawn != wanted) {
            let image = render_marks(&wanted, volume);
            let texture = match self.cached.take() {
                Some((_, mut texture)) => {
                    texture.set(image, TextureOptions::LINEAR);
                    texture
                }
                None => ui.ctx().load_texture("export marks", image, TextureOptions::LINEAR),
            };
            self.cached = Some((wanted, texture));
        }
        if let Some((_, texture)) = &self.cached {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter_at(picture).image(texture.id(), picture, whole, Color32::WHITE);
        }
    }
}

/// Draws the marks on a transparent image.
fn render_marks(wanted: &ExportMarksKey, volume: &Volume) -> ColorImage {
    let ExportMarksKey { image: image_spec, size, settings, volume: _ } = wanted;
    let [width, height] = size.map(|edge| edge as usize);
    let mut rows = PixelRows::Bytes(vec![0; width * height * 4]);
    let layer = marks_layer_of_size(image_spec, *size, settings, volume);
    layer.composite_over(&ImageSpec { size: *size, ..*image_spec }, 0, &mut rows);
    match rows {
        PixelRows::Bytes(shown) => ColorImage::from_rgba_unmultiplied([width, height], &shown),
        PixelRows::Floats(_) => ColorImage::filled([width, height], Color32::TRANSPARENT),
    }
}
