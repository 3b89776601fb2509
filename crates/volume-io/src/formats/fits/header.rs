//! Header of a FITS unit: cards of 80 characters, each with a keyword and usually a value, up to the card `END`; a
//! block holds 36 cards.

use std::collections::BTreeMap;

use super::super::content::FileContent;
use super::super::samples::{ReadFault, read_until_full};
use super::super::{LoadControl, LoadError};
use chiaroscuro_volume::{LoadContext, quoted};

/// Size of a block in bytes; headers and data occupy whole blocks (section 3.1 of the standard).
pub(super) const BLOCK_BYTES: u64 = 2880;

/// Size of a card in bytes (section 4.1).
const CARD_BYTES: usize = 80;

/// Maximum number of blocks of a header: 72 000 cards. Mosaics that list all exposures have some thousand.
const MAX_HEADER_BLOCKS: u64 = 2000;

/// Maximum number of axes that a file may announce (`NAXIS`, section 4.4.1.1).
const MAX_AXES: i64 = 999;

const HELP: &str = "copy or download the file again";

/// Header of a FITS unit: values by keyword.
#[derive(Debug, Default)]
pub(super) struct FitsHeader {
    /// Values by keyword: strings without their quotes, everything else as written.
    values: BTreeMap<String, String>,
    /// Keyword of the first card, which tells the primary unit from extensions.
    first_keyword: String,
    /// Size of the header in bytes, including the fill of its last block.
    pub(super) bytes: u64,
}

impl FitsHeader {
    /// Reads the next header; `None` at the end of the file, and for trailing bytes that are no unit.
    ///
    /// # Errors
    /// `BadInput` for a corrupt file, and for a first header without an end; `Limit` for a header that is too long.
    pub(super) fn read(
        context: LoadContext<'_>,
        content: &mut FileContent,
        is_first: bool,
        control: &LoadControl,
    ) -> Result<Option<Self>, LoadError> {
        let mut header = Self::default();
        let mut block = vec![0; BLOCK_BYTES as usize];
        loop {
            let got = read_until_full(content, &mut block, control)
                .map_err(|fault| header_read_error(context, fault))?;
            let may_be_header =
                is_first || header.first_keyword.is_empty() || header.first_keyword == "XTENSION";
            if got == 0 && header.bytes == 0 || !may_be_header || !is_first && got < block.len() {
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
                return Err(context.bad_input_error("header", why, HELP));
            }
            if header.bytes >= MAX_HEADER_BLOCKS * BLOCK_BYTES {
                let why = format!("the header has no END within {} bytes", header.bytes);
                return Err(context.limit_error("header", why, HELP));
            }
        }
    }

    /// Adds the cards of a block; returns true if the card `END` was among them.
    fn add_cards(&mut self, block: &[u8]) -> bool {
        for card in block.chunks_exact(CARD_BYTES) {
            let (keyword, rest) = card.split_at(8);
            let keyword = String::from_utf8_lossy(keyword).trim_end().to_owned();
            if self.first_keyword.is_empty() {
                self.first_keyword.clone_from(&keyword);
            }
            if keyword == "END" {
                return true;
            }
            // Cards without the value indicator `= ` are comments.
            let Some(value) = rest.strip_prefix(b"= ") else { continue };
            self.values.entry(keyword).or_insert_with(|| parse_value(&String::from_utf8_lossy(value)));
        }
        false
    }

    /// Returns the keyword of the first card.
    pub(super) fn first_keyword(&self) -> &str {
        &self.first_keyword
    }

    /// Returns the text of a keyword, trimmed; empty if the header lacks it.
    pub(super) fn text(&self, keyword: &str) -> &str {
        self.values.get(keyword).map_or("", |value| value.trim())
    }

    /// Returns true if a keyword has the logical value `T`.
    pub(super) fn is_true(&self, keyword: &str) -> bool {
        self.text(keyword) == "T"
    }

    /// Returns a finite real number; `None` if the keyword is absent or has another value. Exponents may be written
    /// with D.
    pub(super) fn float(&self, keyword: &str) -> Option<f64> {
        let text = self.values.get(keyword)?.replace(['D', 'd'], "E");
        text.trim().parse().ok().filter(|value: &f64| value.is_finite())
    }

    /// Returns an integer; `None` if the keyword is absent.
    ///
    /// # Errors
    /// `BadInput` for a value that is no integer.
    pub(super) fn int(&self, context: LoadContext<'_>, keyword: &str) -> Result<Option<i64>, LoadError> {
        let Some(text) = self.values.get(keyword) else { return Ok(None) };
        let whole = text.trim().trim_end_matches('.').parse().ok();
        whole.map(Some).ok_or_else(|| {
            let why = format!("a whole number was expected, {} was found", quoted(text));
            context.bad_input_error(keyword, why, HELP)
        })
    }

    /// Returns an integer whose keyword is mandatory.
    pub(super) fn required_int(&self, context: LoadContext<'_>, keyword: &str) -> Result<i64, LoadError> {
        self.int(context, keyword)?
            .ok_or_else(|| context.bad_input_error(keyword, "the header lacks this mandatory keyword", HELP))
    }

    /// Returns the lengths of all axes, fastest first.
    pub(super) fn axes(&self, context: LoadContext<'_>) -> Result<Vec<u64>, LoadError> {
        let count = self.required_int(context, "NAXIS")?;
        if !(0..=MAX_AXES).contains(&count) {
            let why = format!("{count} axes are not possible: 0 to {MAX_AXES} were expected");
            return Err(context.bad_input_error("NAXIS", why, HELP));
        }
        let length = |axis| {
            let keyword = format!("NAXIS{axis}");
            let length = self.required_int(context, &keyword)?;
            u64::try_from(length).map_err(|_negative| {
                context.bad_input_error(&keyword, format!("{length} cannot be the length of an axis"), HELP)
            })
        };
        (1..=count).map(length).collect()
    }
}

/// Parses the value behind `= `: a quoted string, in which a quote is doubled, or the text before a comment.
fn parse_value(text: &str) -> String {
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

/// Makes the error for a header that could not be read.
pub(super) fn header_read_error(context: LoadContext<'_>, fault: ReadFault) -> LoadError {
    match fault.into_decoder_fault() {
        ReadFault::Corrupt(error) => {
            context.bad_input_error("header", format!("the gzip data are broken or cut off: {error}"), HELP)
        }
        ReadFault::Io(error) => context.io_error(error),
        ReadFault::Stopped(error) => error,
        _ => context.bad_input_error("header", "the file is truncated", HELP),
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
            assert_eq!(parse_value(card), value, "{card}");
        }
    }
}
