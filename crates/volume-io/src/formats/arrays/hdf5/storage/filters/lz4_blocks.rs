//! LZ4 as the filter 32004 of HDF5 writes it: blocks with their lengths, most significant byte first.
//!
//! After <https://github.com/HDFGroup/hdf5_plugins>, `docs/RegisteredFilterPlugins.md`: the bytes without compression
//! (8 bytes), those of a block (4), and for each block its length (4) and its bytes, which are stored as they are where
//! they would not shrink.

use crate::reading::chunk_codecs::decode_lz4_block;

/// Decompresses to at most `limit` bytes.
pub(super) fn decode(bytes: &[u8], limit: usize) -> Result<Vec<u8>, String> {
    let short = || "the LZ4 data end too early".to_owned();
    let (total, rest) = bytes.split_first_chunk::<8>().ok_or_else(short)?;
    let (block, mut rest) = rest.split_first_chunk::<4>().ok_or_else(short)?;
    let (total, block) = (u64::from_be_bytes(*total), u32::from_be_bytes(*block) as usize);
    let Some(total) = usize::try_from(total).ok().filter(|&total| total <= limit) else {
        return Err(format!("the LZ4 data announce {total} bytes, at most {limit} were expected"));
    };
    if block == 0 {
        return Err("the LZ4 data have blocks of no bytes".to_owned());
    }
    let mut found = Vec::new();
    while found.len() < total {
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(short)?;
        let (packed, after) =
            after.split_at_checked(u32::from_be_bytes(*length) as usize).ok_or_else(short)?;
        rest = after;
        let expected = block.min(total - found.len());
        if packed.len() == expected {
            found.extend_from_slice(packed);
        } else {
            let plain = decode_lz4_block(packed, expected)?;
            if plain.len() != expected {
                return Err(format!("an LZ4 block has {} bytes, {expected} were expected", plain.len()));
            }
            found.extend_from_slice(&plain);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of four bytes, of which the second is stored as it is.
    fn packed(total: u64) -> Vec<u8> {
        let block = lz4_flex::block::compress(&[7; 40]);
        let head = [&total.to_be_bytes()[..], &40u32.to_be_bytes()].concat();
        let length = (block.len() as u32).to_be_bytes();
        [&head[..], &length, &block, &2u32.to_be_bytes(), &[1, 2]].concat()
    }

    #[test]
    fn blocks_are_joined_and_no_more_is_made() {
        let plain = decode(&packed(42), 42).unwrap();
        assert_eq!((plain.len(), &plain[38..]), (42, &[7, 7, 1, 2][..]));
        assert!(decode(&packed(42), 41).unwrap_err().contains("announce 42"));
        assert!(decode(&packed(u64::MAX), 99).is_err());
        assert!(decode(&packed(50), 99).is_err(), "a block is missing");
        for length in 0..packed(42).len() {
            assert!(decode(&packed(42)[..length], 42).is_err(), "{length}");
        }
    }
}
