//! Reader of lines and words of a long text, block by block.

use std::io::Read;

use super::super::LoadControl;
use super::super::samples::{BLOCK_BYTES, ReadFault, read_until_full};

/// Maximum length of a header line, in bytes.
const MAX_LINE: usize = 4096;

/// Maximum length of a word, in bytes: a full decimal f64 needs about 25.
const MAX_WORD: usize = 400;

pub(super) struct CubeWordReader<'a> {
    reader: Box<dyn Read + 'a>,
    control: &'a LoadControl,
    block: Vec<u8>,
    at: usize,
}

impl<'a> CubeWordReader<'a> {
    pub(super) fn new(reader: Box<dyn Read + 'a>, control: &'a LoadControl) -> Self {
        Self { reader, control, block: Vec::new(), at: 0 }
    }

    /// Reports progress: `bytes` more bytes of voxels have been decoded.
    pub(super) fn advance(&self, bytes: u64) {
        self.control.advance(bytes);
    }

    fn byte(&mut self) -> Result<Option<u8>, ReadFault> {
        if self.at == self.block.len() {
            self.block.resize(BLOCK_BYTES, 0);
            let got = read_until_full(&mut self.reader, &mut self.block, self.control)?;
            self.block.truncate(got);
            self.at = 0;
        }
        let byte = self.block.get(self.at).copied();
        self.at += usize::from(byte.is_some());
        Ok(byte)
    }

    /// Reads the next line without its newline; `None` at the end of the text.
    pub(super) fn line(&mut self) -> Result<Option<String>, ReadFault> {
        let mut line = Vec::new();
        loop {
            match self.byte()? {
                None if line.is_empty() => return Ok(None),
                None | Some(b'\n') => break,
                Some(_) if line.len() == MAX_LINE => {
                    return Err(ReadFault::NotANumber { text: String::from_utf8_lossy(&line).into_owned() });
                }
                Some(byte) => line.push(byte),
            }
        }
        Ok(Some(String::from_utf8_lossy(&line).into_owned()))
    }

    /// Replaces `word` by the next word; returns false at the end of the text.
    pub(super) fn word(&mut self, word: &mut String) -> Result<bool, ReadFault> {
        word.clear();
        loop {
            match self.byte()? {
                Some(byte) if byte.is_ascii_whitespace() && word.is_empty() => {}
                Some(byte) if byte.is_ascii_whitespace() => return Ok(true),
                None => return Ok(!word.is_empty()),
                Some(_) if word.len() >= MAX_WORD => {
                    return Err(ReadFault::NotANumber { text: word.clone() });
                }
                Some(byte) => word.push(char::from(byte)),
            }
        }
    }
}

/// Parses a number in Fortran notation: D for E, or an exponent of three digits without the E.
pub(super) fn parse_fortran_real(word: &str) -> Option<f32> {
    word.parse().ok().or_else(|| {
        let with_e = word.replace(['D', 'd'], "E");
        with_e.parse().ok().or_else(|| {
            let sign = with_e.rfind(['+', '-']).filter(|&at| at > 0)?;
            let (digits, exponent) = with_e.split_at_checked(sign)?;
            format!("{digits}E{exponent}").parse().ok()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_fortran_are_read() {
        for (word, number) in
            [("1.5", 1.5), ("-2.5E-01", -0.25), ("1.0D+02", 100.0), ("1.25-002", 0.0125), ("0.5+001", 5.0)]
        {
            assert_eq!(parse_fortran_real(word), Some(number), "{word}");
        }
        for word in ["", "-", "x", "1.0D", "*****", "1-", "é-5"] {
            assert_eq!(parse_fortran_real(word), None, "{word}");
        }
    }

    #[test]
    fn lines_and_words_alternate_over_blocks() {
        let long = format!("a b\n{} c\nend", " ".repeat(BLOCK_BYTES));
        let control = LoadControl::new();
        let mut words = CubeWordReader::new(Box::new(long.as_bytes()), &control);
        assert_eq!(words.line().unwrap().as_deref(), Some("a b"));
        let mut word = String::new();
        assert!(words.word(&mut word).unwrap() && word == "c");
        assert_eq!(words.line().unwrap().as_deref(), Some("end"));
        assert_eq!(words.line().unwrap(), None);
        assert!(!words.word(&mut word).unwrap());
        let endless = "x".repeat(MAX_LINE + 1);
        assert!(CubeWordReader::new(Box::new(endless.as_bytes()), &control).line().is_err());
        assert!(CubeWordReader::new(Box::new(endless.as_bytes()), &control).word(&mut word).is_err());
    }
}
