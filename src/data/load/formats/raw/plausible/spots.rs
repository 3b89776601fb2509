//! Pieces of the file, where something is to be seen.

use std::io;

use super::super::bytes::RawBytes;

/// Places that are looked at.
const PLACES: u64 = 64;

/// Bytes that are looked at in each place, to see whether anything is there.
const GLANCE: usize = 4 << 10;

/// Places that are read: more than these tell nothing more.
const SPOTS: usize = 16;

/// Bytes of each: rows of 4096 voxels of 8 bytes, and as many neighbours beside each of them.
const SPOT_BYTES: usize = 64 << 10;

/// A piece of the file.
#[derive(Debug)]
pub(super) struct Spot {
    /// Its first byte's place in the file.
    pub(super) at: u64,
    pub(super) bytes: Vec<u8>,
}

/// Pieces of the file, in its order.
#[derive(Debug)]
pub(super) struct Spots(pub(super) Vec<Spot>);

impl Spots {
    /// Reads pieces from everywhere in a file, rather where its bytes change from one stretch to the next: padding says
    /// nothing.
    pub(super) fn read(bytes: &mut RawBytes) -> io::Result<Self> {
        let length = bytes.readable();
        let mut glances = Vec::new();
        let mut glance = vec![0; GLANCE];
        let room = length.saturating_sub(SPOT_BYTES as u64);
        // Of a small file all is read, in pieces that overlap.
        let places = PLACES.min(length.div_ceil(SPOT_BYTES as u64)).max(1);
        for place in 0..places {
            let at = match places {
                1 => 0,
                // From the first byte to the last, at odd places: steps must not fall into step with rows.
                _ => (room * place / (places - 1)).saturating_sub(place % 7 * 61),
            };
            let middle = at + (SPOT_BYTES as u64).min(length) / 2;
            let count = bytes.read_at(middle, &mut glance)?;
            glances.push((at, unrest(&glance[..count])));
        }
        glances.sort_by(|a, b| b.1.total_cmp(&a.1));
        glances.truncate(SPOTS);
        glances.sort_by_key(|glance| glance.0);
        let mut spots = Vec::new();
        for (at, _) in glances {
            let mut piece = vec![0; SPOT_BYTES.min(length as usize)];
            let count = bytes.read_at(at, &mut piece)?;
            piece.truncate(count);
            spots.push(Spot { at, bytes: piece });
        }
        Ok(Self(spots))
    }
}

/// How much the means of short stretches of bytes differ, apart from what noise does to them. The stretches are of 64
/// bytes, a multiple of every number's size.
pub(super) fn unrest(bytes: &[u8]) -> f64 {
    let means: Vec<f64> = bytes
        .chunks_exact(64)
        .map(|part| part.iter().map(|&byte| f64::from(byte)).sum::<f64>() / 64.0)
        .collect();
    let count = means.len().max(1) as f64;
    let mean = means.iter().sum::<f64>() / count;
    means.iter().map(|part| (part - mean) * (part - mean)).sum::<f64>() / count
}
