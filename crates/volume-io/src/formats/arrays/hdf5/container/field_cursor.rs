//! Cursor over the bytes of a metadata block: numbers are little-endian, and offsets and lengths have the widths that
//! the superblock gives.

use std::borrow::Cow;

/// Result of parsing a part of a block, with the reason of a failure in words.
pub(crate) type ParseResult<T> = Result<T, Cow<'static, str>>;

/// Widths of addresses and lengths in a file, in bytes: 2, 4 or 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FieldWidths {
    pub(crate) address: usize,
    pub(crate) length: usize,
}

/// Position in the bytes of a block.
#[derive(Debug, Clone)]
pub(crate) struct FieldCursor<'a> {
    rest: &'a [u8],
    widths: FieldWidths,
}

impl<'a> FieldCursor<'a> {
    pub(crate) fn new(bytes: &'a [u8], widths: FieldWidths) -> Self {
        Self { rest: bytes, widths }
    }

    /// Returns the bytes that were not taken yet.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Takes the next bytes.
    pub(crate) fn take(&mut self, count: usize) -> ParseResult<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or("it ends too early")?;
        self.rest = rest;
        Ok(taken)
    }

    /// Takes the next bytes, whose number is stored in the file.
    pub(crate) fn take_stored(&mut self, count: u64) -> ParseResult<&'a [u8]> {
        self.take(usize::try_from(count).unwrap_or(usize::MAX))
    }

    /// Takes a number of at most eight bytes.
    pub(crate) fn number(&mut self, width: usize) -> ParseResult<u64> {
        Ok(self.take(width)?.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
    }

    pub(crate) fn byte(&mut self) -> ParseResult<u8> {
        Ok(self.take(1)?[0])
    }

    /// Takes a length.
    pub(crate) fn length(&mut self) -> ParseResult<u64> {
        self.number(self.widths.length)
    }

    /// Takes a length; `None` for the one that stands for no limit, in which all bits are set.
    pub(crate) fn optional_length(&mut self) -> ParseResult<Option<u64>> {
        self.optional_number(self.widths.length)
    }

    /// Takes an address; `None` for the one that stands for nothing, in which all bits are set.
    pub(crate) fn address(&mut self) -> ParseResult<Option<u64>> {
        self.optional_number(self.widths.address)
    }

    fn optional_number(&mut self, width: usize) -> ParseResult<Option<u64>> {
        let is_said = self.rest.iter().take(width).any(|&byte| byte != 0xff);
        self.number(width).map(|number| is_said.then_some(number))
    }

    /// Takes an address that must stand for something.
    pub(crate) fn present_address(&mut self) -> ParseResult<u64> {
        self.address()?.ok_or_else(|| "an address is missing".into())
    }

    /// Takes a signature of four letters.
    pub(crate) fn require_signature(&mut self, signature: [u8; 4]) -> ParseResult<()> {
        if self.take(4)? == signature {
            return Ok(());
        }
        Err(format!("the letters {} were expected at its beginning", String::from_utf8_lossy(&signature))
            .into())
    }
}

/// Text up to the first zero byte.
pub(crate) fn text_before_zero(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_addresses_are_taken_in_order() {
        let widths = FieldWidths { address: 4, length: 2 };
        let bytes = [1, 2, 0, 0xff, 0xff, 0xff, 0xff, 5, 0, 0, 0, 9];
        let mut cursor = FieldCursor::new(&bytes, widths);
        assert_eq!(cursor.byte(), Ok(1));
        assert_eq!(cursor.length(), Ok(2));
        assert_eq!(cursor.address(), Ok(None));
        assert_eq!(cursor.present_address(), Ok(5));
        assert!(cursor.number(2).is_err(), "there is one byte left");
        assert_eq!(cursor.take_stored(1), Ok(&[9][..]));
        assert!(cursor.take_stored(u64::MAX).is_err());
        assert_eq!(text_before_zero(b"ab\0c"), "ab");
    }
}
