//! Decoder of packed PVM volumes (DDS): runs of differences, each run with as many bits as its largest difference
//! needs.
//!
//! A bit stream follows the magic, most significant bit first: 2 bits with the number of interleaved bytes less 1, 16
//! with the length of a line of voxels less 1, then runs. A run is 7 bits with its length, 3 with the width of a
//! difference, and the differences, offset by half their range. A run of length 0 ends the stream. A byte is its
//! predecessor, plus the slope of the line before at this place, plus the difference.

use std::io::Read;

use super::super::samples::{BLOCK_BYTES, Fault, fill, is_corruption};
use super::super::{LoadControl, LoadError};
use crate::data::attempt::{Attempt, human_bytes};

/// Magic bytes of the two versions. The first de-interleaves all bytes at once, the second in blocks of this size
/// times the number of interleaved bytes.
const MARK: &[u8] = b"DDS v3d\n";
const MARK_OF_BLOCKS: &[u8] = b"DDS v3e\n";
const BLOCK: usize = 1 << 24;

const HELP: &str = "copy or download the file again";

/// Returns true if content with this beginning is packed.
pub(super) fn is_packed(start: &[u8]) -> bool {
    start.starts_with(MARK) || start.starts_with(MARK_OF_BLOCKS)
}

/// Unpacks the whole content, to at most `most` bytes.
pub(super) fn unpack(
    attempt: Attempt<'_>,
    content: &mut dyn Read,
    most: u64,
    control: &LoadControl,
) -> Result<Vec<u8>, LoadError> {
    let mut bits = Bits { content, control, block: Vec::new(), at: 0, held: 0, count: 0 };
    let mut mark = [0; MARK.len()];
    bits.read(&mut mark)
        .and_then(|()| {
            let (bytes, interleaved) = differences(&mut bits, most)?;
            let block = if mark == MARK { bytes.len() } else { BLOCK.saturating_mul(interleaved) };
            in_order(bytes, interleaved, block, control)
        })
        .map_err(|fault| match fault {
            Fault::Stopped(error) => error,
            Fault::Long => attempt.limit(
                "data",
                format!("it unpacks to more than the {} that are allowed", human_bytes(u128::from(most))),
                "close other programs, or allow more memory",
            ),
            Fault::NoMemory => attempt.limit(
                "data",
                "the memory for what it unpacks to is not there",
                "close other programs or load a smaller volume",
            ),
            Fault::Io(error) if is_corruption(&error) => {
                attempt.bad_input("data", format!("the gzip data are broken: {error}"), HELP)
            }
            Fault::Io(error) => attempt.io(error),
            _ => attempt.bad_input("data", "the packed data are truncated", HELP),
        })
}

/// Decodes the differences; returns the bytes and the number of interleaved ones.
fn differences(bits: &mut Bits<'_>, most: u64) -> Result<(Vec<u8>, usize), Fault> {
    let interleaved = bits.take(2)? as usize + 1;
    let line = bits.take(16)? as usize + 1;
    let mut bytes: Vec<u8> = Vec::new();
    let mut last = 0u8;
    loop {
        let run = match bits.take(7) {
            // Some files lack the final run. Other missing data are noticed when voxels are counted.
            Err(Fault::Short { .. }) => 0,
            run => run? as usize,
        };
        if run == 0 {
            return Ok((bytes, interleaved));
        }
        // A width of 1 bit is never used: code 1 means 2 bits.
        let width = match bits.take(3)? {
            0 => 0,
            n => n + 1,
        };
        let half = (1u32 << width) / 2;
        if (bytes.len() + run) as u64 > most {
            return Err(Fault::Long);
        }
        if bytes.capacity() - bytes.len() < run {
            bytes.try_reserve(BLOCK_BYTES.max(bytes.len() / 2)).map_err(|_full| Fault::NoMemory)?;
        }
        for _ in 0..run {
            let difference = (bits.take(width)?.wrapping_sub(half)) as u8;
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
fn in_order(
    bytes: Vec<u8>,
    interleaved: usize,
    block: usize,
    control: &LoadControl,
) -> Result<Vec<u8>, Fault> {
    if interleaved == 1 || bytes.is_empty() {
        return Ok(bytes);
    }
    let mut ordered = Vec::new();
    ordered.try_reserve_exact(bytes.len()).map_err(|_full| Fault::NoMemory)?;
    ordered.resize(bytes.len(), 0);
    for (from, to) in bytes.chunks(block).zip(ordered.chunks_mut(block)) {
        let mut from = from.iter();
        for first in 0..interleaved {
            control.check().map_err(Fault::Stopped)?;
            for (to, &byte) in to.iter_mut().skip(first).step_by(interleaved).zip(&mut from) {
                *to = byte;
            }
        }
    }
    Ok(ordered)
}

/// Bit reader, most significant bit first.
struct Bits<'a> {
    content: &'a mut dyn Read,
    control: &'a LoadControl,
    block: Vec<u8>,
    at: usize,
    held: u64,
    count: u32,
}

impl Bits<'_> {
    /// Reads whole bytes, before any bits are taken.
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), Fault> {
        let got = fill(&mut self.content, bytes, self.control)?;
        if got < bytes.len() { Err(Fault::Short { got: 0 }) } else { Ok(()) }
    }

    /// Reads a number of at most 16 bits.
    fn take(&mut self, width: u32) -> Result<u32, Fault> {
        while self.count < width {
            if self.at == self.block.len() {
                self.block.resize(BLOCK_BYTES, 0);
                let got = fill(&mut self.content, &mut self.block, self.control)?;
                self.block.truncate(got);
                self.at = 0;
            }
            let byte = *self.block.get(self.at).ok_or(Fault::Short { got: 0 })?;
            self.at += 1;
            self.held = self.held << 8 | u64::from(byte);
            self.count += 8;
        }
        self.count -= width;
        Ok((self.held >> self.count) as u32 & ((1 << width) - 1))
    }
}
