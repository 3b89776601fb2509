//! Blosc 1: blocks of shuffled elements, each compressed by itself.
//!
//! After <https://github.com/Blosc/c-blosc/blob/main/README_CHUNK_FORMAT.rst> and the decoder of c-blosc 1.21
//! (`blosc/blosc.c`).

use super::blosclz::decode_blosclz;
use super::{STOPPED, bit_unshuffle, decode_lz4_block, decode_zlib, decode_zstd, unshuffle};
use chiaroscuro_volume::CancelToken;

/// Length of the header, in bytes.
const HEADER_BYTES: usize = 16;

/// Largest element whose bytes are compressed as streams of their own (`MAX_SPLITS`).
const MAX_STREAMS: usize = 16;

/// Fewest elements of a block whose bytes are compressed as streams of their own (`MIN_BUFFERSIZE`).
const MIN_STREAM_BYTES: usize = 128;

/// Compression of the blocks of a chunk.
#[derive(Debug, Clone, Copy)]
enum BlockCompression {
    BloscLz,
    Lz4,
    Zlib,
    Zstd,
}

impl BlockCompression {
    /// Decompresses a stream to at most `max_bytes`.
    fn decode(self, bytes: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
        match self {
            Self::BloscLz => decode_blosclz(bytes, max_bytes),
            Self::Lz4 => decode_lz4_block(bytes, max_bytes),
            Self::Zlib => decode_zlib(bytes, max_bytes),
            Self::Zstd => decode_zstd(bytes, max_bytes),
        }
    }
}

/// Header of a chunk.
struct BloscHeader {
    /// Flags: byte shuffle, plain copy, bit shuffle, single streams, and the compression in the upper three bits.
    flags: u8,
    element_bytes: usize,
    /// Decompressed length, in bytes.
    bytes: usize,
    /// Decompressed length of a block, in bytes.
    block_bytes: usize,
}

impl BloscHeader {
    /// Parses the header of a chunk of at most `max_bytes`.
    fn parse(chunk: &[u8], max_bytes: usize) -> Result<Self, String> {
        let Some(header) = chunk.first_chunk::<HEADER_BYTES>() else {
            return Err(format!("the Blosc header has {HEADER_BYTES} bytes, {} were found", chunk.len()));
        };
        let number =
            |at: usize| header[at..at + 4].iter().rev().fold(0, |all, &byte| all << 8 | usize::from(byte));
        let [bytes, block_bytes, stored_bytes] = [4, 8, 12].map(number);
        if header[0] != 2 {
            return Err(format!("version 2 of Blosc's format was expected, {} was found", header[0]));
        }
        if bytes > max_bytes {
            return Err(format!("the Blosc chunk announces {bytes} bytes, {max_bytes} were expected"));
        }
        if stored_bytes > chunk.len() {
            return Err(format!(
                "the Blosc chunk is truncated: {stored_bytes} bytes expected, {} found",
                chunk.len()
            ));
        }
        if bytes > 0 && (block_bytes == 0 || block_bytes > bytes) {
            return Err(format!("blocks of {block_bytes} bytes do not suit a Blosc chunk of {bytes}"));
        }
        Ok(Self { flags: header[2], element_bytes: usize::from(header[3].max(1)), bytes, block_bytes })
    }

    fn has_flag(&self, bit: u8) -> bool {
        self.flags >> bit & 1 == 1
    }

    fn compression(&self) -> Result<BlockCompression, String> {
        match self.flags >> 5 {
            0 => Ok(BlockCompression::BloscLz),
            1 => Ok(BlockCompression::Lz4),
            2 => Err("Blosc with Snappy is not supported".to_owned()),
            3 => Ok(BlockCompression::Zlib),
            4 => Ok(BlockCompression::Zstd),
            other => Err(format!("compression {other} of Blosc is unknown")),
        }
    }

    /// Number of streams of a block: one for each byte of the elements, or a single one.
    fn streams(&self, block: usize) -> usize {
        let is_whole = (block + 1) * self.block_bytes <= self.bytes;
        let is_split = !self.has_flag(4)
            && self.element_bytes <= MAX_STREAMS
            && self.block_bytes / self.element_bytes >= MIN_STREAM_BYTES;
        if is_split && is_whole { self.element_bytes } else { 1 }
    }

    /// Restores the order of the bytes of a block.
    fn unshuffle(&self, block: Vec<u8>) -> Vec<u8> {
        if self.has_flag(0) && self.element_bytes > 1 {
            unshuffle(&block, self.element_bytes)
        } else if self.has_flag(2) && (block.len() / self.element_bytes).is_multiple_of(8) {
            bit_unshuffle(&block, self.element_bytes)
        } else {
            block
        }
    }
}

/// Decompresses a Blosc chunk to at most `max_bytes`.
///
/// # Errors
/// Fails for a broken chunk, one of more bytes, or a compression that is not supported.
pub(crate) fn decode_blosc(chunk: &[u8], max_bytes: usize) -> Result<Vec<u8>, String> {
    let header = BloscHeader::parse(chunk, max_bytes)?;
    if header.has_flag(1) {
        let plain = chunk.get(HEADER_BYTES..HEADER_BYTES + header.bytes);
        return plain.map(<[u8]>::to_vec).ok_or_else(|| "the Blosc chunk is truncated".to_owned());
    }
    let compression = header.compression()?;
    let blocks = header.bytes.div_ceil(header.block_bytes.max(1));
    let mut out = Vec::with_capacity(header.bytes);
    let token = CancelToken::current();
    for block in 0..blocks {
        if token.is_cancelled() {
            return Err(STOPPED.to_owned());
        }
        let block_bytes = header.block_bytes.min(header.bytes - block * header.block_bytes);
        let mut at = read_length(chunk, HEADER_BYTES + 4 * block)?;
        let streams = header.streams(block);
        let stream_bytes = block_bytes / streams;
        let mut plain = Vec::with_capacity(block_bytes);
        for _ in 0..streams {
            let length = read_length(chunk, at)?;
            at += 4;
            let stream = at.checked_add(length).and_then(|end| chunk.get(at..end));
            let stream = stream.ok_or_else(|| format!("block {block} reaches beyond the Blosc chunk"))?;
            at += length;
            // Streams that compression would not shorten are stored as they are.
            if length == stream_bytes {
                plain.extend_from_slice(stream);
            } else {
                plain.extend(compression.decode(stream, stream_bytes)?);
            }
        }
        if plain.len() != block_bytes {
            return Err(format!("block {block} has {} bytes, {block_bytes} were expected", plain.len()));
        }
        out.extend(header.unshuffle(plain));
    }
    Ok(out)
}

/// Reads a length, or a position, of four bytes.
fn read_length(chunk: &[u8], at: usize) -> Result<usize, String> {
    let bytes = at.checked_add(4).and_then(|end| chunk.get(at..end));
    let bytes = bytes.ok_or_else(|| "the Blosc chunk is truncated".to_owned())?;
    Ok(bytes.iter().rev().fold(0, |all, &byte| all << 8 | usize::from(byte)))
}
