//! Adapter that turns numbers written as text into bytes, so that readers of binary voxels read text too.

use std::io::{self, BufRead, Cursor, Read};

use super::number::Number;
use crate::data::attempt::quoted;

/// Maximum length of a number, in bytes. A full decimal f64 needs about 25.
const LONGEST_NUMBER: usize = 400;

/// Bytes that are produced at a time.
const BLOCK_BYTES: usize = 1 << 16;

/// Reader that converts numbers separated by white space to little-endian bytes.
///
/// Text that is not a number, or that does not fit the type, is an error of the kind `InvalidData`.
pub(in crate::data::load) struct TextNumbers<R> {
    reader: R,
    number: Number,
    /// Numbers still to be read: something else may follow them.
    left: u64,
    /// True if bytes are written as fractions from 0 to 1.
    are_shares: bool,
    ready: Cursor<Vec<u8>>,
}

impl<R: BufRead> TextNumbers<R> {
    /// Creates a reader of the next `count` numbers.
    pub(in crate::data::load) fn new(reader: R, number: Number, count: u64) -> Self {
        Self { reader, number, left: count, are_shares: false, ready: Cursor::default() }
    }

    /// Creates a reader of the next `count` bytes, each written as a fraction from 0 to 1.
    pub(in crate::data::load) fn of_shares(reader: R, count: u64) -> Self {
        Self { are_shares: true, ..Self::new(reader, Number::U8, count) }
    }

    fn refill(&mut self) -> io::Result<()> {
        self.ready.set_position(0);
        let ready = self.ready.get_mut();
        ready.clear();
        let mut word = Vec::new();
        while self.left > 0 && ready.len() < BLOCK_BYTES && next_word(&mut self.reader, &mut word)? {
            let text = String::from_utf8_lossy(&word);
            let is_number = if self.are_shares {
                // The cast turns NaN into 0.
                float(&text).map(|share| ready.push((share * 255.0).round() as u8)).is_some()
            } else {
                add_bytes(self.number, &text, ready)
            };
            if !is_number {
                let name = name(self.number);
                let why = format!("a number of type {name} was expected, {} was found", quoted(&text));
                return Err(io::Error::new(io::ErrorKind::InvalidData, why));
            }
            self.left -= 1;
        }
        Ok(())
    }
}

impl<R: BufRead> Read for TextNumbers<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.ready.position() == self.ready.get_ref().len() as u64 {
            self.refill()?;
        }
        self.ready.read(into)
    }
}

/// Reads the next word and the byte after it; returns false at the end.
///
/// # Errors
/// `InvalidData` where it is longer than any number.
pub(in crate::data::load) fn next_word(reader: &mut impl BufRead, word: &mut Vec<u8>) -> io::Result<bool> {
    word.clear();
    loop {
        let block = match reader.fill_buf() {
            Ok(block) => block,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        if block.is_empty() {
            return Ok(!word.is_empty());
        }
        let start = if word.is_empty() {
            block.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(block.len())
        } else {
            0
        };
        let end = block[start..].iter().position(u8::is_ascii_whitespace).map(|length| start + length);
        word.extend(&block[start..end.unwrap_or(block.len()).min(start + LONGEST_NUMBER + 1)]);
        if word.len() > LONGEST_NUMBER {
            let why = format!("{} is longer than any number", quoted(&String::from_utf8_lossy(word)));
            return Err(io::Error::new(io::ErrorKind::InvalidData, why));
        }
        let used = end.map_or(block.len(), |end| end + 1);
        reader.consume(used);
        if end.is_some() {
            return Ok(true);
        }
    }
}

/// Appends the bytes of a number; returns false if the text is not one.
fn add_bytes(number: Number, text: &str, bytes: &mut Vec<u8>) -> bool {
    macro_rules! whole {
        ($type:ty) => {
            // Some programs write integers as 3.0 or 1e2.
            text.parse::<$type>()
                .ok()
                .or_else(|| {
                    let value = text.parse::<f64>().ok()?;
                    // Beyond 2⁵³ not every integer has a double of its own.
                    let is_exact = value.fract() == 0.0 && value.abs() <= 9007199254740992.0;
                    let within = value >= <$type>::MIN as f64 && value <= <$type>::MAX as f64;
                    (is_exact && within).then_some(value as $type)
                })
                .map(|value| bytes.extend(value.to_le_bytes()))
        };
    }
    match number {
        Number::U8 => whole!(u8),
        Number::I8 => whole!(i8),
        Number::U16 => whole!(u16),
        Number::I16 => whole!(i16),
        Number::U32 => whole!(u32),
        Number::I32 => whole!(i32),
        Number::U64 => whole!(u64),
        Number::I64 => whole!(i64),
        Number::F16 => float(text).map(|value| bytes.extend(half::f16::from_f64(value).to_le_bytes())),
        // Directly, not through f64: rounding twice can give another number.
        Number::F32 => text
            .parse::<f32>()
            .ok()
            .or_else(|| float(text).map(|value| value as f32))
            .map(|value| bytes.extend(value.to_le_bytes())),
        Number::F64 => float(text).map(|value| bytes.extend(value.to_le_bytes())),
    }
    .is_some()
}

/// Parses a number, or NaN as C libraries write it: `-nan`, `nan(ind)`, `-nan(0x7fffff)`.
fn float(text: &str) -> Option<f64> {
    let is_nan = || {
        let text = text.trim_start_matches(['-', '+']);
        text.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("nan("))
            || text.eq_ignore_ascii_case("nan")
    };
    text.parse().ok().or_else(|| is_nan().then_some(f64::NAN))
}

/// Name of a number type in messages.
fn name(number: Number) -> &'static str {
    match number {
        Number::U64 => "uint64",
        Number::I64 => "int64",
        Number::F16 => "float16",
        other => other.voxel_type().name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(number: Number, text: &str, count: u64) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        // A small buffer, so that words are split between blocks.
        let reader = io::BufReader::with_capacity(3, text.as_bytes());
        TextNumbers::new(reader, number, count).read_to_end(&mut bytes).map(|_count| bytes)
    }

    #[test]
    fn numbers_of_each_type_become_bytes() {
        assert_eq!(bytes(Number::U8, " 1\n255 3.0 9", 3).unwrap(), [1, 255, 3], "no more than asked for");
        assert_eq!(bytes(Number::I8, "-128 127", 2).unwrap(), [128, 127]);
        assert_eq!(bytes(Number::U16, "65535", 1).unwrap(), [255, 255]);
        assert_eq!(bytes(Number::I16, "-2", 1).unwrap(), (-2i16).to_le_bytes());
        assert_eq!(bytes(Number::U32, "4294967295", 1).unwrap(), [255; 4]);
        assert_eq!(bytes(Number::I32, "-7", 1).unwrap(), (-7i32).to_le_bytes());
        assert_eq!(bytes(Number::U64, "18446744073709551615", 1).unwrap(), [255; 8]);
        assert_eq!(bytes(Number::I64, "-9223372036854775808", 1).unwrap(), i64::MIN.to_le_bytes());
        assert_eq!(bytes(Number::F16, "0.5", 1).unwrap(), half::f16::from_f32(0.5).to_le_bytes());
        assert_eq!(bytes(Number::F32, "1e-3", 1).unwrap(), 1e-3f32.to_le_bytes());
        assert_eq!(bytes(Number::F64, "-0.1\r\n7", 2).unwrap()[..8], (-0.1f64).to_le_bytes());
        let nan = bytes(Number::F32, "-nan", 1).unwrap();
        assert!(f32::from_le_bytes(nan.try_into().unwrap()).is_nan());
        assert_eq!(bytes(Number::U8, "1 2", 5).unwrap(), [1, 2], "fewer than asked for");
        let mut shares = Vec::new();
        TextNumbers::of_shares(&b"0 0.5 1 7 -1"[..], 5).read_to_end(&mut shares).unwrap();
        assert_eq!(shares, [0, 128, 255, 255, 0]);
    }

    #[test]
    fn what_is_no_number_is_named() {
        for (number, text) in [
            (Number::U8, "256"),
            (Number::U8, "-1"),
            (Number::I16, "1.5"),
            (Number::U64, "1e30"),
            (Number::F32, "eight"),
            (Number::F64, "nanometre"),
        ] {
            let error = bytes(number, text, 1).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::InvalidData);
            assert!(error.to_string().contains(text), "{error}");
        }
        assert!(bytes(Number::F64, &"1".repeat(500), 1).unwrap_err().to_string().contains("longer"));
    }
}
