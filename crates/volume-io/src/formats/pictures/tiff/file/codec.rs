//! Decoders of the TIFF compression schemes, for the bytes of a strip or tile.

use std::io::Read;

use flate2::read::ZlibDecoder;
use weezl::{BitOrder, LzwStatus, decode};

use super::jpeg::{self, JpegPart};
use super::zstd;
use crate::reading::samples::{BLOCK_BYTES, ReadFault, read_until_full};
use chiaroscuro_volume::LoadControl;

/// Compression scheme of a strip or tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TiffCodec {
    None,
    Lzw,
    Deflate,
    PackBits,
    Zstd,
    Jpeg,
}

impl TiffCodec {
    /// Returns the scheme by its number in the tag "Compression".
    pub(super) fn from_tag(compression: u64) -> Option<Self> {
        Some(match compression {
            1 => Self::None,
            5 => Self::Lzw,
            // Adobe's number, and an older one.
            8 | 32946 => Self::Deflate,
            32773 => Self::PackBits,
            50000 => Self::Zstd,
            // 6 is the older number, which is supported where each picture is complete.
            6 | 7 => Self::Jpeg,
            _ => return None,
        })
    }

    /// Upper bound of the uncompressed size of `packed` bytes.
    pub(super) fn max_expanded(self, packed: u64) -> u64 {
        let times = match self {
            Self::None => 1,
            // A code of at least 9 bits expands to one of 4096 strings, each one byte longer than another.
            Self::Lzw => 4096,
            // 258 bytes from two codes of one bit each, after the authors of zlib: <https://zlib.net/zlib_tech.html>.
            Self::Deflate => 1032,
            // 128 bytes from two.
            Self::PackBits => 64,
            // A block of 128 KiB of one repeated byte takes four bytes (RFC 8878, 3.1.1.2).
            Self::Zstd => 32 << 10,
            // A block takes at least one bit. With 4:2:0 subsampling six blocks decode to 256 pixels of three
            // components, 128 bytes per bit.
            Self::Jpeg => 1024,
        };
        packed.saturating_mul(times)
    }

    /// Decompresses into `out` until it is full or the input ends; returns the number of bytes. Further input is
    /// ignored. `picture` has the parameters of JPEG and Zstandard.
    pub(super) fn expand(
        self,
        packed: &[u8],
        picture: JpegPart<'_>,
        out: &mut [u8],
        control: &LoadControl,
    ) -> Result<usize, ReadFault> {
        match self {
            Self::None => read_until_full(&mut &packed[..], out, control),
            Self::Lzw => expand_lzw(packed, out, control),
            Self::Deflate => read_until_full(&mut ZlibDecoder::new(packed), out, control),
            Self::PackBits => {
                read_until_full(&mut PackBits { packed, left: 0, repeated: None }, out, control)
            }
            Self::Zstd => zstd::expand(packed, picture.full_bytes, out, control),
            Self::Jpeg => jpeg::expand(picture, packed, out),
        }
    }
}

/// Decodes LZW in the TIFF variant: most significant bit first, with an early change of the code width (TIFF 6.0,
/// section 13).
fn expand_lzw(mut packed: &[u8], out: &mut [u8], control: &LoadControl) -> Result<usize, ReadFault> {
    let mut decoder = decode::Configuration::with_tiff_size_switch(BitOrder::Msb, 8)
        .with_yield_on_full_buffer(true)
        .build();
    let mut filled = 0;
    while filled < out.len() {
        control.check().map_err(ReadFault::Stopped)?;
        let end = out.len().min(filled + BLOCK_BYTES);
        let step = decoder.decode_bytes(packed, &mut out[filled..end]);
        packed = packed.get(step.consumed_in..).unwrap_or_default();
        filled += step.consumed_out;
        match step.status {
            Ok(LzwStatus::Ok) if step.consumed_in > 0 || step.consumed_out > 0 => {}
            Ok(_) => break,
            Err(error) => return Err(ReadFault::Io(std::io::Error::other(error))),
        }
    }
    Ok(filled)
}

/// `PackBits` decoder: run-length encoding of bytes (TIFF 6.0, section 9).
struct PackBits<'a> {
    packed: &'a [u8],
    /// Bytes of the current run that are still to be read.
    left: usize,
    repeated: Option<u8>,
}

impl Read for PackBits<'_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        while self.left == 0 {
            let Some((&head, rest)) = self.packed.split_first() else { return Ok(0) };
            self.packed = rest;
            match head as i8 {
                // No operation.
                -128 => {}
                count @ 0.. => (self.left, self.repeated) = (count as usize + 1, None),
                count => {
                    let Some((&byte, rest)) = self.packed.split_first() else { return Ok(0) };
                    self.packed = rest;
                    (self.left, self.repeated) = (1 + count.unsigned_abs() as usize, Some(byte));
                }
            }
        }
        let mut count = self.left.min(out.len());
        if let Some(byte) = self.repeated {
            out[..count].fill(byte);
        } else {
            count = count.min(self.packed.len());
            let (run, rest) = self.packed.split_at(count);
            out[..count].copy_from_slice(run);
            self.packed = rest;
        }
        self.left -= count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expanded(codec: TiffCodec, packed: &[u8], most: usize) -> Result<Vec<u8>, ReadFault> {
        let mut out = vec![0; most];
        let count = codec.expand(packed, JpegPart::default(), &mut out, &LoadControl::new())?;
        out.truncate(count);
        Ok(out)
    }

    #[test]
    fn runs_are_repeated_and_others_taken() {
        // Example of TIFF 6.0, page 42.
        let packed =
            [0xFE, 0xAA, 0x02, 0x80, 0x00, 0x2A, 0x80, 0xFD, 0xAA, 0x03, 0x80, 0x00, 0x2A, 0x22, 0xF7, 0xAA];
        let mut whole =
            vec![0xAA, 0xAA, 0xAA, 0x80, 0x00, 0x2A, 0xAA, 0xAA, 0xAA, 0xAA, 0x80, 0x00, 0x2A, 0x22];
        whole.extend([0xAA; 10]);
        assert_eq!(expanded(TiffCodec::PackBits, &packed, 100).unwrap(), whole);
        assert_eq!(expanded(TiffCodec::PackBits, &packed, 5).unwrap(), whole[..5]);
        assert_eq!(expanded(TiffCodec::PackBits, &packed[..4], 100).unwrap(), whole[..4], "cut off in a run");
        assert_eq!(expanded(TiffCodec::PackBits, &[0xFE], 100).unwrap(), [0u8; 0]);
    }

    #[test]
    fn expansion_is_bounded() {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        std::io::Write::write_all(&mut encoder, &vec![0; 1 << 22]).unwrap();
        let packed = encoder.finish().unwrap().len() as u64;
        assert!(
            TiffCodec::Deflate.max_expanded(packed) >= 1 << 22
                && TiffCodec::Deflate.max_expanded(packed) < 5 << 20
        );
        assert_eq!(TiffCodec::None.max_expanded(20), 20);
    }

    #[test]
    fn codecs_are_bounded_and_survive_garbage() {
        let bytes: Vec<u8> = (0..4000u32).map(|at| (at * at % 251) as u8).collect();
        let mut lzw = weezl::encode::Encoder::with_tiff_size_switch(BitOrder::Msb, 8);
        let lzw = lzw.encode(&bytes).unwrap();
        let zstd = ruzstd::encoding::compress_to_vec(&bytes[..], ruzstd::encoding::CompressionLevel::Fastest);
        for (codec, packed) in
            [(TiffCodec::None, bytes.clone()), (TiffCodec::Lzw, lzw), (TiffCodec::Zstd, zstd)]
        {
            assert_eq!(expanded(codec, &packed, 4000).unwrap(), bytes, "{codec:?}");
            assert_eq!(expanded(codec, &packed, 70).unwrap(), bytes[..70], "{codec:?}");
            let rest = expanded(codec, &packed[..packed.len() / 2], 4000);
            assert!(rest.is_err() || rest.is_ok_and(|rest| rest.len() < 4000), "{codec:?}");
        }
        for codec in [TiffCodec::Lzw, TiffCodec::Deflate, TiffCodec::PackBits, TiffCodec::Zstd] {
            // An error, or few bytes: both terminate.
            let _either = expanded(codec, &bytes, 100_000);
            let _nothing = expanded(codec, &[], 10);
        }
    }
}
