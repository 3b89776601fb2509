//! Specification of a rendered image: size, supersampling, bit depth and annotations; not part of the look.

use serde::{Deserialize, Serialize};

/// Largest edge of an image, in pixels.
pub const MAX_IMAGE_EDGE: u32 = 32768;

/// Largest number of samples of a pixel along an edge: 4 × 4 = 16 in all, beyond which no difference is visible.
pub const MAX_SAMPLES_PER_EDGE: u32 = 4;

/// Number format and encoding of an image's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PixelFormat {
    /// Display colours in 8 bits.
    #[default]
    Eight,
    /// Display colours in 16 bits.
    Sixteen,
    /// Light before tone mapping, linear and premultiplied, in 16-bit floats.
    Linear,
}

/// Annotations drawn over an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Annotations {
    /// Draws a scale bar with a length.
    pub scale_bar: bool,
    /// Draws the letters of anatomical directions (left, right, …).
    pub letters: bool,
    /// Draws a legend that maps colours to values.
    pub legend: bool,
}

impl Annotations {
    /// Returns true if no annotation is enabled.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Size, supersampling, bit depth and annotations of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageSpec {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Leaves the background out, so that it is transparent.
    pub transparent: bool,
    /// Samples of each pixel along an edge, 1 … [`MAX_SAMPLES_PER_EDGE`].
    #[serde(default = "default_samples")]
    pub samples: u32,
    /// Number format and encoding of the pixels.
    #[serde(default)]
    pub depth: PixelFormat,
    /// Annotations drawn over the image.
    #[serde(default, skip_serializing_if = "Annotations::is_none")]
    pub marks: Annotations,
}

fn default_samples() -> u32 {
    1
}

impl ImageSpec {
    /// Specification of an opaque 8-bit image with one sample per pixel.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            transparent: false,
            samples: 1,
            depth: PixelFormat::Eight,
            marks: Annotations::default(),
        }
    }

    /// Returns the specification clamped to the supported limits; a file may ask for any numbers.
    #[must_use]
    pub fn clamped(self) -> Self {
        Self {
            size: self.size.map(|edge| edge.clamp(1, MAX_IMAGE_EDGE)),
            samples: self.samples.clamp(1, MAX_SAMPLES_PER_EDGE),
            ..self
        }
    }
}
