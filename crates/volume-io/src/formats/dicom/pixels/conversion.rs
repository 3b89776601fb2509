//! Conversion of stored pixels to voxels.

use super::layout::{PhotometricKind, PixelLayout, PixelNumber};
use crate::Endian;
use crate::reading::number::ScalarReduction;

/// Number type that voxels can have.
pub(crate) trait VoxelNumber: Copy + Default + Send + Sync {
    /// Value of unmeasured voxels: NaN, or 0 for integer types.
    const UNMEASURED: Self;
    fn value(self) -> f64;
    /// Converts a mean of values of this type, rounding to integers if needed.
    fn from_mean(mean: f64) -> Self;
    fn from_integer(value: i64) -> Self;
    fn from_float(value: f64) -> Self;
}

macro_rules! voxel {
    ($($type:ty: $unmeasured:expr, $round:expr;)*) => { $(
        impl VoxelNumber for $type {
            const UNMEASURED: Self = $unmeasured;

            fn value(self) -> f64 {
                self as f64
            }

            fn from_mean(mean: f64) -> Self {
                ($round)(mean) as Self
            }

            // The type was chosen so that every stored value fits.
            fn from_integer(value: i64) -> Self {
                value as Self
            }

            fn from_float(value: f64) -> Self {
                value as Self
            }
        }
    )* };
}
voxel! {
    u8: 0, f64::round;
    i8: 0, f64::round;
    u16: 0, f64::round;
    i16: 0, f64::round;
    u32: 0, f64::round;
    i32: 0, f64::round;
    f32: f32::NAN, std::convert::identity;
}

impl VoxelNumber for f64 {
    const UNMEASURED: Self = Self::NAN;

    fn value(self) -> f64 {
        self
    }

    fn from_mean(mean: f64) -> Self {
        mean
    }

    fn from_integer(value: i64) -> Self {
        value as Self
    }

    fn from_float(value: f64) -> Self {
        value
    }
}

/// Conversion of pixels to voxels: layout, byte order, part of colours, scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PixelConversion {
    pub(crate) shape: PixelLayout,
    pub(crate) endian: Endian,
    /// Scalar that is derived from a colour.
    pub(crate) part: ScalarReduction,
    /// Slope and intercept, if each image has its own.
    pub(crate) scale: Option<[f64; 2]>,
}

impl PixelConversion {
    /// Converts as many pixels as there are voxels; `bytes` holds exactly those.
    pub(crate) fn write<T: VoxelNumber>(&self, bytes: &[u8], voxels: &mut [T]) {
        if self.shape.samples > 1 {
            return self.write_colors(bytes, voxels);
        }
        match self.shape.number {
            PixelNumber::Bit => self.write_integers(bytes.iter().map(|&bit| i64::from(bit)), voxels),
            PixelNumber::Integer(bits) => match bits.allocated {
                8 => self.write_integers(bytes.iter().map(|&byte| bits.extract(u32::from(byte))), voxels),
                16 => self.write_integers(
                    bytes
                        .as_chunks()
                        .0
                        .iter()
                        .map(|&raw| bits.extract(u32::from(u16_from_bytes(raw, self.endian)))),
                    voxels,
                ),
                _ => self.write_integers(
                    bytes.as_chunks().0.iter().map(|&raw| bits.extract(u32_from_bytes(raw, self.endian))),
                    voxels,
                ),
            },
            PixelNumber::F32 => {
                let floats = bytes
                    .as_chunks()
                    .0
                    .iter()
                    .map(|&raw| f64::from(f32::from_bits(u32_from_bytes(raw, self.endian))));
                self.write_floats(floats, voxels);
            }
            PixelNumber::F64 => {
                let endian = self.endian;
                let floats = bytes.as_chunks().0.iter().map(|&raw| match endian {
                    Endian::Little => f64::from_le_bytes(raw),
                    Endian::Big => f64::from_be_bytes(raw),
                });
                self.write_floats(floats, voxels);
            }
        }
    }

    fn write_integers<T: VoxelNumber>(&self, values: impl Iterator<Item = i64>, voxels: &mut [T]) {
        match self.scale {
            None => voxels.iter_mut().zip(values).for_each(|(voxel, value)| *voxel = T::from_integer(value)),
            Some(_) => self.write_floats(values.map(|value| value as f64), voxels),
        }
    }

    fn write_floats<T: VoxelNumber>(&self, values: impl Iterator<Item = f64>, voxels: &mut [T]) {
        let [slope, intercept] = self.scale.unwrap_or([1.0, 0.0]);
        for (voxel, value) in voxels.iter_mut().zip(values) {
            *voxel = T::from_float(value * slope + intercept);
        }
    }

    fn write_colors<T: VoxelNumber>(&self, bytes: &[u8], voxels: &mut [T]) {
        let size = self.shape.bytes_per_number();
        let count = voxels.len();
        let number = |at: usize| {
            let bytes = bytes.get(at * size..).unwrap_or_default();
            match (self.shape.number, size) {
                (PixelNumber::Integer(bits), 1) => {
                    bits.extract(bytes.first().copied().unwrap_or(0).into()) as f64
                }
                (PixelNumber::Integer(bits), 2) => bits
                    .extract(bytes.first_chunk().map_or(0, |&raw| u16_from_bytes(raw, self.endian).into()))
                    as f64,
                (PixelNumber::Integer(bits), _) => bits
                    .extract(bytes.first_chunk().map_or(0, |&raw| u32_from_bytes(raw, self.endian)))
                    as f64,
                (PixelNumber::Bit | PixelNumber::F32 | PixelNumber::F64, _) => 0.0,
            }
        };
        let max_value = match self.shape.number {
            PixelNumber::Integer(bits) => 2f64.powi(bits.stored as i32),
            PixelNumber::Bit | PixelNumber::F32 | PixelNumber::F64 => 1.0,
        };
        for (pixel, voxel) in voxels.iter_mut().enumerate() {
            let stored = match (self.shape.colors, self.shape.is_planar) {
                // Two pixels are stored as Y0 Y1 Cb Cr.
                (PhotometricKind::Ybr422, _) => {
                    let pair = pixel / 2 * 4;
                    [number(pair + pixel % 2), number(pair + 2), number(pair + 3)]
                }
                (_, true) => [0, 1, 2].map(|color| number(color * count + pixel)),
                (_, false) => [0, 1, 2].map(|color| number(pixel * 3 + color)),
            };
            let rgb = match self.shape.colors {
                PhotometricKind::YbrFull | PhotometricKind::Ybr422 => rgb_from_ybr(stored, max_value),
                _ => stored,
            };
            let value = self.part.evaluate(|color| rgb[color], 3);
            *voxel = T::from_float(value.round());
        }
    }
}

/// Converts YCbCr to red, green and blue (PS3.3 section C.7.6.3.1.2), clamped to 0 … `most` − 1.
fn rgb_from_ybr([y, b, r]: [f64; 3], most: f64) -> [f64; 3] {
    let (b, r) = (b - most / 2.0, r - most / 2.0);
    let rgb = [y + 1.402 * r, y - 0.344_136 * b - 0.714_136 * r, y + 1.772 * b];
    rgb.map(|value| value.round().clamp(0.0, most - 1.0))
}

fn u16_from_bytes(raw: [u8; 2], endian: Endian) -> u16 {
    match endian {
        Endian::Little => u16::from_le_bytes(raw),
        Endian::Big => u16::from_be_bytes(raw),
    }
}

fn u32_from_bytes(raw: [u8; 4], endian: Endian) -> u32 {
    match endian {
        Endian::Little => u32::from_le_bytes(raw),
        Endian::Big => u32::from_be_bytes(raw),
    }
}
