//! Encoding of chunks: little-endian numbers in Zstandard frames.

use ruzstd::encoding::{CompressionLevel, compress_to_vec};

/// Bytes of a frame before the window descriptor, and the bits of the frame descriptor that tell whether it states the
/// size of its content: neither a size nor a single segment.
const DESCRIPTOR_AT: usize = 4;
const SIZE_BITS: u8 = 0b1110_0000;

/// Frame descriptor bits of a content size of four bytes.
const SIZE_OF_FOUR_BYTES: u8 = 0b1000_0000;

/// Compresses a chunk.
pub(super) fn compress_chunk(bytes: &[u8]) -> Vec<u8> {
    with_content_size(compress_to_vec(bytes, CompressionLevel::Fastest), bytes.len())
}

/// Adds the size of its content to a frame that does not state it, as readers that allocate memory beforehand need it.
fn with_content_size(mut frame: Vec<u8>, bytes: usize) -> Vec<u8> {
    let after_window = DESCRIPTOR_AT + 2;
    let size = u32::try_from(bytes).ok();
    if let Some(size) = size
        && frame.get(DESCRIPTOR_AT).is_some_and(|descriptor| descriptor & SIZE_BITS == 0)
    {
        frame[DESCRIPTOR_AT] |= SIZE_OF_FOUR_BYTES;
        frame.splice(after_window..after_window, size.to_le_bytes());
    }
    frame
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reading::chunk_codecs::decode_zstd;

    #[test]
    fn frames_state_their_size_and_come_back() {
        let mixed = |at: usize| (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).to_le_bytes()[5];
        for length in [0, 1, 7, 1000, 131_072, 300_000] {
            for bytes in [
                vec![3; length],
                (0..length).map(mixed).collect(),
                (0..length).map(|at| (at / 100) as u8).collect(),
                (0..length).map(|at| mixed(at) & 7).collect::<Vec<u8>>(),
            ] {
                let frame = compress_chunk(&bytes);
                assert_eq!(frame[6..10], (length as u32).to_le_bytes());
                assert_eq!(decode_zstd(&frame, length).unwrap(), bytes);
                assert!(frame.len() <= length + 64);
            }
        }
    }
}
