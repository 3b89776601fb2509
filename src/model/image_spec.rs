//! How a picture is taken, which is no part of the look.

use serde::{Deserialize, Serialize};

/// Largest edge of a picture, in pixels.
pub const MAX_EDGE: u32 = 32768;

/// Most samples of a pixel along an edge: sixteen in all, beyond which no eye sees a difference.
pub const MAX_SAMPLES: u32 = 4;

/// What the numbers of a picture are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Depth {
    /// Display colours in 8 bits.
    #[default]
    Eight,
    /// Display colours in 16 bits.
    Sixteen,
    /// Light before tone mapping, linear and premultiplied, in 16-bit floats.
    Linear,
}

/// What is written over a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Marks {
    /// How long things are.
    pub scale_bar: bool,
    /// Which side of a body is where.
    pub letters: bool,
    /// Which colour stands for which value.
    pub legend: bool,
}

impl Marks {
    /// Whether there are none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Size and fineness of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageSpec {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Whether the background is left out.
    pub transparent: bool,
    /// Samples of each pixel along an edge, 1 … [`MAX_SAMPLES`].
    #[serde(default = "one")]
    pub samples: u32,
    /// What its numbers are.
    #[serde(default)]
    pub depth: Depth,
    /// What is written over it.
    #[serde(default, skip_serializing_if = "Marks::is_none")]
    pub marks: Marks,
}

fn one() -> u32 {
    1
}

impl ImageSpec {
    /// An opaque picture of 8 bits and a sample per pixel.
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, transparent: false, samples: 1, depth: Depth::Eight, marks: Marks::default() }
    }

    /// The nearest one that can be taken: what a file asks for may be anything.
    #[must_use]
    pub fn within_limits(self) -> Self {
        Self {
            size: self.size.map(|edge| edge.clamp(1, MAX_EDGE)),
            samples: self.samples.clamp(1, MAX_SAMPLES),
            ..self
        }
    }
}
