//! Decoder of packed PVM volumes (DDS): runs of differences, each run with as many bits as its largest difference
//! needs.
//!
//! A bit stream follows the magic, most significant bit first: 2 bits with the number of interleaved bytes less 1, 16
//! with the length of a line of voxels less 1, then runs. A run is 7 bits with its length, 3 with the width of a
//! difference, and the differences, offset by half their range. A run of length 0 ends the stream. A byte is its
//! predecessor, plus the slope of the line before at this place, plus the difference.

use std::io::Read;

use super::super::samples::{BLOCK_BYTES, ReadFault, is_corruption, read_until_full};
use super::super::{LoadControl, LoadError};
use chiaroscuro_volume::{LoadContext, human_bytes};

/// Magic bytes of the two versions. The first de-interleaves all bytes at once, the second in blocks of this size
/// times the number of interleaved bytes.
const MAGIC: &[u8] = b"DDS v3d\n";
const BLOCK_MAGIC: &[u8] = b"DDS v3e\n";
const BLOCK: usize = 1 << 24;

const HELP: &str = "copy or download the file again";

/// Returns true if content with this beginning is packed.
pub(super) fn is_packed(start: &[u8]) -> bool {
    start.starts_with(MAGIC) || start.starts_with(BLOCK_MAGIC)
}

/// Unpacks the whole content, to at most `most` bytes.
pub(super) fn unpack(
    context: LoadContext<'_>,
    content: &mut dyn Read,
    most: u64,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let mut bits = DdsBitReader { content, control, block: Vec::new(), at: 0, buffer: 0, count: 0 };
    let mut mark = [0; MAGIC.len()];
    bits.read(&mut mark)
        .and_then(|()| {
            let (bytes, interleaved) = decode_differences(&mut bits, most)?;
            let block = if mark == MAGIC { bytes.len() } else { BLOCK.saturating_mul(interleaved) };
            interleave(bytes, interleaved, block, control)
        })
        .map_err(|fault| match fault {
            ReadFault::Stopped(error) => error,
            ReadFault::Long => context.limit_error(
                "data",
                format!("it unpacks to more than the {} that are allowed", human_bytes(u128::from(most))),
                "close other programs, or allow more memory",
            ),
            ReadFault::NoMemory => context.limit_error(
                "data",
                "there is not enough memory for the unpacked data",
                "close other programs or load a smaller volume",
            ),
            ReadFault::Io(error) if is_corruption(&error) => {
                context.bad_input_error("data", format!("the gzip data are broken: {error}"), HELP)
            }
            ReadFault::Io(error) => context.io_error(error),
            _ => context.bad_input_error("data", "the packed data are truncated", HELP),
        })
}

/// Decodes the differences; returns the bytes and the number of interleaved ones.
fn decode_differences(bits: &mut DdsBitReader<'_>, most: u64) -> Result<(Vec<u8>, usize), ReadFault> {
    let interleaved = bits.read_bits(2)? as usize + 1;
    let line = bits.read_bits(16)? as usize + 1;
    let mut bytes: Vec<u8> = Vec::new();
    let mut last = 0u8;
    loop {
        let run = match bits.read_bits(7) {
            // Some files lack the final run. Other missing data are noticed when voxels are counted.
            Err(ReadFault::Short { .. }) => 0,
            run => run? as usize,
        };
        if run == 0 {
            return Ok((bytes, interleaved));
        }
        // A width of 1 bit is never used: code 1 means 2 bits.
        let width = match bits.read_bits(3)? {
            0 => 0,
            n => n + 1,
        };
        let half = (1u32 << width) / 2;
        if (bytes.len() + run) as u64 > most {
            return Err(ReadFault::Long);
        }
        if bytes.capacity() - bytes.len() < run {
            bytes.try_reserve(BLOCK_BYTES.max(bytes.len() / 2)).map_err(|_full| ReadFault::NoMemory)?;
        }
        for _ in 0..run {
            let difference = (bits.read_bits(width)?.wrapping_sub(half)) as u8;
            let at = bytes.len();
            // The previous line has a slope here from its second byte on.
            let slope =
                if line > 1 && at > line { bytes[at - line].wrapping_sub(bytes[at - line - 1]) } else { 0 };
            last = last.wrapping_add(slope).wrapping_add(difference);
            bytes.push(last);
        }
    }
}

/// Interleaves the bytes of voxels again: in each block all first bytes come first, then all second ones.
fn interleave(
    bytes: Vec<u8>,
    interleaved: usize,
    block: usize,
    control: &LoadControl,
) -> Result<Vec<u8>, ReadFault> {
    if interleaved == 1 || bytes.is_empty() {
        return Ok(bytes);
    }
    let mut ordered = Vec::new();
    ordered.try_reserve_exact(bytes.len()).map_err(|_full| ReadFault::NoMemory)?;
    ordered.resize(bytes.len(), 0);
    for (from, to) in bytes.chunks(block).zip(ordered.chunks_mut(block)) {
        let mut from = from.iter();
        for first in 0..interleaved {
            control.check().map_err(ReadFault::Stopped)?;
            for (to, &byte) in to.iter_mut().skip(first).step_by(interleaved).zip(&mut from) {
                *to = byte;
            }
        }
    }
    Ok(ordered)
}

/// Bit reader, most significant bit first.
struct DdsBitReader<'a> {
    content: &'a mut dyn Read,
    control: &'a LoadControl,
    block: Vec<u8>,
    at: usize,
    buffer: u64,
    count: u32,
}

impl DdsBitReader<'_> {
    /// Reads whole bytes, before any bits are taken.
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), ReadFault> {
        let got = read_until_full(&mut self.content, bytes, self.control)?;
        if got < bytes.len() { Err(ReadFault::Short { got: 0 }) } else { Ok(()) }
    }

    /// Reads a number of at most 16 bits.
    fn read_bits(&mut self, width: u32) -> Result<u32, ReadFault> {
        while self.count < width {
            if self.at == self.block.len() {
                self.block.resize(BLOCK_BYTES, 0);
                let got = read_until_full(&mut self.content, &mut self.block, self.control)?;
                self.block.truncate(got);
                self.at = 0;
            }
            let byte = *self.block.get(self.at).ok_or(ReadFault::Short { got: 0 })?;
            self.at += 1;
            self.buffer = self.buffer << 8 | u64::from(byte);
            self.count += 8;
        }
        self.count -= width;
        Ok((self.buffer >> self.count) as u32 & ((1 << width) - 1))
    }
}
