//! Page of a TIFF file: its size, number type, and the location of its strips or tiles.

use std::io;

use super::bytes::TiffBytes;
use super::directory::{TiffDirectory, TiffDirectoryEntry};
use crate::reading::number::FileNumberType;

/// Tags of directory entries (TIFF 6.0, sections 8 to 22).
pub(crate) mod tag {
    pub(crate) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(crate) const SUBFILE_TYPE: u16 = 255;
    pub(crate) const WIDTH: u16 = 256;
    pub(crate) const HEIGHT: u16 = 257;
    pub(crate) const BITS: u16 = 258;
    pub(crate) const COMPRESSION: u16 = 259;
    pub(crate) const PHOTOMETRIC: u16 = 262;
    pub(crate) const FILL_ORDER: u16 = 266;
    pub(crate) const DESCRIPTION: u16 = 270;
    pub(crate) const STRIP_OFFSETS: u16 = 273;
    pub(crate) const SAMPLES: u16 = 277;
    pub(crate) const ROWS_PER_STRIP: u16 = 278;
    pub(crate) const STRIP_COUNTS: u16 = 279;
    pub(crate) const X_RESOLUTION: u16 = 282;
    pub(crate) const Y_RESOLUTION: u16 = 283;
    pub(crate) const PLANAR: u16 = 284;
    pub(crate) const PREDICTOR: u16 = 317;
    pub(crate) const COLOR_MAP: u16 = 320;
    pub(crate) const TILE_WIDTH: u16 = 322;
    pub(crate) const TILE_HEIGHT: u16 = 323;
    pub(crate) const TILE_OFFSETS: u16 = 324;
    pub(crate) const TILE_COUNTS: u16 = 325;
    pub(crate) const EXTRA_SAMPLES: u16 = 338;
    pub(crate) const JPEG_TABLES: u16 = 347;
    pub(crate) const SAMPLE_FORMAT: u16 = 339;
    /// Layers in a page (`ImageDepth`): an extension by SGI for volumes.
    pub(crate) const DEPTH: u16 = 32997;
    /// Value of missing data, as text (GDAL).
    pub(crate) const NO_DATA: u16 = 42113;
    /// Lengths and content of the `ImageJ` metadata block.
    pub(crate) const IMAGEJ_COUNTS: u16 = 50838;
    pub(crate) const IMAGEJ_CONTENT: u16 = 50839;
    /// Metadata block of Zeiss laser scanning microscopes.
    pub(crate) const LSM_INFO: u16 = 34412;
}

/// Photometric interpretation `YCbCr`: luma and two colour differences.
const YCBCR: u64 = 6;

/// Meaning of a pixel's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SampleMeaning {
    /// Grey, possibly with opacity.
    Grey,
    /// Red, green and blue, possibly with opacity.
    Color,
    /// Channels of several detectors.
    Channels,
    /// Colour space that is not supported, by its number.
    Unsupported(u64),
}

/// Location of a page's strips or tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PartOffsets {
    /// Directory entry that lists them.
    Listed(TiffDirectoryEntry),
    /// Offset of the only strip.
    At(u64),
}

/// Page of a TIFF file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TiffPage {
    pub(crate) width: u64,
    pub(crate) height: u64,
    pub(crate) bits: u64,
    pub(crate) format: u64,
    /// Number of samples per pixel.
    pub(crate) samples: usize,
    pub(crate) meaning: SampleMeaning,
    /// True if 0 means white.
    pub(crate) is_inverted: bool,
    /// True if each sample has strips or tiles of its own.
    pub(crate) is_planar: bool,
    pub(crate) compression: u64,
    pub(crate) predictor: u64,
    /// Shared tables of JPEG strips or tiles.
    pub(crate) jpeg_tables: Option<TiffDirectoryEntry>,
    /// True if colours are `YCbCr`, as usual in JPEG.
    pub(crate) is_ycbcr: bool,
    /// True if the bits of a byte begin with the least significant.
    pub(crate) is_lsb_first: bool,
    pub(crate) is_tiled: bool,
    /// Width and height of a strip or tile, in pixels.
    pub(crate) part_size: [u64; 2],
    pub(crate) offsets: PartOffsets,
    pub(crate) counts: Option<TiffDirectoryEntry>,
    /// True if the page is not itself recorded data: a reduced copy, or a mask.
    pub(crate) is_auxiliary: bool,
    /// Description entries: some programs add their own after the user's.
    pub(crate) descriptions: [Option<TiffDirectoryEntry>; 2],
}

impl TiffPage {
    /// Parses a directory.
    ///
    /// # Errors
    /// `UnexpectedEof` where it points beyond the file, `InvalidData` for invalid values, `Unsupported` for several
    /// layers.
    pub(crate) fn parse(file: &mut TiffBytes, directory: &TiffDirectory) -> io::Result<Self> {
        let mut read_number = |tag, default: Option<u64>| match (directory.get(tag), default) {
            (Some(entry), _) => entry.first_integer(file),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(io::ErrorKind::InvalidData.into()),
        };
        let (width, height) = (read_number(tag::WIDTH, None)?, read_number(tag::HEIGHT, None)?);
        if read_number(tag::DEPTH, Some(1))? > 1 {
            return Err(io::ErrorKind::Unsupported.into());
        }
        let (bits, samples) = (read_number(tag::BITS, Some(1))?, read_number(tag::SAMPLES, Some(1))?);
        // 1 is "black is zero", the most common; some programs omit it.
        let photometric = read_number(tag::PHOTOMETRIC, Some(1))?;
        let extra =
            directory.get(tag::EXTRA_SAMPLES).map(|_| read_number(tag::EXTRA_SAMPLES, None)).transpose()?;
        let samples = usize::from(u16::try_from(samples).ok().ok_or(io::ErrorKind::InvalidData)?);
        let is_tiled = directory.get(tag::TILE_OFFSETS).is_some();
        let part = if is_tiled {
            [read_number(tag::TILE_WIDTH, None)?, read_number(tag::TILE_HEIGHT, None)?]
        } else {
            [width, read_number(tag::ROWS_PER_STRIP, Some(height))?.min(height)]
        };
        let compression = read_number(tag::COMPRESSION, Some(1))?;
        let is_jpeg = matches!(compression, 6 | 7);
        // The JPEG decoder converts YCbCr to red, green and blue.
        let is_ybr = is_jpeg && photometric == YCBCR && samples == 3;
        let subfile = read_number(tag::NEW_SUBFILE_TYPE, Some(0))?;
        let old_subfile = read_number(tag::SUBFILE_TYPE, Some(1))?;
        let page = Self {
            width,
            height,
            bits,
            format: read_number(tag::SAMPLE_FORMAT, Some(1))?,
            samples,
            meaning: if is_ybr { SampleMeaning::Color } else { sample_meaning(photometric, samples, extra) },
            is_inverted: photometric == 0,
            is_planar: read_number(tag::PLANAR, Some(1))? == 2 && samples > 1,
            compression,
            // JPEG uses neither predictor nor fill order.
            predictor: if is_jpeg { 1 } else { read_number(tag::PREDICTOR, Some(1))? },
            is_lsb_first: !is_jpeg && read_number(tag::FILL_ORDER, Some(1))? == 2,
            jpeg_tables: directory.get(tag::JPEG_TABLES).filter(|_| is_jpeg),
            is_ycbcr: is_ybr,
            is_tiled,
            part_size: part,
            offsets: directory
                .get(if is_tiled { tag::TILE_OFFSETS } else { tag::STRIP_OFFSETS })
                .map(PartOffsets::Listed)
                .ok_or(io::ErrorKind::InvalidData)?,
            counts: directory.get(if is_tiled { tag::TILE_COUNTS } else { tag::STRIP_COUNTS }),
            // Bit 0: reduced resolution; bit 2: mask. In the older tag 2 means reduced resolution.
            is_auxiliary: subfile & 0b101 != 0 || old_subfile == 2,
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
    fn has_one_kind_of_numbers(&self, file: &mut TiffBytes, directory: &TiffDirectory) -> io::Result<bool> {
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
    pub(crate) fn number(&self) -> Option<FileNumberType> {
        // 1 is unsigned, 2 signed, 3 floating point; 4 is "undefined", mostly unsigned.
        match (self.format, self.bits) {
            (1 | 4, 1..=8) => Some(FileNumberType::U8),
            (1 | 4, 9..=16) => Some(FileNumberType::U16),
            (1 | 4, 32) => Some(FileNumberType::U32),
            (1 | 4, 64) => Some(FileNumberType::U64),
            (2, 8) => Some(FileNumberType::I8),
            (2, 16) => Some(FileNumberType::I16),
            (2, 32) => Some(FileNumberType::I32),
            (2, 64) => Some(FileNumberType::I64),
            (3, 16) => Some(FileNumberType::F16),
            (3, 32) => Some(FileNumberType::F32),
            (3, 64) => Some(FileNumberType::F64),
            _ => None,
        }
    }

    /// Returns true if both pages can be slices of one volume.
    pub(crate) fn matches(&self, other: &Self) -> bool {
        let kind = |page: &Self| {
            let (size, number) = ([page.width, page.height], (page.bits, page.format));
            (size, number, page.samples, page.is_planar, page.meaning, page.is_inverted)
        };
        kind(self) == kind(other)
    }

    /// Bytes of all unpacked samples; `None` on overflow or for an unsupported number type.
    pub(crate) fn bytes(&self) -> Option<u64> {
        let of_pixel = (self.number()?.bytes() as u64).checked_mul(self.samples as u64)?;
        self.width.checked_mul(self.height)?.checked_mul(of_pixel)
    }

    /// Returns true if the samples lie in the file row by row, uncompressed.
    pub(crate) fn is_plain_rows(&self) -> bool {
        self.compression == 1
            && self.predictor == 1
            && !self.is_tiled
            && !self.is_planar
            && self.bits.is_multiple_of(8)
    }
}

/// Meaning of the samples, by the colour space (TIFF 6.0, `PhotometricInterpretation`) and the kind of the extra
/// samples.
fn sample_meaning(photometric: u64, samples: usize, extra: Option<u64>) -> SampleMeaning {
    // Extra samples of kinds 1 and 2 are opacity (alpha).
    let is_opacity = matches!(extra, Some(1 | 2));
    match photometric {
        2 if matches!(samples, 3 | 4) => SampleMeaning::Color,
        // White is zero, black is zero, RGB with an unusual number of samples, and palette colours (whose indices are
        // shown).
        0..=3 if samples == 1 || (samples == 2 && is_opacity) => SampleMeaning::Grey,
        0..=3 => SampleMeaning::Channels,
        other => SampleMeaning::Unsupported(other),
    }
}
