//! Fletcher's checksum of 32 bits after a chunk, as the HDF5 library computes it.

/// Returns the bytes without the checksum at their end, which must match.
pub(super) fn verified(mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    let Some((data, stored)) = bytes.split_last_chunk::<4>() else {
        return Err("its checksum is missing".to_owned());
    };
    let (stored, found) = (u32::from_le_bytes(*stored), checksum(data));
    // Versions before 1.6.3 swapped the bytes of each half.
    let swapped = found.swap_bytes().rotate_left(16);
    if stored != found && stored != swapped {
        return Err(format!("its checksum is {found:08x}, {stored:08x} was expected"));
    }
    bytes.truncate(bytes.len() - 4);
    Ok(bytes)
}

/// Sums of 16-bit numbers, most significant byte first, modulo 65535.
fn checksum(data: &[u8]) -> u32 {
    let fold = |sum: u32| (sum & 0xffff) + (sum >> 16);
    let (mut first, mut second) = (0u32, 0u32);
    let pairs = data.chunks_exact(2);
    let rest = pairs.remainder();
    let mut add = |word: u32| {
        first = fold(first + word);
        second = fold(second + first);
    };
    pairs.for_each(|pair| add(u32::from(pair[0]) << 8 | u32::from(pair[1])));
    if let Some(&byte) = rest.first() {
        add(u32::from(byte) << 8);
    }
    fold(second) << 16 | fold(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_compared_and_removed() {
        let data = b"abcdef";
        let with = |sum: u32| [&data[..], &sum.to_le_bytes()].concat();
        let sum = checksum(data);
        assert_eq!(verified(with(sum)).unwrap(), data);
        assert!(verified(with(sum ^ 1)).unwrap_err().contains("checksum"));
        assert!(verified(vec![1, 2]).is_err());
    }
}
