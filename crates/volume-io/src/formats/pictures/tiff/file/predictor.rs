//! Undoing of TIFF predictors, byte order and bit packing, to little-endian numbers of whole bytes.

use super::page::TiffPage;
use crate::Endian;

/// Undoes predictor and byte order in the rows of a strip or tile; `samples` is the number of interleaved components.
pub(super) fn undo_predictor(
    page: &TiffPage,
    endian: Endian,
    samples: usize,
    row_bytes: usize,
    part: &mut [u8],
) {
    let size = (page.bits / 8) as usize;
    let mut scratch = Vec::new();
    for row in part.chunks_exact_mut(row_bytes) {
        match page.predictor {
            2 => {
                to_little(row, size, endian);
                undo_differencing(row, size, samples);
            }
            // Predictor 3 orders bytes by significance, whatever the byte order of the file.
            3 => undo_float_predictor(row, size, samples, &mut scratch),
            _ => to_little(row, size, endian),
        }
    }
}

fn to_little(row: &mut [u8], size: usize, endian: Endian) {
    if endian == Endian::Big && size > 1 {
        row.chunks_exact_mut(size).for_each(<[u8]>::reverse);
    }
}

/// Undoes horizontal differencing (TIFF 6.0, section 14): each number is the difference to its predecessor;
/// floating-point numbers as bit patterns.
fn undo_differencing(row: &mut [u8], size: usize, samples: usize) {
    macro_rules! add {
        ($type:ty) => {{
            const SIZE: usize = size_of::<$type>();
            let number = |bytes: &[u8]| {
                let mut array = [0; SIZE];
                array.copy_from_slice(bytes);
                <$type>::from_le_bytes(array)
            };
            let step = SIZE * samples;
            for at in (step..(row.len() / SIZE) * SIZE).step_by(SIZE) {
                let sum = number(&row[at..at + SIZE]).wrapping_add(number(&row[at - step..at - step + SIZE]));
                row[at..at + SIZE].copy_from_slice(&sum.to_le_bytes());
            }
        }};
    }
    match size {
        1 => add!(u8),
        2 => add!(u16),
        4 => add!(u32),
        8 => add!(u64),
        _ => {}
    }
}

/// Undoes the floating-point predictor (TIFF Technical Note 3): planes of bytes, the most significant first, stored
/// as differences.
fn undo_float_predictor(row: &mut [u8], size: usize, samples: usize, scratch: &mut Vec<u8>) {
    for at in samples..row.len() {
        row[at] = row[at].wrapping_add(row[at - samples]);
    }
    scratch.clear();
    scratch.extend_from_slice(row);
    let count = row.len() / size.max(1);
    for (at, number) in row.chunks_exact_mut(size.max(1)).enumerate() {
        for (weight, byte) in number.iter_mut().rev().enumerate() {
            *byte = scratch[weight * count + at];
        }
    }
}

/// Widens numbers of fewer than 8 or 16 bits to one or two bytes. They are packed from the most significant bit; rows
/// begin at whole bytes.
pub(super) fn unpack_bits(packed: &[u8], bits: u64, count: usize, wide: &mut Vec<u8>) {
    let (mut held, mut held_bits) = (0u32, 0u64);
    let mut bytes = packed.iter();
    for _ in 0..count {
        while held_bits < bits {
            held = held << 8 | u32::from(bytes.next().copied().unwrap_or(0));
            held_bits += 8;
        }
        held_bits -= bits;
        let number = (held >> held_bits) & ((1 << bits) - 1);
        held &= (1 << held_bits) - 1;
        wide.extend_from_slice(&number.to_le_bytes()[..if bits > 8 { 2 } else { 1 }]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_few_bits_are_widened() {
        let widened = |packed: &[u8], bits, count| {
            let mut wide = Vec::new();
            unpack_bits(packed, bits, count, &mut wide);
            wide
        };
        assert_eq!(widened(&[0b1010_0000], 1, 3), [1, 0, 1]);
        assert_eq!(widened(&[0x1F, 0x30], 4, 3), [1, 15, 3]);
        assert_eq!(widened(&[0xAB, 0xC1, 0x23], 12, 2), [0xBC, 0x0A, 0x23, 0x01]);
        assert_eq!(widened(&[], 12, 1), [0, 0], "what is not there is 0");
    }
}
