//! Codecs of a chunk: the order of axes and bytes, and compressions.

use super::Endian;
use crate::reading::chunk_codecs::{
    bit_unshuffle, crc32c, decode_blosc, decode_bzip2, decode_gzip, decode_lz4_with_length, decode_zlib,
    decode_zstd, unshuffle,
};

/// Compression, filter or checksum of the bytes of a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteCodec {
    Gzip,
    Zlib,
    Bzip2,
    Zstd,
    Blosc,
    Lz4,
    /// Byte shuffle of elements of so many bytes.
    Shuffle(usize),
    /// Bit shuffle of elements of so many bytes, without a compression.
    BitShuffle(usize),
    /// Checksum of four bytes after the data.
    Crc32c,
}

/// Names of the codecs, for messages.
pub(super) const SUPPORTED_CODECS: &str =
    "gzip, zlib, bz2, zstd, blosc, lz4, shuffle, crc32c, bytes, transpose and sharding_indexed";

impl ByteCodec {
    /// Codec of a name, as version 2 and version 3 have it; `element_bytes` is the size of shuffled elements.
    pub(super) fn parse(name: &str, element_bytes: usize) -> Option<Self> {
        Some(match name.strip_prefix("numcodecs.").unwrap_or(name) {
            "gzip" => Self::Gzip,
            "zlib" => Self::Zlib,
            "bz2" => Self::Bzip2,
            "zstd" => Self::Zstd,
            "blosc" => Self::Blosc,
            "lz4" => Self::Lz4,
            "shuffle" => Self::Shuffle(element_bytes),
            "bitshuffle" => Self::BitShuffle(element_bytes),
            "crc32c" => Self::Crc32c,
            _ => return None,
        })
    }

    /// Decodes to at most `max_bytes`.
    fn decode(self, bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
        match self {
            Self::Gzip => decode_gzip(bytes, max_bytes),
            Self::Zlib => decode_zlib(bytes, max_bytes),
            Self::Bzip2 => decode_bzip2(bytes, max_bytes),
            Self::Zstd => decode_zstd(bytes, max_bytes),
            Self::Blosc => decode_blosc(bytes, max_bytes),
            Self::Lz4 => decode_lz4_with_length(bytes, max_bytes),
            Self::Shuffle(size) => Ok(unshuffle(bytes, size)),
            Self::BitShuffle(size) => Ok(bit_unshuffle(bytes, size)),
            Self::Crc32c => {
                let Some((data, sum)) = bytes.split_last_chunk::<4>() else {
                    return Err("it ends within its checksum".to_owned());
                };
                if crc32c(data) != u32::from_le_bytes(*sum) {
                    return Err("its checksum does not match".to_owned());
                }
                Ok(data.to_vec())
            }
        }
    }
}

/// Codecs of a chunk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CodecPipeline {
    /// Axis of the array in the place of each axis of the stored chunk, slowest first; empty where they are the same.
    pub(super) axis_order: Vec<usize>,
    /// Byte order of elements.
    pub(super) endian: Endian,
    /// Codecs of bytes, in the order in which they were encoded.
    pub(super) byte_codecs: Vec<ByteCodec>,
}

/// Bytes by which codecs may make a chunk longer than its data: headers, and blocks that cannot be compressed.
const MAX_OVERHEAD_BYTES: usize = 1 << 16;

impl CodecPipeline {
    /// Decodes a chunk, which has `chunk_bytes` when it is decoded.
    pub(super) fn decode(&self, stored: Vec<u8>, chunk_bytes: usize) -> Result<Vec<u8>, String> {
        // Between two codecs a chunk may be slightly longer.
        let most = |codec: usize| {
            if codec == 0 { chunk_bytes } else { chunk_bytes + chunk_bytes / 8 + MAX_OVERHEAD_BYTES }
        };
        let mut bytes = stored;
        for (at, codec) in self.byte_codecs.iter().enumerate().rev() {
            bytes = codec.decode(&bytes, most(at))?;
        }
        if bytes.len() != chunk_bytes {
            return Err(format!(
                "it has {} bytes when it is decoded, {chunk_bytes} were expected",
                bytes.len()
            ));
        }
        Ok(bytes)
    }

    /// Maximum length of a stored chunk that has `chunk_bytes` when it is decoded.
    pub(super) fn max_stored_bytes(chunk_bytes: u64) -> u64 {
        // A compression that fails makes a chunk slightly longer.
        chunk_bytes.saturating_add(chunk_bytes / 8).saturating_add(MAX_OVERHEAD_BYTES as u64)
    }

    /// Distance between neighbours along each axis of the array in a decoded chunk, in elements; slowest first.
    pub(super) fn strides(&self, chunk_shape: &[u64]) -> Vec<usize> {
        let mut strides = vec![1; chunk_shape.len()];
        let mut distance = 1usize;
        for place in (0..chunk_shape.len()).rev() {
            let axis = self.axis_order.get(place).copied().unwrap_or(place);
            strides[axis] = distance;
            distance = distance.saturating_mul(usize::try_from(chunk_shape[axis]).unwrap_or(usize::MAX));
        }
        strides
    }
}
