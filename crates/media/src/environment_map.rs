//! Reading of environment maps: Radiance HDR, EXR, PNG and JPEG in equirectangular projection.

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use image::{DynamicImage, ImageDecoder as _, ImageReader};

use crate::environment_map_error::EnvironmentMapError;
use chiaroscuro_scene::{EnvironmentMap, Panorama};
use chiaroscuro_volume::{math::linear_from_srgb, memory_budget_bytes};

/// Maximum number of pixels of a picture: 8192 × 4096, the largest panoramas in common use.
const MAX_PIXELS: usize = 1 << 25;

/// Tolerance of the 2:1 aspect ratio, as a share of the width.
const ASPECT_TOLERANCE: f64 = 0.02;

/// Magic bytes of EXR files.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads an environment map: Radiance HDR, EXR, PNG or JPEG, twice as wide as high.
///
/// # Errors
/// Fails if the file cannot be read or decoded, has another aspect ratio, is too large, or is black.
pub fn read_environment_map(path: &Path) -> Result<EnvironmentMap, EnvironmentMapError> {
    let panorama = read_panorama(path)?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    EnvironmentMap::from_panorama(name, panorama)
        .ok_or_else(|| EnvironmentMapError::Black { path: path.to_owned() })
}

/// Reads a panorama; the format is detected by its content.
fn read_panorama(path: &Path) -> Result<Panorama, EnvironmentMapError> {
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
        let srgb = |linear: f32| chiaroscuro_volume::math::srgb_from_linear(f64::from(linear));
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
            assert_eq!(panorama.cells().count(), 16 * 8);
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
}
