//! Bit shuffle: bits of the same significance of all elements lie together.
//!
//! After K. Masui et al., "A compression scheme for radio data in high performance computing", Astronomy and Computing 12
//! (2015), section 3: rows of one bit of each element, in the order of the elements' bytes in memory, lowest bit first.

/// Reverses the bit shuffle of elements of `size` bytes. Only whole groups of eight elements are shuffled; what follows
/// them is not.
pub(crate) fn bit_unshuffle(bytes: &[u8], size: usize) -> Vec<u8> {
    let groups = bytes.len().checked_div(size).unwrap_or(0) / 8;
    let whole = groups * 8 * size;
    let mut out = vec![0; bytes.len()];
    for byte in 0..size {
        let rows: [&[u8]; 8] = std::array::from_fn(|bit| {
            let row = byte * 8 + bit;
            &bytes[row * groups..(row + 1) * groups]
        });
        for group in 0..groups {
            let packed = u64::from_le_bytes(rows.map(|row| row[group]));
            for (element, value) in transpose_bits(packed).to_le_bytes().into_iter().enumerate() {
                out[(group * 8 + element) * size + byte] = value;
            }
        }
    }
    out[whole..].copy_from_slice(&bytes[whole..]);
    out
}

/// Transposes a matrix of 8 × 8 bits, whose rows are bytes: in three steps, each of which exchanges blocks of 1, 2 and 4
/// bits beside the diagonal (H. S. Warren, Hacker's Delight, section 7-3).
fn transpose_bits(matrix: u64) -> u64 {
    let exchange = |matrix: u64, mask: u64, shift: u32| {
        let differing = (matrix ^ (matrix >> shift)) & mask;
        matrix ^ differing ^ (differing << shift)
    };
    let matrix = exchange(matrix, 0x00AA_00AA_00AA_00AA, 7);
    let matrix = exchange(matrix, 0x0000_CCCC_0000_CCCC, 14);
    exchange(matrix, 0x0000_0000_F0F0_F0F0, 28)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shuffled_bits_return_to_their_elements() {
        for size in [1, 2, 4, 8] {
            let elements = 24;
            let plain: Vec<u8> = (0..=size * elements).map(|at| (at * 151 % 253) as u8).collect();
            let mut shuffled = Vec::new();
            for byte in 0..size {
                for bit in 0..8 {
                    for group in 0..elements / 8 {
                        let bits = (0..8).map(|at| (plain[(group * 8 + at) * size + byte] >> bit & 1) << at);
                        shuffled.push(bits.sum());
                    }
                }
            }
            shuffled.push(plain[size * elements]);
            assert_eq!(bit_unshuffle(&shuffled, size), plain, "{size} bytes");
        }
    }
}
