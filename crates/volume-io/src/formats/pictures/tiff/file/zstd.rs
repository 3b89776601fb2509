//! Zstandard in strips and tiles (RFC 8878).
//!
//! A frame may announce a window of gigabytes, and any number of blocks. Neither is trusted: no more is unpacked at
//! once than a strip or tile can contain.

use std::io::{self, Read as _};

use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use crate::reading::samples::ReadFault;
use chiaroscuro_volume::LoadControl;

/// Maximum window size: that of libzstd's highest level, and the limit of its decoder by default
/// (`ZSTD_WINDOWLOG_LIMIT_DEFAULT`). Its memory is allocated only as it fills.
const MAX_WINDOW_BYTES: u64 = 128 << 20;

/// Maximum size of a block (RFC 8878, 3.1.1.2.4): amount unpacked between two checks for cancellation.
const BLOCK_BYTES: usize = 128 << 10;

/// Decodes a frame into `out`; returns the number of bytes. The frame of a last strip may have the `whole` length of
/// the others.
///
/// # Errors
/// `Long` for a frame that exceeds that; `Io` for a broken one, `Stopped` on cancellation.
pub(super) fn expand(
    mut packed: &[u8],
    whole: usize,
    out: &mut [u8],
    control: &LoadControl,
) -> Result<usize, ReadFault> {
    let broken = |error| ReadFault::Io(io::Error::other(error));
    let mut decoder = FrameDecoder::new();
    decoder.set_max_window_size(MAX_WINDOW_BYTES);
    decoder.init(&mut packed).map_err(broken)?;
    let (mut filled, mut unpacked) = (0, 0);
    let most = whole.max(out.len());
    loop {
        control.check().map_err(ReadFault::Stopped)?;
        // Bytes within the window become available only at the end of the frame.
        filled += decoder.read(&mut out[filled..]).map_err(ReadFault::Io)?;
        if filled == out.len() || decoder.is_finished() && decoder.can_collect() == 0 {
            return Ok(filled);
        }
        if unpacked > most {
            return Err(ReadFault::Long);
        }
        decoder.decode_blocks(&mut packed, BlockDecodingStrategy::UptoBytes(BLOCK_BYTES)).map_err(broken)?;
        unpacked += BLOCK_BYTES;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Builds a frame of blocks that each repeat a byte, which announces a window of `2^(10 + exponent)` bytes and no
    /// content size.
    fn repeated(exponent: u8, blocks: usize, is_ended: bool) -> Vec<u8> {
        let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd, 0, exponent << 3];
        for at in 0..blocks {
            let is_last = is_ended && at + 1 == blocks;
            // Block size, type 1 (run of a byte), and the flag of the last block.
            let header = (BLOCK_BYTES as u32) << 3 | 1 << 1 | u32::from(is_last);
            frame.extend(&header.to_le_bytes()[..3]);
            frame.push(7);
        }
        frame
    }

    fn expanded(packed: &[u8], most: usize) -> Result<usize, ReadFault> {
        expand(packed, 2 * BLOCK_BYTES, &mut vec![0; most], &LoadControl::new())
    }

    #[test]
    fn large_windows_are_not_allocated() {
        // The window of level 22.
        assert_eq!(expanded(&repeated(17, 3, true), 3 * BLOCK_BYTES).ok(), Some(3 * BLOCK_BYTES));
        assert_eq!(expanded(&repeated(17, 2, true), 1000).ok(), Some(1000), "what comes after is left alone");
        assert!(matches!(expanded(&repeated(18, 3, true), 1000), Err(ReadFault::Io(_))), "256 MiB");
    }

    #[test]
    fn overlong_frames_are_refused() {
        for exponent in [10, 17] {
            let endless = repeated(exponent, 20_000, true);
            // 2.4 GiB, of which no more than a strip is unpacked.
            assert!(matches!(expanded(&endless, 1000), Err(ReadFault::Long)), "{exponent}");
        }
        // With a window of one block, bytes become available before the end.
        assert_eq!(expanded(&repeated(7, 20_000, true), 1000).ok(), Some(1000));
        assert!(matches!(expanded(&repeated(10, 3, false), 1 << 20), Err(ReadFault::Io(_))), "cut off");
    }
}
