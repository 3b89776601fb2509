//! Sample blocks of a raw file, chosen where the content varies.

use std::io;

use super::super::bytes::RawBytes;

/// Number of places that are examined.
const EXAMINED_PLACES: u64 = 64;

/// Bytes that are examined at each place, to see whether the content varies.
const EXAMINED_BYTES: usize = 4 << 10;

/// Maximum number of blocks that are read: more add no information.
const MAX_BLOCKS: usize = 16;

/// Bytes of a block: rows of 4096 voxels of 8 bytes, with as many neighbours.
const SPOT_BYTES: usize = 64 << 10;

/// Block of consecutive bytes of the file.
#[derive(Debug)]
pub(super) struct SampleBlock {
    /// Offset of its first byte in the file.
    pub(super) at: u64,
    pub(super) bytes: Vec<u8>,
}

/// Sample blocks in file order.
#[derive(Debug)]
pub(super) struct SampleBlocks(pub(super) Vec<SampleBlock>);

impl SampleBlocks {
    /// Reads blocks from all over a file, preferably where the content varies: padding carries no information.
    pub(super) fn read(bytes: &mut RawBytes) -> io::Result<Self> {
        let length = bytes.readable();
        let mut glances = Vec::new();
        let mut glance = vec![0; EXAMINED_BYTES];
        let room = length.saturating_sub(SPOT_BYTES as u64);
        // A small file is read as a whole, in overlapping blocks.
        let places = EXAMINED_PLACES.min(length.div_ceil(SPOT_BYTES as u64)).max(1);
        for place in 0..places {
            let at = match places {
                1 => 0,
                // From the first byte to the last, with irregular steps, so that they do not coincide with rows.
                _ => (room * place / (places - 1)).saturating_sub(place % 7 * 61),
            };
            let middle = at + (SPOT_BYTES as u64).min(length) / 2;
            let count = bytes.read_at(middle, &mut glance)?;
            glances.push((at, variation(&glance[..count])));
        }
        glances.sort_by(|a, b| b.1.total_cmp(&a.1));
        glances.truncate(MAX_BLOCKS);
        glances.sort_by_key(|glance| glance.0);
        let mut spots = Vec::new();
        for (at, _) in glances {
            let mut piece = vec![0; SPOT_BYTES.min(length as usize)];
            let count = bytes.read_at(at, &mut piece)?;
            piece.truncate(count);
            spots.push(SampleBlock { at, bytes: piece });
        }
        Ok(Self(spots))
    }
}

/// Variance of the means of short runs of bytes, which noise hardly affects. Runs have 64 bytes, a multiple of every
/// number's size.
pub(super) fn variation(bytes: &[u8]) -> f64 {
    let means: Vec<f64> = bytes
        .chunks_exact(64)
        .map(|part| part.iter().map(|&byte| f64::from(byte)).sum::<f64>() / 64.0)
        .collect();
    let count = means.len().max(1) as f64;
    let mean = means.iter().sum::<f64>() / count;
    means.iter().map(|part| (part - mean) * (part - mean)).sum::<f64>() / count
}
