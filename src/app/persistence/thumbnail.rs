//! Thumbnails of looks as small PNG files.

use std::path::Path;

use eframe::egui::{Color32, ColorImage};
use image::{RgbImage, imageops};

use chiaroscuro_files::write_atomically;
use chiaroscuro_media::encode_png;

/// Longer edge of a thumbnail in pixels: 1.5 times the size in the list, for high-resolution screens.
const EDGE: u32 = 192;

/// Writes a picture as a thumbnail; an empty picture writes nothing.
pub(super) fn write(picture: &ColorImage, path: &Path) -> Result<(), String> {
    let Some(small) = shrink(picture) else { return Ok(()) };
    let (width, height) = small.dimensions();
    let png =
        encode_png([width, height], png::ColorType::Rgb, &small, None).map_err(|err| err.to_string())?;
    write_atomically(path, &png).map_err(|err| err.to_string())
}

/// Shrinks a picture to a thumbnail; `None` if it is empty.
fn shrink(picture: &ColorImage) -> Option<RgbImage> {
    let [width, height] = picture.size.map(|edge| u32::try_from(edge).unwrap_or(u32::MAX));
    let bytes = picture.pixels.iter().flat_map(|color| [color.r(), color.g(), color.b()]).collect();
    let whole = RgbImage::from_raw(width, height, bytes).filter(|_| width > 0 && height > 0)?;
    let longest = width.max(height).max(EDGE);
    let [width, height] =
        [width, height].map(|edge| (u64::from(edge) * u64::from(EDGE) / u64::from(longest)).max(1) as u32);
    Some(imageops::thumbnail(&whole, width, height))
}

/// Reads a thumbnail; `None` if the file is missing, invalid or larger than this program writes.
pub(super) fn read(path: &Path) -> Option<ColorImage> {
    let bytes = chiaroscuro_files::read_small_file(path).ok()?;
    let mut reader = image::ImageReader::with_format(std::io::Cursor::new(bytes), image::ImageFormat::Png);
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(EDGE), Some(EDGE));
    reader.limits(limits);
    let small = reader.decode().ok()?.into_rgb8();
    let (width, height) = small.dimensions();
    let pixels = small.pixels().map(|pixel| Color32::from_rgb(pixel[0], pixel[1], pixel[2])).collect();
    Some(ColorImage::new([width as usize, height as usize], pixels))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_become_small_and_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let half = |at: usize| if at % 800 < 400 { Color32::RED } else { Color32::BLUE };
        write(&ColorImage::new([800, 400], (0..800 * 400).map(half).collect()), &path).unwrap();
        let small = read(&path).unwrap();
        assert_eq!(small.size, [192, 96]);
        assert_eq!((small.pixels[0], small.pixels[191]), (Color32::RED, Color32::BLUE));
        write(&ColorImage::filled([3, 1], Color32::GREEN), &path).unwrap();
        assert_eq!(read(&path).unwrap().size, [3, 1], "never larger");
        write(&ColorImage::filled([0, 0], Color32::RED), &path).unwrap();
        assert_eq!(read(&path).unwrap().size, [3, 1], "as it was");
        std::fs::write(&path, "no picture").unwrap();
        assert!(read(&path).is_none());
        let large = encode_png([193, 1], png::ColorType::Rgb, &[0; 193 * 3], None).unwrap();
        std::fs::write(&path, large).unwrap();
        assert!(read(&path).is_none(), "not what we write");
    }
}
