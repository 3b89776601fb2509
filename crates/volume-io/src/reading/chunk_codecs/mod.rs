//! Decoders of the compressed chunks of arrays, as Zarr and HDF5 store them.
//!
//! None of them makes more bytes than its caller expects, so that a bomb costs no more memory than an honest chunk. They poll [`CancelToken::current`](chiaroscuro_volume::CancelToken).
//! Errors are the cause alone; the caller adds file, chunk and advice.

mod bit_shuffle;
mod blosc;
mod blosclz;
mod checksum;
mod lz4;
mod stream;

pub(crate) use bit_shuffle::bit_unshuffle;
pub(crate) use blosc::decode_blosc;
pub(crate) use checksum::crc32c;
pub(crate) use lz4::{decode_lz4_block, decode_lz4_with_length};
pub(crate) use stream::{decode_bzip2, decode_gzip, decode_zlib, decode_zstd};

/// Bytes that are decompressed between two polls for cancellation.
const PIECE_BYTES: usize = 1 << 20;

/// Cause of a chunk that was not decoded because the work was cancelled; its caller reports that instead.
const STOPPED: &str = "decoding was cancelled";

/// Reverses the byte shuffle of elements of `size` bytes: all first bytes, all second bytes, and so on. Bytes after the
/// last whole element are not shuffled.
pub(crate) fn unshuffle(bytes: &[u8], size: usize) -> Vec<u8> {
    if size < 2 {
        return bytes.to_vec();
    }
    let count = bytes.len() / size;
    let mut out = vec![0; bytes.len()];
    let whole = count * size;
    // Sizes of numbers apart, so that the compiler can vectorise the copies.
    match size {
        2 => interleave::<2>(&bytes[..whole], &mut out[..whole]),
        4 => interleave::<4>(&bytes[..whole], &mut out[..whole]),
        8 => interleave::<8>(&bytes[..whole], &mut out[..whole]),
        _ => {
            for (at, element) in out[..whole].chunks_exact_mut(size).enumerate() {
                for (byte, out) in element.iter_mut().enumerate() {
                    *out = bytes[byte * count + at];
                }
            }
        }
    }
    out[whole..].copy_from_slice(&bytes[whole..]);
    out
}

/// Interleaves `N` streams of equal length.
fn interleave<const N: usize>(bytes: &[u8], out: &mut [u8]) {
    let count = bytes.len() / N;
    let streams: [&[u8]; N] = std::array::from_fn(|byte| &bytes[byte * count..(byte + 1) * count]);
    let (elements, _) = out.as_chunks_mut::<N>();
    for (at, element) in elements.iter_mut().enumerate() {
        *element = std::array::from_fn(|byte| streams[byte][at]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shuffled_bytes_return_to_their_elements() {
        for size in [1, 2, 3, 4, 8, 16] {
            let plain: Vec<u8> = (0..=size * 7).map(|at| (at * 37 % 251) as u8).collect();
            let mut shuffled = Vec::new();
            for byte in 0..size {
                shuffled.extend((0..7).map(|element| plain[element * size + byte]));
            }
            shuffled.push(plain[size * 7]);
            assert_eq!(unshuffle(&shuffled, size), plain, "{size} bytes");
        }
    }
}
