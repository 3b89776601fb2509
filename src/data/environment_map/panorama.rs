//! Panorama: radiance over all directions, in cells of latitude and longitude, read from a picture.

use std::f64::consts::PI;
use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use glam::DVec3;
use image::{DynamicImage, ImageDecoder as _, ImageReader};

use super::EnvironmentMapError;
use crate::data::load_context::memory_budget_bytes;
use crate::math::linear_from_srgb;

/// Maximum number of columns of cells: the sun covers one and a half.
const MAX_COLUMNS: usize = 1024;

/// Maximum number of pixels of a picture: 8192 × 4096, the largest panoramas in common use.
const MAX_PIXELS: usize = 1 << 25;

/// Maximum plausible radiance; more is an error in the picture: the sun is 2·10⁵ times as bright as the sky around
/// it.
const MAX_RADIANCE: f32 = 1e7;

/// Tolerance of the 2:1 aspect ratio, as a share of the width.
const ASPECT_TOLERANCE: f64 = 0.02;

/// Magic bytes of EXR files.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Radiance over all directions; z is up, and x points to the middle of the picture.
#[derive(Debug, Clone)]
pub(super) struct Panorama {
    /// Width and height of the picture, in pixels.
    size: [usize; 2],
    /// Number of columns and rows of cells.
    cells: [usize; 2],
    /// Sum of the pixels' linear RGB in each cell, and their number.
    sums: Vec<[f64; 4]>,
}

/// Cell of a panorama: a piece of the sphere.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanoramaCell {
    /// Unit vector towards the centre of the cell.
    pub towards: DVec3,
    pub solid_angle: f64,
    /// Mean radiance, linear RGB.
    pub radiance: [f64; 3],
}

impl Panorama {
    /// Creates a black panorama for a picture of the given size in pixels.
    fn new(size: [usize; 2]) -> Self {
        let columns = size[0].clamp(1, MAX_COLUMNS);
        let cells = [columns, size[1].clamp(1, MAX_COLUMNS / 2)];
        Self { size, cells, sums: vec![[0.0; 4]; cells[0] * cells[1]] }
    }

    /// Adds a pixel to its cell.
    fn add(&mut self, column: usize, row: usize, rgb: [f32; 3]) {
        let [columns, rows] = self.cells;
        let x = (column * columns / self.size[0]).min(columns - 1);
        let y = (row * rows / self.size[1]).min(rows - 1);
        let sum = &mut self.sums[x + columns * y];
        for (sum, value) in sum.iter_mut().zip(rgb) {
            // NaN and negative values count as black.
            *sum += f64::from(if value > 0.0 { value.min(MAX_RADIANCE) } else { 0.0 });
        }
        sum[3] += 1.0;
    }

    /// Iterates over all cells, row by row from the top.
    pub(super) fn cells(&self) -> impl Iterator<Item = PanoramaCell> + '_ {
        (0..self.sums.len()).map(|at| self.cell(at))
    }

    /// Returns the cell at an index.
    pub(super) fn cell(&self, at: usize) -> PanoramaCell {
        let [columns, rows] = self.cells;
        let (column, row) = (at % columns, at / columns);
        // Moving right from the middle is clockwise, seen from above.
        let azimuth = 2.0 * PI * (0.5 - (column as f64 + 0.5) / columns as f64);
        let latitude = |row: f64| PI * (0.5 - row / rows as f64);
        let (above, middle, below) = (row as f64, row as f64 + 0.5, row as f64 + 1.0);
        let (sin, cos) = latitude(middle).sin_cos();
        let [r, g, b, count] = self.sums[at];
        PanoramaCell {
            towards: DVec3::new(azimuth.cos() * cos, azimuth.sin() * cos, sin),
            solid_angle: 2.0 * PI / columns as f64 * (latitude(above).sin() - latitude(below).sin()),
            radiance: [r, g, b].map(|sum| sum / count.max(1.0)),
        }
    }

    /// Returns the indices of the neighbouring cells; columns wrap around from the left border to the right.
    pub(super) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.cells;
        let (column, row) = (at % columns, at / columns);
        let above = (row > 0).then(|| at - columns);
        let below = (row + 1 < rows).then(|| at + columns);
        let first = columns * row;
        let sides = [first + (column + columns - 1) % columns, first + (column + 1) % columns];
        sides.into_iter().chain(above).chain(below)
    }

    /// Overwrites the radiance of a cell.
    pub(super) fn set(&mut self, at: usize, [r, g, b]: [f64; 3]) {
        self.sums[at] = [r, g, b, 1.0];
    }

    /// Creates a panorama from a function of the direction.
    #[cfg(test)]
    pub(super) fn from_fn(size: [usize; 2], radiance: impl Fn(DVec3) -> [f64; 3]) -> Self {
        let mut panorama = Self::new(size);
        for at in 0..panorama.sums.len() {
            let towards = panorama.cell(at).towards;
            panorama.set(at, radiance(towards));
        }
        panorama
    }
}

/// Reads a panorama; the format is detected by its content.
pub(super) fn read_panorama(path: &Path) -> Result<Panorama, EnvironmentMapError> {
    let io = |source| EnvironmentMapError::Io { path: path.to_owned(), source };
    if !std::fs::metadata(path).map_err(io)?.is_file() {
        return Err(io(std::io::Error::other("not a regular file")));
    }
    let mut start = Vec::new();
    File::open(path).map_err(io)?.take(4).read_to_end(&mut start).map_err(io)?;
    if start == EXR_MAGIC { read_exr(path) } else { read_image(path) }
}

/// Rejects pictures of a wrong aspect ratio, and those that are too large.
fn check_size(path: &Path, [width, height]: [usize; 2]) -> Result<[usize; 2], EnvironmentMapError> {
    let path = path.to_owned();
    let is_wide = (width as f64 - 2.0 * height as f64).abs() <= ASPECT_TOLERANCE * width as f64;
    if !is_wide || height == 0 {
        return Err(EnvironmentMapError::Shape { path, width, height });
    }
    // A software driver and the picture share the memory: three floats for each pixel.
    let most = MAX_PIXELS.min((memory_budget_bytes() / 12) as usize);
    if width.saturating_mul(height) > most {
        return Err(EnvironmentMapError::TooLarge { path, width, height, max_pixels: most });
    }
    Ok([width, height])
}

fn read_image(path: &Path) -> Result<Panorama, EnvironmentMapError> {
    let io = |source| EnvironmentMapError::Io { path: path.to_owned(), source };
    let broken =
        |why: image::ImageError| EnvironmentMapError::Broken { path: path.to_owned(), why: why.to_string() };
    let reader = ImageReader::open(path).map_err(io)?.with_guessed_format().map_err(io)?;
    let decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    let size = check_size(path, [width as usize, height as usize])?;
    let picture = DynamicImage::from_decoder(decoder).map_err(broken)?;
    let mut panorama = Panorama::new(size);
    // Integer pictures are encoded in sRGB, floating-point ones are linear.
    match picture {
        DynamicImage::ImageRgb32F(pixels) => {
            for (x, y, pixel) in pixels.enumerate_pixels() {
                panorama.add(x as usize, y as usize, pixel.0);
            }
        }
        DynamicImage::ImageRgb16(pixels) => {
            for (x, y, pixel) in pixels.enumerate_pixels() {
                panorama.add(
                    x as usize,
                    y as usize,
                    pixel.0.map(|c| linear_from_srgb(f64::from(c) / 65535.0) as f32),
                );
            }
        }
        other => {
            let linear: Vec<f32> = (0..=255).map(|c| linear_from_srgb(f64::from(c) / 255.0) as f32).collect();
            for (x, y, pixel) in other.to_rgb8().enumerate_pixels() {
                panorama.add(x as usize, y as usize, pixel.0.map(|c| linear[usize::from(c)]));
            }
        }
    }
    Ok(panorama)
}

fn read_exr(path: &Path) -> Result<Panorama, EnvironmentMapError> {
    let broken =
        |why: exr::error::Error| EnvironmentMapError::Broken { path: path.to_owned(), why: why.to_string() };
    let file =
        File::open(path).map_err(|source| EnvironmentMapError::Io { path: path.to_owned(), source })?;
    let meta = exr::meta::MetaData::read_from_buffered(BufReader::new(file), false).map_err(broken)?;
    for header in &meta.headers {
        let exr::math::Vec2(width, height) = header.layer_size;
        check_size(path, [width, height])?;
    }
    let picture = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |exr::math::Vec2(width, height), _| Panorama::new([width, height]),
        |panorama: &mut Panorama, exr::math::Vec2(x, y), (r, g, b, _): (f32, f32, f32, f32)| {
            panorama.add(x, y, [r, g, b]);
        },
    );
    Ok(picture.map_err(broken)?.layer_data.channel_data.pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a small panorama that is brighter to the right.
    fn pixels() -> image::Rgb32FImage {
        image::Rgb32FImage::from_fn(16, 8, |x, _| image::Rgb([x as f32 / 15.0, 0.25, 0.5]))
    }

    #[test]
    fn pictures_of_all_kinds_are_the_same_light() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        pixels().save(path("a.hdr")).unwrap();
        let srgb = |linear: f32| crate::math::srgb_from_linear(f64::from(linear));
        let bytes = image::RgbImage::from_fn(16, 8, |x, y| {
            image::Rgb(pixels().get_pixel(x, y).0.map(|c| (255.0 * srgb(c)).round() as u8))
        });
        bytes.save(path("a.png")).unwrap();
        let words: image::ImageBuffer<image::Rgb<u16>, Vec<u16>> =
            image::ImageBuffer::from_fn(16, 8, |x, y| {
                image::Rgb(pixels().get_pixel(x, y).0.map(|c| (65535.0 * srgb(c)).round() as u16))
            });
        words.save(path("b.png")).unwrap();
        let all = pixels();
        exr::prelude::write_rgb_file(path("a.exr"), 16, 8, |x, y| {
            let [r, g, b] = all.get_pixel(x as u32, y as u32).0;
            (r, g, b)
        })
        .unwrap();
        for name in ["a.hdr", "a.png", "b.png", "a.exr"] {
            let panorama = read_panorama(&path(name)).unwrap_or_else(|err| panic!("{name}: {err}"));
            assert_eq!(panorama.size, [16, 8]);
            for (at, cell) in panorama.cells().enumerate() {
                let expected = [(at % 16) as f64 / 15.0, 0.25, 0.5];
                for (found, expected) in cell.radiance.iter().zip(expected) {
                    assert!((found - expected).abs() < 0.006, "{name}: {cell:?}, not {expected}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_panorama_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("square.png");
        image::RgbImage::new(8, 8).save(&path).unwrap();
        let says = |path: &Path| read_panorama(path).unwrap_err().to_string();
        assert!(says(&path).contains("square.png: 8 × 8 pixels; expected"), "{}", says(&path));
        let other = folder.path().join("other.hdr");
        std::fs::write(&other, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 199999998\n").unwrap();
        assert!(says(&other).contains("other.hdr"), "{}", says(&other));
        std::fs::write(&other, b"\x76\x2f\x31\x01\x02\0\0\0").unwrap();
        assert!(says(&other).contains("not a readable picture"), "{}", says(&other));
        std::fs::write(&other, b"text").unwrap();
        assert!(says(&other).contains("other.hdr"), "{}", says(&other));
        assert!(says(folder.path()).contains("regular file"));
        assert!(says(&folder.path().join("none")).contains("none"));
    }

    /// Tests that damaged files are rejected, or decoded partially, without a panic.
    #[test]
    fn damaged_pictures_never_panic() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        pixels().save(path("a.hdr")).unwrap();
        image::DynamicImage::from(pixels()).to_rgb8().save(path("a.png")).unwrap();
        image::DynamicImage::from(pixels()).to_rgb8().save(path("a.jpg")).unwrap();
        exr::prelude::write_rgb_file(path("a.exr"), 16, 8, |x, y| (x as f32, y as f32, 0.5f32)).unwrap();
        let mut random = 1u64;
        let mut next = |below: usize| {
            // Knuth's MMIX constants of a linear congruential generator; any deterministic sequence will do.
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) as usize % below
        };
        for name in ["a.hdr", "a.png", "a.jpg", "a.exr"] {
            let whole = std::fs::read(path(name)).unwrap();
            let mut refused = 0;
            for turn in 0..200 {
                let mut bytes = whole.clone();
                match turn % 3 {
                    0 => bytes.truncate(next(whole.len())),
                    _ => (0..=next(4)).for_each(|_| bytes[next(whole.len())] = next(256) as u8),
                }
                std::fs::write(path("damaged"), bytes).unwrap();
                refused += usize::from(read_panorama(&path("damaged")).is_err());
            }
            assert!(refused > 20, "{name}: {refused}");
        }
    }

    #[test]
    fn cells_cover_the_sphere_once() {
        let panorama = Panorama::new([64, 32]);
        let all: f64 = panorama.cells().map(|cell| cell.solid_angle).sum();
        assert!((all - 4.0 * PI).abs() < 1e-9);
        let middle = panorama.cell(64 * 16 + 32).towards;
        assert!(middle.dot(DVec3::X) > 0.99, "{middle}");
        assert!(panorama.cell(0).towards.z > 0.99);
        // A quarter turn to the right of the middle.
        assert!(panorama.cell(64 * 16 + 48).towards.dot(DVec3::NEG_Y) > 0.99);
        assert!(panorama.neighbours(64 * 3).any(|next| next == 64 * 3 + 63));
    }

    #[test]
    fn what_is_no_number_is_black() {
        let mut panorama = Panorama::new([4, 2]);
        panorama.add(0, 0, [f32::NAN, -3.0, f32::INFINITY]);
        assert_eq!(panorama.cell(0).radiance, [0.0, 0.0, f64::from(MAX_RADIANCE)]);
    }
}
