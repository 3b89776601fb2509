//! What pictures consist of before they are files.

use crate::model::{Depth, ImageSpec};

/// Under which name a picture carries its record.
pub(super) const RECORD: &str = "chiaroscuro";

/// A number from 0 to 1 in 16 bits.
pub(super) fn word(value: f32) -> u16 {
    (value.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// Rows of a picture, RGBA: display colours with straight alpha, or linear and premultiplied light.
#[derive(Debug, Clone, PartialEq)]
pub enum Rows {
    /// sRGB bytes.
    Bytes(Vec<u8>),
    /// 0 … 1, or light.
    Floats(Vec<f32>),
}

impl Rows {
    /// How many rows of a picture they are.
    pub fn count(&self, shot: &ImageSpec) -> usize {
        let numbers = match self {
            Self::Bytes(shown) => shown.len(),
            Self::Floats(shown) => shown.len(),
        };
        numbers / (shot.size[0] as usize * 4).max(1)
    }

    /// What a file of them gives back.
    #[must_use]
    pub fn as_written(self, shot: &ImageSpec) -> Self {
        match self {
            Self::Bytes(mut shown) => {
                if !shot.transparent {
                    shown.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 255);
                }
                Self::Bytes(shown)
            }
            Self::Floats(mut shown) => {
                if shot.depth == Depth::Linear {
                    for value in &mut shown {
                        *value = half::f16::from_f32(*value).to_f32();
                    }
                } else {
                    for value in &mut shown {
                        *value = f32::from(word(*value)) / 65535.0;
                    }
                    if !shot.transparent {
                        shown.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 1.0);
                    }
                }
                Self::Floats(shown)
            }
        }
    }

    /// All of them where 1 is white.
    pub fn values(&self) -> Vec<f32> {
        match self {
            Self::Bytes(shown) => shown.iter().map(|&byte| f32::from(byte) / 255.0).collect(),
            Self::Floats(shown) => shown.clone(),
        }
    }
}
