//! Base64 decoder (RFC 4648, section 4), strict: only its alphabet, white space, and complete groups of four are
//! accepted.
//!
//! Encoded parts may follow each other: VTK encodes a header and the data separately, each with its padding.

use std::io::{self, BufRead, Cursor, Read};

use super::super::image::invalid_data;

/// Reader that decodes base64 text.
pub(super) struct Base64Reader<R> {
    reader: R,
    ready: Cursor<Vec<u8>>,
    /// Bits of the current group so far.
    bits: u32,
    /// Number of characters in the current group.
    characters: u32,
    /// Number of padding characters in the current group.
    padding: u32,
    /// Error after the bytes that are ready.
    pending_error: Option<String>,
}

impl<R: BufRead> Base64Reader<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { reader, ready: Cursor::default(), bits: 0, characters: 0, padding: 0, pending_error: None }
    }

    fn refill(&mut self) -> io::Result<()> {
        self.ready.set_position(0);
        self.ready.get_mut().clear();
        while self.ready.get_ref().is_empty() {
            if let Some(why) = self.pending_error.take() {
                return Err(invalid_data(why));
            }
            let block = self.reader.fill_buf()?.to_vec();
            if block.is_empty() {
                let is_whole = self.characters == 0;
                return if is_whole {
                    Ok(())
                } else {
                    Err(invalid_data("the base64 text ends within a group"))
                };
            }
            for &byte in &block {
                if let Err(why) = self.add(byte) {
                    // The bytes before it are valid, and may be all that is needed.
                    self.pending_error = Some(why);
                    break;
                }
            }
            self.reader.consume(block.len());
        }
        Ok(())
    }

    fn add(&mut self, byte: u8) -> Result<(), String> {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' if self.characters >= 2 => {
                self.padding += 1;
                0
            }
            byte if byte.is_ascii_whitespace() => return Ok(()),
            byte => return Err(format!("{:?} is not valid base64 here", char::from(byte))),
        };
        if self.padding > 0 && byte != b'=' {
            return Err("the padding of base64 ends too early".to_owned());
        }
        self.bits = self.bits << 6 | u32::from(value);
        self.characters += 1;
        if self.characters == 4 {
            let [_, bytes @ ..] = self.bits.to_be_bytes();
            let (bytes, rest) = bytes.split_at(3 - self.padding as usize);
            if rest.iter().any(|&byte| byte != 0) {
                return Err("the padding of base64 contains bits that are not zero".to_owned());
            }
            self.ready.get_mut().extend(bytes);
            (self.bits, self.characters, self.padding) = (0, 0, 0);
        }
        Ok(())
    }
}

impl<R: BufRead> Read for Base64Reader<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.ready.position() == self.ready.get_ref().len() as u64 {
            self.refill()?;
        }
        self.ready.read(into)
    }
}

/// Upper bound of the decoded bytes of some text.
pub(super) fn max_decoded_bytes(characters: u64) -> u64 {
    characters.div_ceil(4).saturating_mul(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(text: &str) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let reader = io::BufReader::with_capacity(3, text.as_bytes());
        Base64Reader::new(reader).read_to_end(&mut bytes).map(|_count| bytes)
    }

    #[test]
    fn the_vectors_of_the_standard_are_decoded() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9v\n YmFy\t", "foobar"),
            ("Zg==Zm8=Zm9v", "ffofoo"),
        ] {
            assert_eq!(decoded(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(decoded("+/+/").unwrap(), [0xfb, 0xff, 0xbf]);
    }

    #[test]
    fn what_is_no_base64_is_refused() {
        for text in ["Z", "Zm9", "Z===", "=", "Zg=a", "Zm9v-", "Zh==", "Zm9=", "Zm\u{e9}v"] {
            assert_eq!(decoded(text).unwrap_err().kind(), io::ErrorKind::InvalidData, "{text}");
        }
        let mut bytes = [0; 3];
        Base64Reader::new(&b"Zm9v</DataArray>"[..]).read_exact(&mut bytes).unwrap();
        assert_eq!(&bytes, b"foo", "what comes behind the wanted bytes does not matter");
    }
}
