//! Header of a FITS unit: cards of 80 letters, each with a keyword and mostly a value, up to the card `END`; 36 cards fill a
//! block.

use std::collections::BTreeMap;

use super::super::content::Content;
use super::super::samples::{Fault, fill};
use super::super::{LoadControl, LoadError};
use crate::data::attempt::{Attempt, quoted};

/// Bytes of a block; headers and data fill whole ones (section 3.1 of the standard).
pub(super) const BLOCK_BYTES: u64 = 2880;

/// Bytes of a card (section 4.1).
const CARD_BYTES: usize = 80;

/// Most blocks of a header: 72 000 cards. Mosaics that list all exposures have some thousand.
const MOST_BLOCKS: u64 = 2000;

/// Axes that a file may announce (`NAXIS`, section 4.4.1.1).
const MOST_AXES: i64 = 999;

const HELP: &str = "copy or download the file again";

/// Values of a header, by their keywords.
#[derive(Debug, Default)]
pub(super) struct Header {
    /// Text without its quotes, everything else as it is written.
    values: BTreeMap<String, String>,
    /// Keyword of the first card: it says what unit it is.
    first: String,
    /// Bytes of the header, with what fills its last block.
    pub(super) bytes: u64,
}

impl Header {
    /// Reads the header that comes next; `None` at the end of the file, and for what follows the last unit and is none.
    ///
    /// # Errors
    /// `BadInput` for a file that is broken, and for a first header without an end; `Limit` for one that is too long.
    pub(super) fn read(
        attempt: Attempt<'_>,
        content: &mut Content,
        is_first: bool,
        control: &LoadControl,
    ) -> Result<Option<Self>, LoadError> {
        let mut header = Self::default();
        let mut block = vec![0; BLOCK_BYTES as usize];
        loop {
            let got = fill(content, &mut block, control).map_err(|fault| unread(attempt, fault))?;
            let is_another = is_first || header.first.is_empty() || header.first == "XTENSION";
            if got == 0 && header.bytes == 0 || !is_another || !is_first && got < block.len() {
                return Ok(None);
            }
            if header.add_cards(&block[..got]) {
                header.bytes += BLOCK_BYTES;
                return Ok(Some(header));
            }
            header.bytes += got as u64;
            if got < block.len() {
                let why =
                    format!("the header is truncated: it ends after {} bytes without END", header.bytes);
                return Err(attempt.bad_input("header", why, HELP));
            }
            if header.bytes >= MOST_BLOCKS * BLOCK_BYTES {
                let why = format!("the header has no END within {} bytes", header.bytes);
                return Err(attempt.limit("header", why, HELP));
            }
        }
    }

    /// Takes the cards of a block; whether the last was among them.
    fn add_cards(&mut self, block: &[u8]) -> bool {
        for card in block.chunks_exact(CARD_BYTES) {
            let (keyword, rest) = card.split_at(8);
            let keyword = String::from_utf8_lossy(keyword).trim_end().to_owned();
            if self.first.is_empty() {
                self.first.clone_from(&keyword);
            }
            if keyword == "END" {
                return true;
            }
            // Cards without it are comments.
            let Some(value) = rest.strip_prefix(b"= ") else { continue };
            self.values.entry(keyword).or_insert_with(|| value_of(&String::from_utf8_lossy(value)));
        }
        false
    }

    /// Keyword of the first card.
    pub(super) fn first(&self) -> &str {
        &self.first
    }

    /// Text of a keyword; empty where it is not there.
    pub(super) fn text(&self, keyword: &str) -> &str {
        self.values.get(keyword).map_or("", |value| value.trim())
    }

    /// Whether a keyword has the value true.
    pub(super) fn is_true(&self, keyword: &str) -> bool {
        self.text(keyword) == "T"
    }

    /// A real number; `None` where it is not there, or is none. Exponents may be written with D.
    pub(super) fn float(&self, keyword: &str) -> Option<f64> {
        let text = self.values.get(keyword)?.replace(['D', 'd'], "E");
        text.trim().parse().ok().filter(|value: &f64| value.is_finite())
    }

    /// A whole number; `None` where it is not there.
    ///
    /// # Errors
    /// `BadInput` for anything else.
    pub(super) fn int(&self, attempt: Attempt<'_>, keyword: &str) -> Result<Option<i64>, LoadError> {
        let Some(text) = self.values.get(keyword) else { return Ok(None) };
        let whole = text.trim().trim_end_matches('.').parse().ok();
        whole.map(Some).ok_or_else(|| {
            let why = format!("a whole number was expected, {} was found", quoted(text));
            attempt.bad_input(keyword, why, HELP)
        })
    }

    /// A whole number that must be there.
    pub(super) fn required_int(&self, attempt: Attempt<'_>, keyword: &str) -> Result<i64, LoadError> {
        self.int(attempt, keyword)?.ok_or_else(|| {
            attempt.bad_input(keyword, "the header does not have this keyword, which every unit has", HELP)
        })
    }

    /// Lengths of all axes, the fastest first.
    pub(super) fn axes(&self, attempt: Attempt<'_>) -> Result<Vec<u64>, LoadError> {
        let count = self.required_int(attempt, "NAXIS")?;
        if !(0..=MOST_AXES).contains(&count) {
            let why = format!("{count} axes cannot be: 0 to {MOST_AXES} were expected");
            return Err(attempt.bad_input("NAXIS", why, HELP));
        }
        let length = |axis| {
            let keyword = format!("NAXIS{axis}");
            let length = self.required_int(attempt, &keyword)?;
            u64::try_from(length).map_err(|_negative| {
                attempt.bad_input(&keyword, format!("{length} cannot be the length of an axis"), HELP)
            })
        };
        (1..=count).map(length).collect()
    }
}

/// The value behind `= `: text in quotes, in which a quote is written twice, or whatever stands before a comment.
fn value_of(text: &str) -> String {
    let text = text.trim_start();
    let Some(quoted) = text.strip_prefix('\'') else {
        return text.split('/').next().unwrap_or_default().trim_end().to_owned();
    };
    let mut value = String::new();
    let mut letters = quoted.chars().peekable();
    while let Some(letter) = letters.next() {
        if letter == '\'' && letters.next_if_eq(&'\'').is_none() {
            break;
        }
        value.push(letter);
    }
    value.truncate(value.trim_end().len());
    value
}

/// The error for a header that could not be read.
pub(super) fn unread(attempt: Attempt<'_>, fault: Fault) -> LoadError {
    match fault.of_stream() {
        Fault::Corrupt(error) => {
            attempt.bad_input("header", format!("the gzip data are broken or cut off: {error}"), HELP)
        }
        Fault::Io(error) => attempt.io(error),
        Fault::Stopped(error) => error,
        _ => attempt.bad_input("header", "the file is truncated", HELP),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_told_from_comments() {
        for (card, value) in [
            ("                   16 / bits", "16"),
            ("'it''s / text'      / a comment", "it's / text"),
            ("'open", "open"),
            ("''", ""),
            ("                    T", "T"),
            ("/ nothing", ""),
            ("1.5D-3", "1.5D-3"),
        ] {
            assert_eq!(value_of(card), value, "{card}");
        }
    }
}
