//! Numbers in text as the bytes that they would have been.

use std::io::{self, BufRead, Read};

use super::super::number::Number;
use crate::data::attempt::quoted;

/// The longest number in a text file, in bytes. A full decimal f64 needs about 25.
const LONGEST_NUMBER: usize = 400;

/// Bytes that are made at a time.
const AT_ONCE: usize = 1 << 16;

/// Reads numbers with white space between them as little-endian bytes of a number type.
pub(super) struct Numbers<R> {
    source: R,
    number: Number,
    ready: Vec<u8>,
    given: usize,
}

impl<R: BufRead> Numbers<R> {
    pub(super) fn new(source: R, number: Number) -> Self {
        Self { source, number, ready: Vec::new(), given: 0 }
    }

    /// Makes the next bytes; none at the end.
    fn refill(&mut self) -> io::Result<()> {
        self.ready.clear();
        self.given = 0;
        let mut word = Vec::new();
        while self.ready.len() < AT_ONCE {
            word.clear();
            self.next_word(&mut word)?;
            if word.is_empty() {
                break;
            }
            let text = String::from_utf8_lossy(&word);
            if !add(&text, self.number, &mut self.ready) {
                let why = format!("{} is not a number of the type that ElementType says", quoted(&text));
                return Err(io::Error::new(io::ErrorKind::InvalidData, why));
            }
        }
        Ok(())
    }

    /// Reads the next word; none at the end.
    fn next_word(&mut self, word: &mut Vec<u8>) -> io::Result<()> {
        loop {
            let block = match self.source.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                block => block?,
            };
            if block.is_empty() {
                return Ok(());
            }
            let begin = if word.is_empty() {
                block.iter().position(|byte| !byte.is_ascii_whitespace())
            } else {
                Some(0)
            };
            let Some(begin) = begin else {
                let used = block.len();
                self.source.consume(used);
                continue;
            };
            let rest = &block[begin..];
            let end = rest.iter().position(u8::is_ascii_whitespace);
            // What is too long for a number is no number when cut, either.
            let length = end.unwrap_or(rest.len()).min(LONGEST_NUMBER);
            word.extend_from_slice(&rest[..length]);
            self.source.consume(begin + length);
            if end.is_some() || word.len() >= LONGEST_NUMBER {
                return Ok(());
            }
        }
    }
}

impl<R: BufRead> Read for Numbers<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.given == self.ready.len() {
            self.refill()?;
        }
        let rest = &self.ready[self.given..];
        let count = rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&rest[..count]);
        self.given += count;
        Ok(count)
    }
}

/// Adds the bytes of a number; false where the text is none of this type. Whole numbers may be written as `1.0` or `1e3`.
fn add(text: &str, number: Number, bytes: &mut Vec<u8>) -> bool {
    macro_rules! integer {
        ($type:ty) => {{
            let parsed = text.parse::<$type>().ok().or_else(|| {
                let value: f64 = text.parse().ok()?;
                let is_one =
                    value.fract() == 0.0 && (<$type>::MIN as f64..=<$type>::MAX as f64).contains(&value);
                is_one.then_some(value as $type)
            });
            parsed.map(|value| bytes.extend(value.to_le_bytes())).is_some()
        }};
    }
    match number {
        Number::U8 => integer!(u8),
        Number::I8 => integer!(i8),
        Number::U16 => integer!(u16),
        Number::I16 => integer!(i16),
        Number::U32 => integer!(u32),
        Number::I32 => integer!(i32),
        Number::U64 => integer!(u64),
        Number::I64 => integer!(i64),
        Number::F32 => text.parse::<f32>().map(|value| bytes.extend(value.to_le_bytes())).is_ok(),
        Number::F64 => text.parse::<f64>().map(|value| bytes.extend(value.to_le_bytes())).is_ok(),
        // MetaImage has no halves.
        Number::F16 => false,
    }
}
