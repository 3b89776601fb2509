//! Entropy-coded scan data of JPEG (T.81 section F.2.2): from bytes to dequantised coefficients.

use super::{JpegBlock, JpegComponent, TRUNCATED};

/// Zigzag order of the coefficients of a block (T.81 figure A.6).
const ZIGZAG: [u8; 64] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7,
    14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39,
    46, 53, 60, 61, 54, 47, 55, 62, 63,
];

/// Huffman table with codes of 1 to 16 bits (T.81 annex C).
#[derive(Default)]
pub(super) struct HuffmanTable<'a> {
    /// For each code length, the first 16-bit word that begins with a longer code.
    limits: [u32; 16],
    /// Values of the codes, in order of the codes.
    values: &'a [u8],
}

impl<'a> HuffmanTable<'a> {
    /// Builds the table from its stored form; `None` if its codes do not fit in 16 bits.
    pub(super) fn new(table: &'a [u8]) -> Option<Self> {
        let (counts, values) = table.split_first_chunk::<16>()?;
        let (mut limits, mut limit) = ([0; 16], 0);
        for ((place, &count), length) in limits.iter_mut().zip(counts).zip(1..) {
            limit += u32::from(count) << (16 - length);
            *place = limit;
        }
        (limit <= 1 << 16).then_some(Self { limits, values })
    }
}

/// Bit reader of a scan, up to its next marker (T.81 section F.2.2.5).
#[derive(Default)]
pub(super) struct ScanBits<'a> {
    pub(super) rest: &'a [u8],
    /// Buffered bits that come next, left-aligned, zeros below them.
    pub(super) buffer: u32,
    /// Number of buffered bits, 0 to 32.
    pub(super) count: u32,
}

impl ScanBits<'_> {
    /// Returns the next 16 bits without consuming them; zeros beyond the end.
    fn peek_word(&mut self) -> u32 {
        while self.count < 16 {
            let (byte, after) = match self.rest {
                [0xff, 0, after @ ..] => (0xff, after),
                [0xff, ..] | [] => break,
                [byte, after @ ..] => (*byte, after),
            };
            self.buffer |= u32::from(byte) << (24 - self.count);
            self.count += 8;
            self.rest = after;
        }
        self.buffer >> 16
    }

    /// Consumes the next marker, after the bits that pad a byte (T.81 section B.1.1.2).
    pub(super) fn marker(&mut self) -> Option<u8> {
        let after = self.rest.strip_prefix(&[0xff]).filter(|_| self.count < 8)?;
        // Any number of fill bytes 0xff may precede a marker.
        let at = after.iter().position(|&byte| byte != 0xff)?;
        let (&marker, rest) = after.get(at..)?.split_first()?;
        *self = Self { rest, ..Self::default() };
        Some(marker)
    }

    /// Consumes up to 16 bits.
    fn take(&mut self, count: u8) -> Result<u32, String> {
        let bits = self.peek_word() >> (16 - count);
        self.count = self.count.checked_sub(count.into()).ok_or(TRUNCATED)?;
        self.buffer <<= count;
        Ok(bits)
    }

    /// Decodes the value of the next Huffman code (T.81 section F.2.2.3).
    fn decode_code(&mut self, codes: &HuffmanTable<'_>) -> Result<u8, String> {
        let word = self.peek_word();
        let (mut start, mut before) = (0, 0);
        for (&limit, length) in codes.limits.iter().zip(1..) {
            before += (word.min(limit) - start) >> (16 - length);
            if word < limit {
                self.take(length)?;
                let value = codes.values.get(before as usize);
                return Ok(*value.ok_or("a Huffman table is broken")?);
            }
            start = limit;
        }
        Err("a code is not in the Huffman table".to_owned())
    }

    /// Decodes a signed number of up to 15 bits (T.81 sections F.2.2.1 and F.2.2.4).
    fn decode_number(&mut self, size: u8) -> Result<i32, String> {
        let (number, end) = (self.take(size)? as i32, 1 << size);
        // The lower half of the range stands for negative numbers.
        Ok(if number < end / 2 { number + 1 - end } else { number })
    }

    /// Decodes a block (T.81 section F.2.2): dequantised coefficients, row by row.
    pub(super) fn decode_block(&mut self, part: &mut JpegComponent<'_>) -> Result<JpegBlock, String> {
        let mut block = [[0.0; 8]; 8];
        let mut places = ZIGZAG.iter().zip(&part.quantization_steps);
        let mut store = |zeros: u8, number: i32| {
            let (&place, step) = places.nth(zeros.into())?;
            *block.as_flattened_mut().get_mut(usize::from(place))? = f64::from(number) * step;
            Some(place)
        };
        let [dc_table, ac_table] = &part.huffman_tables;
        // Differences of DC coefficients have up to 15 bits, AC coefficients up to 14 (T.81 section F.1.5).
        let size = self.decode_code(dc_table)?;
        let size = Some(size).filter(|&size| size <= 15).ok_or("a DC difference has more than 15 bits")?;
        part.dc_predictor = part.dc_predictor.saturating_add(self.decode_number(size)?);
        let mut last = store(0, part.dc_predictor);
        // The last coefficient is at 63 in zigzag and in row order.
        while last.ok_or("a coefficient lies outside its block")? < 63 {
            let value = self.decode_code(ac_table)?;
            last = match (value >> 4, value & 15) {
                (0, 0) => break,
                (15, 0) => store(15, 0),
                (_, 0 | 15) => Err("an AC coefficient has more than 14 bits, or none")?,
                (zeros, size) => store(zeros, self.decode_number(size)?),
            };
        }
        Ok(block)
    }
}
