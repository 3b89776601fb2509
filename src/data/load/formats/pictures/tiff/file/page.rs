//! Page of a TIFF file: its size, number type, and the location of its strips or tiles.

use std::io;

use super::bytes::Bytes;
use super::directory::{Directory, Entry};
use crate::data::load::reading::number::Number;

/// Tags of directory entries (TIFF 6.0, sections 8 to 22).
pub(in super::super) mod tag {
    pub(in super::super::super) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(in super::super::super) const SUBFILE_TYPE: u16 = 255;
    pub(in super::super::super) const WIDTH: u16 = 256;
    pub(in super::super::super) const HEIGHT: u16 = 257;
    pub(in super::super::super) const BITS: u16 = 258;
    pub(in super::super::super) const COMPRESSION: u16 = 259;
    pub(in super::super::super) const PHOTOMETRIC: u16 = 262;
    pub(in super::super::super) const FILL_ORDER: u16 = 266;
    pub(in super::super::super) const DESCRIPTION: u16 = 270;
    pub(in super::super::super) const STRIP_OFFSETS: u16 = 273;
    pub(in super::super::super) const SAMPLES: u16 = 277;
    pub(in super::super::super) const ROWS_PER_STRIP: u16 = 278;
    pub(in super::super::super) const STRIP_COUNTS: u16 = 279;
    pub(in super::super::super) const X_RESOLUTION: u16 = 282;
    pub(in super::super::super) const Y_RESOLUTION: u16 = 283;
    pub(in super::super::super) const PLANAR: u16 = 284;
    pub(in super::super::super) const PREDICTOR: u16 = 317;
    pub(in super::super::super) const COLOR_MAP: u16 = 320;
    pub(in super::super::super) const TILE_WIDTH: u16 = 322;
    pub(in super::super::super) const TILE_HEIGHT: u16 = 323;
    pub(in super::super::super) const TILE_OFFSETS: u16 = 324;
    pub(in super::super::super) const TILE_COUNTS: u16 = 325;
    pub(in super::super::super) const EXTRA_SAMPLES: u16 = 338;
    pub(in super::super::super) const JPEG_TABLES: u16 = 347;
    pub(in super::super::super) const SAMPLE_FORMAT: u16 = 339;
    /// Layers in a page (`ImageDepth`): an extension by SGI for volumes.
    pub(in super::super::super) const DEPTH: u16 = 32997;
    /// Value of missing data, as text (GDAL).
    pub(in super::super::super) const NO_DATA: u16 = 42113;
    /// Lengths and content of the `ImageJ` metadata block.
    pub(in super::super::super) const IMAGEJ_COUNTS: u16 = 50838;
    pub(in super::super::super) const IMAGEJ_CONTENT: u16 = 50839;
    /// Metadata block of Zeiss laser scanning microscopes.
    pub(in super::super::super) const LSM_INFO: u16 = 34412;
}

/// Photometric interpretation `YCbCr`: luma and two colour differences.
const YBR: u64 = 6;

/// Meaning of a pixel's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Meaning {
    /// Grey, possibly with opacity.
    Grey,
    /// Red, green and blue, possibly with opacity.
    Color,
    /// Channels of several detectors.
    Channels,
    /// Colour space that is not supported, by its number.
    Foreign(u64),
}

/// Location of a page's strips or tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Offsets {
    /// Directory entry that lists them.
    Listed(Entry),
    /// Offset of the only strip.
    At(u64),
}

/// Page of a TIFF file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) struct Page {
    pub(in super::super) width: u64,
    pub(in super::super) height: u64,
    pub(in super::super) bits: u64,
    pub(in super::super) format: u64,
    /// Number of samples per pixel.
    pub(in super::super) samples: usize,
    pub(in super::super) meaning: Meaning,
    /// True if 0 means white.
    pub(in super::super) is_inverted: bool,
    /// True if each sample has strips or tiles of its own.
    pub(in super::super) is_planar: bool,
    pub(in super::super) compression: u64,
    pub(in super::super) predictor: u64,
    /// Shared tables of JPEG strips or tiles.
    pub(in super::super) jpeg_tables: Option<Entry>,
    /// True if colours are `YCbCr`, as usual in JPEG.
    pub(in super::super) is_ybr: bool,
    /// True if the bits of a byte begin with the least significant.
    pub(in super::super) is_reversed: bool,
    pub(in super::super) is_tiled: bool,
    /// Width and height of a strip or tile, in pixels.
    pub(in super::super) part: [u64; 2],
    pub(in super::super) offsets: Offsets,
    pub(in super::super) counts: Option<Entry>,
    /// True if the page is not itself recorded data: a reduced copy, or a mask.
    pub(in super::super) is_aside: bool,
    /// Description entries: some programs add their own after the user's.
    pub(in super::super) descriptions: [Option<Entry>; 2],
}

impl Page {
    /// Parses a directory.
    ///
    /// # Errors
    /// `UnexpectedEof` where it points beyond the file, `InvalidData` for invalid values, `Unsupported` for several
    /// layers.
    pub(in super::super) fn of(file: &mut Bytes, directory: &Directory) -> io::Result<Self> {
        let mut say = |tag, default: Option<u64>| match (directory.get(tag), default) {
            (Some(entry), _) => entry.whole(file),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(io::ErrorKind::InvalidData.into()),
        };
        let (width, height) = (say(tag::WIDTH, None)?, say(tag::HEIGHT, None)?);
        if say(tag::DEPTH, Some(1))? > 1 {
            return Err(io::ErrorKind::Unsupported.into());
        }
        let (bits, samples) = (say(tag::BITS, Some(1))?, say(tag::SAMPLES, Some(1))?);
        // 1 is "black is zero", the most common; some programs omit it.
        let photometric = say(tag::PHOTOMETRIC, Some(1))?;
        let extra = directory.get(tag::EXTRA_SAMPLES).map(|_| say(tag::EXTRA_SAMPLES, None)).transpose()?;
        let samples = usize::from(u16::try_from(samples).ok().ok_or(io::ErrorKind::InvalidData)?);
        let is_tiled = directory.get(tag::TILE_OFFSETS).is_some();
        let part = if is_tiled {
            [say(tag::TILE_WIDTH, None)?, say(tag::TILE_HEIGHT, None)?]
        } else {
            [width, say(tag::ROWS_PER_STRIP, Some(height))?.min(height)]
        };
        let compression = say(tag::COMPRESSION, Some(1))?;
        let is_jpeg = matches!(compression, 6 | 7);
        // The JPEG decoder converts YCbCr to red, green and blue.
        let is_ybr = is_jpeg && photometric == YBR && samples == 3;
        let subfile = say(tag::NEW_SUBFILE_TYPE, Some(0))?;
        let old_subfile = say(tag::SUBFILE_TYPE, Some(1))?;
        let page = Self {
            width,
            height,
            bits,
            format: say(tag::SAMPLE_FORMAT, Some(1))?,
            samples,
            meaning: if is_ybr { Meaning::Color } else { meaning(photometric, samples, extra) },
            is_inverted: photometric == 0,
            is_planar: say(tag::PLANAR, Some(1))? == 2 && samples > 1,
            compression,
            // JPEG uses neither predictor nor fill order.
            predictor: if is_jpeg { 1 } else { say(tag::PREDICTOR, Some(1))? },
            is_reversed: !is_jpeg && say(tag::FILL_ORDER, Some(1))? == 2,
            jpeg_tables: directory.get(tag::JPEG_TABLES).filter(|_| is_jpeg),
            is_ybr,
            is_tiled,
            part,
            offsets: directory
                .get(if is_tiled { tag::TILE_OFFSETS } else { tag::STRIP_OFFSETS })
                .map(Offsets::Listed)
                .ok_or(io::ErrorKind::InvalidData)?,
            counts: directory.get(if is_tiled { tag::TILE_COUNTS } else { tag::STRIP_COUNTS }),
            // Bit 0: reduced resolution; bit 2: mask. In the older tag 2 means reduced resolution.
            is_aside: subfile & 0b101 != 0 || old_subfile == 2,
            descriptions: {
                let mut all = directory.all(tag::DESCRIPTION);
                [all.next(), all.next()]
            },
        };
        let has_none = [width, height, part[0], part[1], bits, samples as u64].contains(&0);
        let is_same = page.has_one_kind_of_numbers(file, directory)?;
        if has_none || !is_same { Err(io::ErrorKind::InvalidData.into()) } else { Ok(page) }
    }

    /// Returns true if all samples have equal bit depth and format.
    fn has_one_kind_of_numbers(&self, file: &mut Bytes, directory: &Directory) -> io::Result<bool> {
        for (tag, first) in [(tag::BITS, self.bits), (tag::SAMPLE_FORMAT, self.format)] {
            // One number stands for all samples; numbers beyond the sample count mean nothing.
            if let Some(entry) = directory.get(tag).filter(|entry| entry.count > 1) {
                let numbers = entry.numbers(file, self.samples as u64)?;
                if numbers.iter().any(|&number| number != first) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Number type of the unpacked samples; `None` where unsupported.
    pub(in super::super) fn number(&self) -> Option<Number> {
        // 1 is unsigned, 2 signed, 3 floating point; 4 is "undefined", mostly unsigned.
        match (self.format, self.bits) {
            (1 | 4, 1..=8) => Some(Number::U8),
            (1 | 4, 9..=16) => Some(Number::U16),
            (1 | 4, 32) => Some(Number::U32),
            (1 | 4, 64) => Some(Number::U64),
            (2, 8) => Some(Number::I8),
            (2, 16) => Some(Number::I16),
            (2, 32) => Some(Number::I32),
            (2, 64) => Some(Number::I64),
            (3, 16) => Some(Number::F16),
            (3, 32) => Some(Number::F32),
            (3, 64) => Some(Number::F64),
            _ => None,
        }
    }

    /// Returns true if both pages can be slices of one volume.
    pub(in super::super) fn is_like(&self, other: &Self) -> bool {
        let kind = |page: &Self| {
            let (size, number) = ([page.width, page.height], (page.bits, page.format));
            (size, number, page.samples, page.is_planar, page.meaning, page.is_inverted)
        };
        kind(self) == kind(other)
    }

    /// Bytes of all unpacked samples; `None` on overflow or for an unsupported number type.
    pub(in super::super) fn bytes(&self) -> Option<u64> {
        let of_pixel = (self.number()?.bytes() as u64).checked_mul(self.samples as u64)?;
        self.width.checked_mul(self.height)?.checked_mul(of_pixel)
    }

    /// Returns true if the samples lie in the file row by row, uncompressed.
    pub(in super::super) fn is_bare(&self) -> bool {
        self.compression == 1
            && self.predictor == 1
            && !self.is_tiled
            && !self.is_planar
            && self.bits.is_multiple_of(8)
    }
}

/// Meaning of the samples, by the colour space (TIFF 6.0, `PhotometricInterpretation`) and the kind of the extra
/// samples.
fn meaning(photometric: u64, samples: usize, extra: Option<u64>) -> Meaning {
    // Extra samples of kinds 1 and 2 are opacity (alpha).
    let is_opacity = matches!(extra, Some(1 | 2));
    match photometric {
        2 if matches!(samples, 3 | 4) => Meaning::Color,
        // White is zero, black is zero, RGB with an unusual number of samples, and palette colours (whose indices are
        // shown).
        0..=3 if samples == 1 || (samples == 2 && is_opacity) => Meaning::Grey,
        0..=3 => Meaning::Channels,
        other => Meaning::Foreign(other),
    }
}
