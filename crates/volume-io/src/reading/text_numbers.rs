//! Adapter that turns numbers written as text into bytes, so that readers of binary voxels read text too.

use std::io::{self, BufRead, Cursor, Read};

use super::number::FileNumberType;
use chiaroscuro_volume::quoted;

/// Maximum length of a number, in bytes. A full decimal f64 needs about 25.
const MAX_NUMBER: usize = 400;

/// Bytes that are produced at a time.
const BLOCK_BYTES: usize = 1 << 16;

/// Reader that converts numbers separated by white space to little-endian bytes.
///
/// Text that is not a number, or that does not fit the type, is an error of the kind `InvalidData`.
pub(crate) struct TextNumbers<R> {
    reader: R,
    number: FileNumberType,
    /// Numbers still to be read: something else may follow them.
    remaining: u64,
    /// True if bytes are written as fractions from 0 to 1.
    are_fractions: bool,
    ready: Cursor<Vec<u8>>,
}

impl<R: BufRead> TextNumbers<R> {
    /// Creates a reader of the next `count` numbers.
    pub(crate) fn new(reader: R, number: FileNumberType, count: u64) -> Self {
        Self { reader, number, remaining: count, are_fractions: false, ready: Cursor::default() }
    }

    /// Creates a reader of the next `count` bytes, each written as a fraction from 0 to 1.
    pub(crate) fn new_fractions(reader: R, count: u64) -> Self {
        Self { are_fractions: true, ..Self::new(reader, FileNumberType::U8, count) }
    }

    fn refill(&mut self) -> io::Result<()> {
        self.ready.set_position(0);
        let ready = self.ready.get_mut();
        ready.clear();
        let mut word = Vec::new();
        while self.remaining > 0 && ready.len() < BLOCK_BYTES && next_word(&mut self.reader, &mut word)? {
            let text = String::from_utf8_lossy(&word);
            let is_number = if self.are_fractions {
                // The cast turns NaN into 0.
                parse_float(&text).map(|share| ready.push((share * 255.0).round() as u8)).is_some()
            } else {
                push_number_bytes(self.number, &text, ready)
            };
            if !is_number {
                let name = number_type_name(self.number);
                let why = format!("a number of type {name} was expected, {} was found", quoted(&text));
                return Err(io::Error::new(io::ErrorKind::InvalidData, why));
            }
            self.remaining -= 1;
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
pub(crate) fn next_word(reader: &mut impl BufRead, word: &mut Vec<u8>) -> io::Result<bool> {
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
        word.extend(&block[start..end.unwrap_or(block.len()).min(start + MAX_NUMBER + 1)]);
        if word.len() > MAX_NUMBER {
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
fn push_number_bytes(number: FileNumberType, text: &str, bytes: &mut Vec<u8>) -> bool {
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
        FileNumberType::U8 => whole!(u8),
        FileNumberType::I8 => whole!(i8),
        FileNumberType::U16 => whole!(u16),
        FileNumberType::I16 => whole!(i16),
        FileNumberType::U32 => whole!(u32),
        FileNumberType::I32 => whole!(i32),
        FileNumberType::U64 => whole!(u64),
        FileNumberType::I64 => whole!(i64),
        FileNumberType::F16 => {
            parse_float(text).map(|value| bytes.extend(half::f16::from_f64(value).to_le_bytes()))
        }
        // Directly, not through f64: rounding twice can give another number.
        FileNumberType::F32 => text
            .parse::<f32>()
            .ok()
            .or_else(|| parse_float(text).map(|value| value as f32))
            .map(|value| bytes.extend(value.to_le_bytes())),
        FileNumberType::F64 => parse_float(text).map(|value| bytes.extend(value.to_le_bytes())),
    }
    .is_some()
}

/// Parses a number, or NaN as C libraries write it: `-nan`, `nan(ind)`, `-nan(0x7fffff)`.
fn parse_float(text: &str) -> Option<f64> {
    let is_nan = || {
        let text = text.trim_start_matches(['-', '+']);
        text.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("nan("))
            || text.eq_ignore_ascii_case("nan")
    };
    text.parse().ok().or_else(|| is_nan().then_some(f64::NAN))
}

/// Name of a number type in messages.
fn number_type_name(number: FileNumberType) -> &'static str {
    match number {
        FileNumberType::U64 => "uint64",
        FileNumberType::I64 => "int64",
        FileNumberType::F16 => "float16",
        other => other.voxel_type().name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(number: FileNumberType, text: &str, count: u64) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        // A small buffer, so that words are split between blocks.
        let reader = io::BufReader::with_capacity(3, text.as_bytes());
        TextNumbers::new(reader, number, count).read_to_end(&mut bytes).map(|_count| bytes)
    }

    #[test]
    fn numbers_of_each_type_become_bytes() {
        assert_eq!(
            bytes(FileNumberType::U8, " 1\n255 3.0 9", 3).unwrap(),
            [1, 255, 3],
            "no more than asked for"
        );
        assert_eq!(bytes(FileNumberType::I8, "-128 127", 2).unwrap(), [128, 127]);
        assert_eq!(bytes(FileNumberType::U16, "65535", 1).unwrap(), [255, 255]);
        assert_eq!(bytes(FileNumberType::I16, "-2", 1).unwrap(), (-2i16).to_le_bytes());
        assert_eq!(bytes(FileNumberType::U32, "4294967295", 1).unwrap(), [255; 4]);
        assert_eq!(bytes(FileNumberType::I32, "-7", 1).unwrap(), (-7i32).to_le_bytes());
        assert_eq!(bytes(FileNumberType::U64, "18446744073709551615", 1).unwrap(), [255; 8]);
        assert_eq!(bytes(FileNumberType::I64, "-9223372036854775808", 1).unwrap(), i64::MIN.to_le_bytes());
        assert_eq!(bytes(FileNumberType::F16, "0.5", 1).unwrap(), half::f16::from_f32(0.5).to_le_bytes());
        assert_eq!(bytes(FileNumberType::F32, "1e-3", 1).unwrap(), 1e-3f32.to_le_bytes());
        assert_eq!(bytes(FileNumberType::F64, "-0.1\r\n7", 2).unwrap()[..8], (-0.1f64).to_le_bytes());
        let nan = bytes(FileNumberType::F32, "-nan", 1).unwrap();
        assert!(f32::from_le_bytes(nan.try_into().unwrap()).is_nan());
        assert_eq!(bytes(FileNumberType::U8, "1 2", 5).unwrap(), [1, 2], "fewer than asked for");
        let mut shares = Vec::new();
        TextNumbers::new_fractions(&b"0 0.5 1 7 -1"[..], 5).read_to_end(&mut shares).unwrap();
        assert_eq!(shares, [0, 128, 255, 255, 0]);
    }

    #[test]
    fn what_is_no_number_is_named() {
        for (number, text) in [
            (FileNumberType::U8, "256"),
            (FileNumberType::U8, "-1"),
            (FileNumberType::I16, "1.5"),
            (FileNumberType::U64, "1e30"),
            (FileNumberType::F32, "eight"),
            (FileNumberType::F64, "nanometre"),
        ] {
            let error = bytes(number, text, 1).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::InvalidData);
            assert!(error.to_string().contains(text), "{error}");
        }
        assert!(bytes(FileNumberType::F64, &"1".repeat(500), 1).unwrap_err().to_string().contains("longer"));
    }
}
