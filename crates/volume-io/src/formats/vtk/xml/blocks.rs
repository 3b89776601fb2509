//! Decoder of binary values in VTK XML files: a length and the data, or a table of blocks and the blocks, each
//! compressed separately.

use std::io::{self, Cursor, Read};

use bytemuck::allocation::try_zeroed_vec;
use flate2::read::ZlibDecoder;

use super::super::super::Endian;
use super::super::image::invalid_data;

/// Maximum size of a block, since each is in memory three times, counting the volume: VTK's blocks have 32 KiB by
/// default, but a file may consist of a single one.
const MAX_BLOCK_BYTES: u64 = 1 << 30;

/// Compression scheme of the blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
}

/// Format of the header numbers before the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct HeaderWords {
    /// True for 64-bit numbers, false for 32-bit ones.
    pub(super) are_64_bit: bool,
    pub(super) endian: Endian,
}

impl HeaderWords {
    fn read(self, reader: &mut impl Read) -> io::Result<u64> {
        let mut bytes = [0; 8];
        let bytes = if self.are_64_bit { &mut bytes[..] } else { &mut bytes[..4] };
        reader.read_exact(bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => invalid_data("the data end within their header"),
            _ => error,
        })?;
        // Most significant byte first.
        if self.endian == Endian::Little {
            bytes.reverse();
        }
        Ok(bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte)))
    }
}

/// Reads the length of uncompressed values, which must be `expected` bytes.
pub(super) fn check_length(reader: &mut impl Read, words: HeaderWords, expected: u64) -> io::Result<()> {
    let length = words.read(reader)?;
    // Writers truncate longer lengths to 32 bits.
    let is_cut =
        !words.are_64_bit && expected > u64::from(u32::MAX) && length == expected & u64::from(u32::MAX);
    if length == expected || is_cut {
        return Ok(());
    }
    Err(invalid_data(format!("{expected} bytes were expected, the file announces {length}")))
}

/// Reader of values in compressed blocks.
pub(super) struct CompressedBlocks<R> {
    reader: R,
    compressor: Compressor,
    /// Compressed sizes of the remaining blocks in reverse order, so that the next one is last.
    compressed: Vec<u64>,
    block_bytes: u64,
    last_bytes: u64,
    packed: Vec<u8>,
    ready: Cursor<Vec<u8>>,
}

impl<R: Read> CompressedBlocks<R> {
    /// Reads the table of blocks, which must expand to `expected` bytes; `room` is the number of bytes left in the
    /// file, where it is known.
    pub(super) fn open(
        mut reader: R,
        words: HeaderWords,
        compressor: Compressor,
        expected: u64,
        room: Option<u64>,
    ) -> io::Result<Self> {
        let count = words.read(&mut reader)?;
        let block_bytes = words.read(&mut reader)?;
        let partial = words.read(&mut reader)?;
        // A partial size of 0 means that the last block is complete.
        let last_bytes = if partial == 0 { block_bytes } else { partial };
        let total = count
            .checked_sub(1)
            .and_then(|whole| whole.checked_mul(block_bytes))
            .and_then(|bytes| bytes.checked_add(last_bytes));
        if total != Some(expected) || last_bytes > block_bytes {
            return Err(invalid_data(format!(
                "{expected} bytes were expected, the file announces {count} blocks of {block_bytes} bytes, the last \
                 of {last_bytes}"
            )));
        }
        if block_bytes > MAX_BLOCK_BYTES {
            return Err(invalid_data(format!(
                "its blocks of {block_bytes} bytes are larger than the {MAX_BLOCK_BYTES} that are supported"
            )));
        }
        // A table larger than the data is implausible, except for very small data.
        if count.saturating_mul(8) > expected.max(1 << 16) {
            return Err(invalid_data(format!("its {count} blocks of {block_bytes} bytes are too small")));
        }
        let mut compressed = Vec::new();
        for _ in 0..count {
            let bytes = words.read(&mut reader)?;
            // Neither scheme expands incompressible data beyond this.
            if bytes > block_bytes.saturating_add(block_bytes / 8).saturating_add(1024) {
                return Err(invalid_data(format!(
                    "a block of {block_bytes} bytes cannot take {bytes} bytes when compressed"
                )));
            }
            compressed.push(bytes);
        }
        let sum = compressed.iter().fold(0u64, |sum, &bytes| sum.saturating_add(bytes));
        if room.is_some_and(|room| room < sum) {
            return Err(invalid_data(format!(
                "the data are truncated: {sum} bytes of blocks expected, at most {} found",
                room.unwrap_or_default()
            )));
        }
        compressed.reverse();
        let (packed, ready) = (Vec::new(), Cursor::default());
        Ok(Self { reader, compressor, compressed, block_bytes, last_bytes, packed, ready })
    }

    /// Bytes in memory besides the volume: the longest compressed block, and an unpacked one.
    pub(super) fn needed_bytes(&self) -> u64 {
        let longest = self.compressed.iter().copied().max().unwrap_or(0);
        // The last of several blocks is no longer than the others.
        let unpacked = if self.compressed.len() == 1 { self.last_bytes } else { self.block_bytes };
        longest.saturating_add(unpacked)
    }

    /// Decompresses the next block.
    fn refill(&mut self) -> io::Result<()> {
        self.ready.set_position(0);
        let ready = self.ready.get_mut();
        ready.clear();
        let Some(bytes) = self.compressed.pop() else { return Ok(()) };
        let wanted = if self.compressed.is_empty() { self.last_bytes } else { self.block_bytes };
        let wanted = usize::try_from(wanted).map_err(|_too_large| invalid_data("a block is too large"))?;
        self.packed.clear();
        let found = self.reader.by_ref().take(bytes).read_to_end(&mut self.packed)?;
        if (found as u64) < bytes {
            return Err(invalid_data("the data are truncated: they end within a block"));
        }
        let no_memory = || io::Error::from(io::ErrorKind::OutOfMemory);
        let unpacked = match self.compressor {
            Compressor::Zlib => {
                ready.try_reserve_exact(wanted + 1).map_err(|_full| no_memory())?;
                // One byte more than wanted distinguishes too much from enough.
                let mut decoder = ZlibDecoder::new(&self.packed[..]).take(wanted as u64 + 1);
                decoder.read_to_end(ready).map_err(|error| error.to_string())
            }
            // A byte of an LZ4 length adds at most 255 bytes.
            Compressor::Lz4 if self.packed.len().saturating_mul(255) < wanted => {
                Err(format!("{} bytes cannot expand to {wanted}", self.packed.len()))
            }
            Compressor::Lz4 => {
                // Zeroed pages are committed only as they are written: as much as the block really contains.
                *ready = try_zeroed_vec(wanted).map_err(|()| no_memory())?;
                lz4_flex::block::decompress_into(&self.packed, ready).map_err(|error| error.to_string())
            }
        };
        match unpacked {
            Ok(found) if found == wanted => Ok(()),
            Ok(found) => Err(invalid_data(format!("a block of {wanted} bytes expands to {found}"))),
            Err(why) => Err(invalid_data(format!("a compressed block is broken: {why}"))),
        }
    }
}

impl<R: Read> Read for CompressedBlocks<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.ready.position() == self.ready.get_ref().len() as u64 {
            self.refill()?;
        }
        self.ready.read(into)
    }
}
