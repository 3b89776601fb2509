//! Pixel layout of an image: size, components, colour space, and bits (PS3.3 section C.7.6.3).

use super::super::header::DicomHeader;
use super::super::header::tags::{DOUBLES, FLOATS};
use chiaroscuro_volume::{LoadContext, LoadError, VoxelType, quoted};

/// Pixel layout of an image, as stored without compression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PixelLayout {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Number of components per pixel.
    pub(crate) samples: usize,
    /// True if colours are planar: all numbers of one before those of the next.
    pub(crate) is_planar: bool,
    pub(crate) colors: PhotometricKind,
    pub(crate) number: PixelNumber,
}

/// Colour space, or meaning of grey values (Photometric Interpretation).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PhotometricKind {
    /// Grey values, higher is brighter (MONOCHROME2).
    Grey,
    /// Grey values, higher is darker (MONOCHROME1).
    Inverted,
    /// Indices into a table of colours.
    Palette,
    Rgb,
    /// Luminance and two colour differences (ITU-R BT.601, full range).
    YbrFull,
    /// Luminance and colour differences, which every two pixels share (4:2:2).
    Ybr422,
}

/// Storage of one number of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PixelNumber {
    /// Single bit, eight to a byte, lowest bit first; frames follow each other without a gap (PS3.5 section 8.1).
    Bit,
    Integer(IntegerBits),
    F32,
    F64,
}

/// Position of an integer's bits within its storage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct IntegerBits {
    /// Number of bits in the file: 8, 16 or 32.
    pub(crate) allocated: u32,
    /// Number of bits that carry the value.
    pub(crate) stored: u32,
    /// Index of the highest bit that carries the value.
    pub(crate) high: u32,
    /// True for integers in two's complement.
    pub(crate) is_signed: bool,
}

impl PixelLayout {
    /// Derives the pixel layout from a file's header.
    pub(crate) fn from_header(context: LoadContext<'_>, header: &DicomHeader) -> Result<Self, LoadError> {
        let found = &header.values;
        let (Some(rows), Some(columns)) = (found.rows, found.columns) else {
            return Err(context.bad_input_error(
                "Rows, Columns",
                "the size of its images is not stated",
                "copy or export the file again",
            ));
        };
        let samples = found.samples.unwrap_or(1);
        let colors = match (samples, found.photometric.as_str()) {
            (1, "MONOCHROME1") => PhotometricKind::Inverted,
            (1, "PALETTE COLOR") => PhotometricKind::Palette,
            (1, _) => PhotometricKind::Grey,
            (3, "YBR_FULL") => PhotometricKind::YbrFull,
            (3, "YBR_FULL_422") => PhotometricKind::Ybr422,
            (3, "RGB" | "YBR_RCT" | "YBR_ICT" | "") => PhotometricKind::Rgb,
            (samples, photometric) => {
                return Err(context.bad_input_error(
                    "Photometric Interpretation",
                    format!("{samples} samples per pixel as {} are not supported", quoted(photometric)),
                    "convert it to grey values or RGB: `gdcmconv --photometric-interpretation RGB in.dcm out.dcm`",
                ));
            }
        };
        let number = match header.pixels.map(|pixels| pixels.tag) {
            Some(FLOATS) => PixelNumber::F32,
            Some(DOUBLES) => PixelNumber::F64,
            _ if header.values.bits_allocated == Some(1) && samples == 1 => PixelNumber::Bit,
            _ => PixelNumber::Integer(bits_from_header(context, header)?),
        };
        let shape = Self {
            columns: usize::from(columns),
            rows: usize::from(rows),
            samples: usize::from(samples),
            is_planar: samples > 1 && found.planar == Some(1),
            colors,
            number,
        };
        if shape.colors == PhotometricKind::Ybr422 && !shape.columns.is_multiple_of(2) {
            return Err(context.bad_input_error(
                "Columns",
                format!("pixels share colours in pairs (YBR_FULL_422), but the number of columns, {columns}, is odd"),
                "copy or export the file again",
            ));
        }
        Ok(shape)
    }

    /// Returns the number of pixels of an image.
    pub(crate) fn pixel_count(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the size of a number in bytes; a single bit takes a byte once it is unpacked.
    pub(crate) fn bytes_per_number(&self) -> usize {
        match self.number {
            PixelNumber::Bit => 1,
            PixelNumber::Integer(bits) => bits.allocated as usize / 8,
            PixelNumber::F32 => 4,
            PixelNumber::F64 => 8,
        }
    }

    /// Returns the size of two adjacent pixels in bytes, as stored without compression.
    pub(crate) fn bytes_per_pair(&self) -> usize {
        let numbers = if self.colors == PhotometricKind::Ybr422 { 4 } else { 2 * self.samples };
        numbers * self.bytes_per_number()
    }

    /// Returns the size of an image in bytes, without compression.
    pub(crate) fn bytes_per_frame(&self) -> u64 {
        (self.pixel_count() as u64 * self.bytes_per_pair() as u64).div_ceil(2)
    }

    /// Returns the size of this many frames in bytes, as stored without compression; saturating.
    pub(crate) fn stored_bytes(&self, frames: u64) -> u64 {
        match self.number {
            PixelNumber::Bit => (self.pixel_count() as u64).saturating_mul(frames).div_ceil(8),
            _ => self.bytes_per_frame().saturating_mul(frames),
        }
    }

    /// Returns the voxel type that holds the stored values.
    pub(crate) fn voxel_type(&self) -> VoxelType {
        match self.number {
            PixelNumber::Bit => VoxelType::U8,
            PixelNumber::F32 => VoxelType::F32,
            PixelNumber::F64 => VoxelType::F64,
            PixelNumber::Integer(IntegerBits { allocated, is_signed, .. }) => match (allocated, is_signed) {
                (8, false) => VoxelType::U8,
                (8, true) => VoxelType::I8,
                (16, false) => VoxelType::U16,
                (16, true) => VoxelType::I16,
                (_, false) => VoxelType::U32,
                (_, true) => VoxelType::I32,
            },
        }
    }
}

/// Reads the bit layout of the header; impossible values are replaced by the most common ones.
fn bits_from_header(context: LoadContext<'_>, header: &DicomHeader) -> Result<IntegerBits, LoadError> {
    let found = &header.values;
    let allocated = u32::from(found.bits_allocated.unwrap_or(16));
    if !matches!(allocated, 8 | 16 | 32) {
        let why = format!("samples of {allocated} bits are not supported, only those of 1, 8, 16 and 32");
        return Err(context.bad_input_error(
            "Bits Allocated",
            why,
            "convert it with `gdcmconv --raw in.dcm out.dcm`",
        ));
    }
    let stored = found.bits_stored.map_or(allocated, u32::from);
    let stored = if (1..=allocated).contains(&stored) { stored } else { allocated };
    let high = found.high_bit.map_or(stored - 1, u32::from);
    let high = if (stored - 1..allocated).contains(&high) { high } else { stored - 1 };
    Ok(IntegerBits { allocated, stored, high, is_signed: found.is_signed })
}

impl IntegerBits {
    /// Extracts the value of a stored number, with sign extension.
    pub(crate) fn extract(self, raw: u32) -> i64 {
        let shifted = raw >> (self.high + 1 - self.stored);
        let unused = 32 - self.stored;
        if self.is_signed {
            i64::from((shifted << unused) as i32 >> unused)
        } else {
            i64::from(shifted << unused >> unused)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unused_bits_do_not_count_and_signs_do() {
        for (allocated, stored, high, is_signed, raw, value) in [
            (16, 12, 11, false, 0xf123, 0x123),
            (16, 12, 11, true, 0x0fff, -1),
            (16, 12, 11, true, 0xf7ff, 0x7ff),
            (16, 12, 15, false, 0xabcf, 0xabc),
            (16, 12, 15, true, 0xabcf, 0xabc - 0x1000),
            (16, 16, 15, true, 0x8000, -0x8000),
            (8, 8, 7, true, 0xff, -1),
            (8, 8, 7, false, 0xff, 0xff),
            (32, 32, 31, false, u32::MAX, 0xffff_ffff),
            (32, 32, 31, true, u32::MAX, -1),
            (8, 1, 0, false, 0xff, 1),
            (8, 1, 0, true, 1, -1),
        ] {
            let bits = IntegerBits { allocated, stored, high, is_signed };
            assert_eq!(bits.extract(raw), value, "{bits:?} {raw:x}");
        }
    }
}
