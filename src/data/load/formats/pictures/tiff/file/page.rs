//! A page of a TIFF file: its size, its numbers, and where its parts lie.

use std::io;

use super::bytes::Bytes;
use super::directory::{Directory, Entry};
use crate::data::load::reading::number::Number;

/// Tags of entries (TIFF 6.0, sections 8 to 22).
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
    /// Layers in a page: an extension of a maker of volumes.
    pub(in super::super::super) const DEPTH: u16 = 32997;
    /// Of GDAL, in text: the value of what was not measured.
    pub(in super::super::super) const NO_DATA: u16 = 42113;
    /// Lengths of what `ImageJ` keeps beside its stacks, and that.
    pub(in super::super::super) const IMAGEJ_COUNTS: u16 = 50838;
    pub(in super::super::super) const IMAGEJ_CONTENT: u16 = 50839;
    /// Of Zeiss' laser scanning microscopes.
    pub(in super::super::super) const LSM_INFO: u16 = 34412;
}

/// The kind of colours that is brightness and two differences.
const YBR: u64 = 6;

/// What the samples of a pixel are together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Meaning {
    /// One, or grey and its opacity.
    Grey,
    /// Red, green, blue, and maybe opacity.
    Color,
    /// What several detectors have seen.
    Channels,
    /// Colours of another kind, by its number.
    Foreign(u64),
}

/// Where the parts of a page are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Offsets {
    /// In an entry.
    Listed(Entry),
    /// There is one part, and it is here.
    At(u64),
}

/// A page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) struct Page {
    pub(in super::super) width: u64,
    pub(in super::super) height: u64,
    pub(in super::super) bits: u64,
    pub(in super::super) format: u64,
    /// Numbers of each pixel.
    pub(in super::super) samples: usize,
    pub(in super::super) meaning: Meaning,
    /// 0 stands for white.
    pub(in super::super) is_inverted: bool,
    /// Each sample has its own parts.
    pub(in super::super) is_planar: bool,
    pub(in super::super) compression: u64,
    pub(in super::super) predictor: u64,
    /// What pictures of JPEG share.
    pub(in super::super) jpeg_tables: Option<Entry>,
    /// Colours are brightness and two differences, as in JPEG.
    pub(in super::super) is_ybr: bool,
    /// Bits of a byte from the lowest.
    pub(in super::super) is_reversed: bool,
    pub(in super::super) is_tiled: bool,
    /// Pixels of a strip or tile.
    pub(in super::super) part: [u64; 2],
    pub(in super::super) offsets: Offsets,
    pub(in super::super) counts: Option<Entry>,
    /// Not what was recorded itself: smaller, or a mask.
    pub(in super::super) is_aside: bool,
    /// Words about it: some programs write theirs behind those of the user.
    pub(in super::super) descriptions: [Option<Entry>; 2],
}

impl Page {
    /// What a directory says.
    ///
    /// # Errors
    /// `UnexpectedEof` where it points beyond the file, `InvalidData` for what cannot be, `Unsupported` for layers.
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
        // 1 is "black is zero", what most are; some programs leave it out.
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
        // The decoder makes red, green and blue of them.
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
            // Neither is for pictures.
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
            // Bit 0: of reduced resolution; bit 2: a mask. In the older tag 2 is of reduced resolution.
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

    /// Whether all samples have the same bits and format.
    fn has_one_kind_of_numbers(&self, file: &mut Bytes, directory: &Directory) -> io::Result<bool> {
        for (tag, first) in [(tag::BITS, self.bits), (tag::SAMPLE_FORMAT, self.format)] {
            // One number stands for all samples; more than samples say nothing more.
            if let Some(entry) = directory.get(tag).filter(|entry| entry.count > 1) {
                let numbers = entry.numbers(file, self.samples as u64)?;
                if numbers.iter().any(|&number| number != first) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// The type of its numbers, once they are unpacked; `None` where there is none.
    pub(in super::super) fn number(&self) -> Option<Number> {
        // 1 is unsigned, 2 signed, 3 floating point; 4 is "unknown", which is mostly unsigned.
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

    /// Whether another page can be a slice beside this one.
    pub(in super::super) fn is_like(&self, other: &Self) -> bool {
        let kind = |page: &Self| {
            let (size, number) = ([page.width, page.height], (page.bits, page.format));
            (size, number, page.samples, page.is_planar, page.meaning, page.is_inverted)
        };
        kind(self) == kind(other)
    }

    /// Bytes of its numbers once they are unpacked; `None` where that is more than can be counted.
    pub(in super::super) fn bytes(&self) -> Option<u64> {
        let of_pixel = (self.number()?.bytes() as u64).checked_mul(self.samples as u64)?;
        self.width.checked_mul(self.height)?.checked_mul(of_pixel)
    }

    /// Whether all its numbers lie in the file as they are, row by row.
    pub(in super::super) fn is_bare(&self) -> bool {
        self.compression == 1
            && self.predictor == 1
            && !self.is_tiled
            && !self.is_planar
            && self.bits.is_multiple_of(8)
    }
}

/// What samples are, by the kind of colours (TIFF 6.0, `PhotometricInterpretation`) and what those beyond them are said
/// to be.
fn meaning(photometric: u64, samples: usize, extra: Option<u64>) -> Meaning {
    // Extra samples of kind 1 and 2 are opacity.
    let is_opacity = matches!(extra, Some(1 | 2));
    match photometric {
        2 if matches!(samples, 3 | 4) => Meaning::Color,
        // Black or white is zero, a palette (of which the numbers are shown), and red, green, blue of other numbers.
        0..=3 if samples == 1 || (samples == 2 && is_opacity) => Meaning::Grey,
        0..=3 => Meaning::Channels,
        other => Meaning::Foreign(other),
    }
}
