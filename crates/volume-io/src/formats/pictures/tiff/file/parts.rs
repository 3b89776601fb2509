//! Strips and tiles of a TIFF page: their number and lengths, and whether their encoding is supported.

use super::super::messages::{HELP, compression_name};
use super::codec::TiffCodec;
use super::page::{SampleMeaning, TiffPage};
use chiaroscuro_volume::{LoadContext, LoadError};

/// Maximum excess of a tile over its page, in bytes: pages are rounded up to whole tiles, mostly of 256 x 256 pixels.
const MAX_TILE_EXCESS: u64 = 64 << 20;

impl TiffPage {
    /// Number of strips or tiles across and down.
    pub(super) fn grid(&self) -> [u64; 2] {
        [self.width.div_ceil(self.part_size[0]), self.height.div_ceil(self.part_size[1])]
    }

    /// Bytes of a row of a strip or tile, uncompressed.
    pub(super) fn row_bytes(&self, samples: usize) -> u64 {
        (u128::from(self.part_size[0]) * samples as u128 * u128::from(self.bits)).div_ceil(8) as u64
    }

    /// Uncompressed bytes of a strip or tile in row `row`; the last strip may be shorter.
    pub(super) fn part_bytes(&self, samples: usize, row: u64) -> u64 {
        let left = self.height - row * self.part_size[1];
        let rows = if self.is_tiled { self.part_size[1] } else { self.part_size[1].min(left) };
        self.row_bytes(samples).saturating_mul(rows)
    }

    /// Checks that the page's encoding is supported and its sizes are plausible.
    pub(crate) fn check_supported(&self, context: LoadContext<'_>, field: &str) -> Result<(), LoadError> {
        let refuse = |why: String, help: &str| Err(context.bad_input_error(field, why, help));
        let bits = self.bits;
        if let SampleMeaning::Unsupported(photometric) = self.meaning {
            let kind = match photometric {
                4 => "transparency mask",
                5 => "CMYK",
                6 => "YCbCr",
                8..=10 => "CIE L*a*b*",
                32803 | 34892 => "camera raw data",
                _ => "unknown",
            };
            return refuse(format!("its colour space is not supported: {kind}"), "save it as grey or RGB");
        }
        if self.number().is_none() {
            let format = match self.format {
                2 => "signed",
                3 => "floating point",
                5 | 6 => "complex",
                _ => "unsigned",
            };
            return refuse(
                format!("its sample type is not supported: {format}, of {bits} bits"),
                "save it with unsigned or signed integers of 8, 16 or 32 bits, or 32-bit floating point",
            );
        }
        if TiffCodec::from_tag(self.compression).is_none() {
            let name = compression_name(self.compression);
            return refuse(
                format!("its compression is not supported: {name} (number {})", self.compression),
                "save it uncompressed, or with LZW, Deflate, PackBits or Zstandard",
            );
        }
        if TiffCodec::from_tag(self.compression) == Some(TiffCodec::Jpeg) && (bits != 8 || self.format == 2) {
            return refuse(
                format!("JPEG is supported for unsigned samples of 8 bits only, these have {bits}"),
                "save it uncompressed, or with LZW, Deflate, PackBits or Zstandard",
            );
        }
        let suits = match self.predictor {
            1 => true,
            2 => bits.is_multiple_of(8),
            3 => self.format == 3,
            _ => false,
        };
        if !suits {
            return refuse(
                format!("predictor {} is not supported for its samples of {bits} bits", self.predictor),
                "save it without a predictor",
            );
        }
        let samples = if self.is_planar { 1 } else { self.samples };
        let part = self.part_bytes(samples, 0);
        // Unpacked numbers are at least as long as packed ones.
        match self.bytes() {
            Some(whole) if part <= whole.saturating_add(MAX_TILE_EXCESS) => Ok(()),
            _ => refuse(
                format!(
                    "its tile size of {} x {} pixels is implausible",
                    self.part_size[0], self.part_size[1]
                ),
                HELP,
            ),
        }
    }
}
