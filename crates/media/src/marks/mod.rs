//! Marks over an exported picture that make it self-explanatory: a scale bar, orientation letters, and a legend.

mod layer;
mod legend;
mod orientation_letters;
mod scale_bar;

pub use self::layer::MarksLayer;
pub use self::orientation_letters::{SCENE_SIDES, orientation_letters, orientation_letters_of_plane};
pub use self::scale_bar::{ScaleBar, scale_bar};
use chiaroscuro_scene::{ImageSpec, Settings};
use chiaroscuro_volume::Volume;

/// Height of letters relative to a picture's shorter edge: as in journal figures, which are printed at a third of a
/// page.
const LETTER_HEIGHT: f64 = 1.0 / 32.0;

/// Smallest legible height of letters, in pixels.
const MIN_LETTER_HEIGHT: f64 = 11.0;

/// Returns the height of letters for a picture, in pixels.
fn letter_height([width, height]: [u32; 2]) -> f64 {
    (f64::from(width.min(height)) * LETTER_HEIGHT).max(MIN_LETTER_HEIGHT)
}

/// Returns the layer of marks for a picture of a volume.
pub fn marks_layer(image_spec: &ImageSpec, settings: &Settings, volume: &Volume) -> MarksLayer {
    marks_layer_of_size(image_spec, image_spec.size, settings, volume)
}

/// Returns the layer of marks for a copy of a picture at another resolution, with the same appearance.
pub fn marks_layer_of_size(
    image_spec: &ImageSpec,
    size: [u32; 2],
    settings: &Settings,
    volume: &Volume,
) -> MarksLayer {
    let mut layer = MarksLayer::default();
    let scale = f64::from(size[1]) / f64::from(image_spec.size[1].max(1));
    let letters = letter_height(image_spec.size) * scale;
    let size = size.map(f64::from);
    if image_spec.marks.scale_bar {
        let [width, height] = size;
        let mm_per_pixel = settings.camera.pixel_at_target(width, height) * volume.scene().mm_per_unit;
        if let Some(bar) = scale_bar(mm_per_pixel * width, volume.has_unknown_scale()) {
            bar.draw(&mut layer, bar.length_mm / mm_per_pixel, [width, height], letters);
        }
    }
    if image_spec.marks.letters && volume.is_anatomical() {
        orientation_letters::draw(&mut layer, &settings.camera, size, letters);
    }
    if image_spec.marks.legend {
        legend::draw(&mut layer, settings, volume, size, letters);
    }
    layer
}

/// Contact sheet: pictures in a grid, each with its name below; see [`ContactSheetImage::add`].
#[derive(Debug)]
pub struct ContactSheetImage {
    tile: [u32; 2],
    columns: u32,
    size: [u32; 2],
    margin: u32,
    letters: f64,
    pixels: Vec<u8>,
    layer: MarksLayer,
    count: u32,
}

impl ContactSheetImage {
    /// Creates a sheet for `count` pictures of equal size, in a grid that is as square as possible.
    pub fn new(count: u32, tile: [u32; 2]) -> Self {
        let columns = f64::from(count.max(1)).sqrt().ceil() as u32;
        let rows = count.max(1).div_ceil(columns);
        let letters = f64::from(tile[1]) / 16.0;
        let margin = tile[0] / 32;
        let below = (letters * 1.6) as u32;
        let size = [columns * (tile[0] + margin) + margin, rows * (tile[1] + margin + below) + margin];
        // Background colour behind the window's pictures.
        let shown = [0x14, 0x16, 0x1a, 0xff].repeat((size[0] * size[1]) as usize);
        Self { tile, columns, size, margin, letters, pixels: shown, layer: MarksLayer::default(), count: 0 }
    }

    /// Adds a picture of sRGB bytes, with its name.
    pub fn add(&mut self, name: &str, picture: &[u8]) {
        let [width, height] = self.tile;
        let (column, row) = (self.count % self.columns, self.count / self.columns);
        self.count += 1;
        let below = (self.letters * 1.6) as u32;
        let left = self.margin + column * (width + self.margin);
        let top = self.margin + row * (height + self.margin + below);
        for (y, pixels) in picture.chunks_exact(width as usize * 4).take(height as usize).enumerate() {
            let at = ((top as usize + y) * self.size[0] as usize + left as usize) * 4;
            if let Some(place) = self.pixels.get_mut(at..at + pixels.len()) {
                place.copy_from_slice(pixels);
            }
        }
        let middle = [f64::from(left) + f64::from(width) / 2.0, f64::from(top + height) + 0.2 * self.letters];
        let most = f64::from(width);
        let mut name = name.to_owned();
        while MarksLayer::width(&name, self.letters) > most && name.pop().is_some() {}
        self.layer.write(&name, middle, [0.5, 0.0], self.letters);
    }

    /// Returns the number of columns and rows of the sheet, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the RGBA bytes of the finished sheet.
    pub fn finish(self) -> Vec<u8> {
        let mut rows = crate::PixelRows::Bytes(self.pixels);
        self.layer.composite_over(&ImageSpec::new(self.size), 0, &mut rows);
        match rows {
            crate::PixelRows::Bytes(shown) => shown,
            crate::PixelRows::Floats(_) => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelRows;
    use chiaroscuro_scene::{Annotations, first_look::first_settings};
    use chiaroscuro_volume::{Histogram, synthetic::builtin};

    /// Returns the bounding box of the pixels that the marks cover: left, top, right, bottom.
    fn written(marks: Annotations) -> Option<[usize; 4]> {
        let volume = builtin("chair", Some(16)).unwrap();
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let image_spec = ImageSpec { marks, ..ImageSpec::new([400, 300]) };
        let mut rows = PixelRows::Bytes(vec![0; 400 * 300 * 4]);
        super::marks_layer(&image_spec, &settings, &volume).composite_over(&image_spec, 0, &mut rows);
        let PixelRows::Bytes(shown) = rows else { unreachable!() };
        let inked = shown.chunks(4).enumerate().filter(|(_, pixel)| pixel[3] > 0);
        let places: Vec<_> = inked.map(|(at, _)| (at % 400, at / 400)).collect();
        let (xs, ys) = (places.iter().map(|p| p.0), places.iter().map(|p| p.1));
        Some([xs.clone().min()?, ys.clone().min()?, xs.max()?, ys.max()?])
    }

    #[test]
    fn marks_are_where_they_are_looked_for() {
        assert_eq!(written(Annotations::default()), None);
        let [left, top, right, bottom] =
            written(Annotations { scale_bar: true, ..Annotations::default() }).unwrap();
        assert!(left < 20 && right < 200 && top > 240 && bottom < 300, "{left} {top} {right} {bottom}");
        let [left, top, right, bottom] =
            written(Annotations { legend: true, ..Annotations::default() }).unwrap();
        assert!(left > 250 && right < 400 && top > 40 && bottom < 290, "{left} {top} {right} {bottom}");
        // A built-in chair has no anatomical orientation.
        assert_eq!(written(Annotations { letters: true, ..Annotations::default() }), None);
    }

    #[test]
    fn marks_over_a_smaller_copy_lie_where_they_do_over_the_picture() {
        let volume = builtin("chair", Some(16)).unwrap();
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let marks = Annotations { scale_bar: true, legend: true, ..Annotations::default() };
        let image_spec = ImageSpec { marks, ..ImageSpec::new([1600, 1200]) };
        // Bounding box of the marks, relative to the picture's size.
        let written = |size: [u32; 2]| {
            let mut rows = PixelRows::Bytes(vec![0; (size[0] * size[1] * 4) as usize]);
            let layer = super::marks_layer_of_size(&image_spec, size, &settings, &volume);
            layer.composite_over(&ImageSpec { size, ..image_spec }, 0, &mut rows);
            let PixelRows::Bytes(shown) = rows else { unreachable!() };
            let [width, height] = size.map(f64::from);
            let inked = shown.chunks(4).enumerate().filter(|(_, pixel)| pixel[3] > 0);
            let places = inked.map(|(at, _)| {
                [f64::from(at as u32 % size[0]) / width, f64::from(at as u32 / size[0]) / height]
            });
            places.fold([1.0, 1.0, 0.0, 0.0], |all: [f64; 4], [x, y]| {
                [all[0].min(x), all[1].min(y), all[2].max(x), all[3].max(y)]
            })
        };
        let (whole, copy) = (written([1600, 1200]), written([400, 300]));
        for (whole, copy) in whole.into_iter().zip(copy) {
            assert!((whole - copy).abs() < 0.02, "{whole} {copy}");
        }
    }

    #[test]
    fn sheets_have_a_place_for_every_picture() {
        let mut sheet = ContactSheetImage::new(3, [64, 48]);
        for ink in [10, 100, 200] {
            sheet.add("name", &[ink; 64 * 48 * 4]);
        }
        let [width, height] = sheet.size();
        let shown = sheet.finish();
        assert_eq!(shown.len(), (width * height * 4) as usize);
        for ink in [10, 100, 200] {
            let count = shown.chunks(4).filter(|pixel| **pixel == [ink; 4]).count();
            assert!(count >= 64 * 48, "{count} of {ink}");
        }
    }
}
