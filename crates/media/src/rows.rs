//! Bands of rows, in which pictures are passed to the writers of files.

use chiaroscuro_scene::{ImageSpec, PixelFormat};

/// Key of the embedded record in a picture's metadata.
pub(super) const RECORD_KEY: &str = "chiaroscuro";

/// Quantises a value from 0 to 1 to 16 bits.
pub(super) fn quantize_u16(value: f32) -> u16 {
    (value.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// Rows of a picture as RGBA: display colours with straight alpha, or linear light with premultiplied alpha.
#[derive(Debug, Clone, PartialEq)]
pub enum PixelRows {
    /// sRGB bytes, four per pixel.
    Bytes(Vec<u8>),
    /// Display colours from 0 to 1, or linear light; four per pixel.
    Floats(Vec<f32>),
}

/// Picture that was read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct PicturePixels {
    /// Number of columns and rows.
    pub size: [u32; 2],
    /// All rows, as bytes (8-bit PNG) or floats.
    pub rows: PixelRows,
}

impl PixelRows {
    /// Number of rows of the given picture.
    pub fn count(&self, image_spec: &ImageSpec) -> usize {
        let numbers = match self {
            Self::Bytes(shown) => shown.len(),
            Self::Floats(shown) => shown.len(),
        };
        numbers / (image_spec.size[0] as usize * 4).max(1)
    }

    /// Returns the values that reading a file with these rows gives back.
    #[must_use]
    pub fn after_round_trip(self, image_spec: &ImageSpec) -> Self {
        match self {
            Self::Bytes(mut shown) => {
                if !image_spec.transparent {
                    shown.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 255);
                }
                Self::Bytes(shown)
            }
            Self::Floats(mut shown) => {
                if image_spec.depth == PixelFormat::Linear {
                    for value in &mut shown {
                        *value = half::f16::from_f32(*value).to_f32();
                    }
                } else {
                    for value in &mut shown {
                        *value = f32::from(quantize_u16(*value)) / 65535.0;
                    }
                    if !image_spec.transparent {
                        shown.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 1.0);
                    }
                }
                Self::Floats(shown)
            }
        }
    }

    /// Returns all values, scaled so that 1 is white.
    pub fn values(&self) -> Vec<f32> {
        match self {
            Self::Bytes(shown) => shown.iter().map(|&byte| f32::from(byte) / 255.0).collect(),
            Self::Floats(shown) => shown.clone(),
        }
    }
}
