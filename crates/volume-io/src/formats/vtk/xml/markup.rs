//! Scanner that separates the markup of a VTK XML file from the data between tags, which may be large, or raw bytes.
//!
//! Each stretch of text is replaced by two numbers: its offset and its length. With raw appended data a file is no
//! longer valid XML: the scanner stops after `<AppendedData>` and its `_`.

use std::io::{self, BufRead};

use super::super::super::{LoadControl, LoadError};
use super::super::image::content_error;
use chiaroscuro_volume::LoadContext;

/// Maximum length of the markup, in bytes: an array needs some 200.
const MAX_MARKUP_BYTES: usize = 1 << 20;

/// Maximum nesting depth of elements: arrays are at depth five.
const MAX_DEPTH: usize = 64;

/// Markup of a file, without its data.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct VtkMarkup {
    /// XML text, well-formed if the file is.
    pub(super) markup: String,
    /// Offset of the appended data, after the `_`.
    pub(super) appended: Option<u64>,
}

/// State of the scanner between two bytes.
enum MarkupState {
    /// Text, with the offset of its first byte that is not white space.
    Text(Option<u64>),
    /// Tag, with the quote that ends the current attribute value.
    Tag(Option<u8>),
    /// Comment, with its last two bytes.
    Comment([u8; 2]),
    /// White space between the tag of the appended data and their `_`.
    Appended,
}

impl VtkMarkup {
    pub(super) fn read(
        context: LoadContext<'_>,
        reader: &mut dyn BufRead,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let mut scan = MarkupScan {
            markup: Vec::new(),
            tag: Vec::new(),
            depth: 0,
            state: MarkupState::Text(None),
            appended: None,
        };
        let mut position = 0;
        while scan.appended.is_none() {
            control.check()?;
            let block = match reader.fill_buf() {
                Ok([]) => break,
                Ok(block) => block,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(content_error(context, error)),
            };
            scan.add(context, block, position)?;
            let length = block.len();
            position += length as u64;
            reader.consume(length);
        }
        if scan.appended.is_some() {
            scan.markup.extend(b"</AppendedData></VTKFile>");
        }
        let markup = String::from_utf8_lossy(&scan.markup).into_owned();
        Ok(Self { markup, appended: scan.appended })
    }
}

struct MarkupScan {
    markup: Vec<u8>,
    tag: Vec<u8>,
    depth: usize,
    state: MarkupState,
    appended: Option<u64>,
}

impl MarkupScan {
    /// Scans a block that begins at a position of the content.
    fn add(&mut self, context: LoadContext<'_>, block: &[u8], position: u64) -> Result<(), LoadError> {
        let mut at = 0;
        while let Some(&byte) = block.get(at) {
            let here = position + at as u64;
            at += 1;
            match &mut self.state {
                MarkupState::Text(start) => {
                    if byte == b'<' {
                        if let Some(start) = *start {
                            self.markup.extend(format!("{start} {}", here - start).bytes());
                        }
                        self.tag.clear();
                        self.tag.push(byte);
                        self.state = MarkupState::Tag(None);
                    } else if start.is_some() || !byte.is_ascii_whitespace() {
                        start.get_or_insert(here);
                        // Skips the rest of a long stretch at once.
                        let rest = &block[at..];
                        at += rest.iter().position(|&byte| byte == b'<').unwrap_or(rest.len());
                    }
                }
                MarkupState::Tag(quote) => {
                    self.tag.push(byte);
                    match (*quote, byte) {
                        (Some(open), byte) if open == byte => *quote = None,
                        (None, b'"' | b'\'') => *quote = Some(byte),
                        (None, b'>') => self.end_tag(context)?,
                        (None, b'-') if self.tag == b"<!--" => self.state = MarkupState::Comment([0; 2]),
                        _ => {}
                    }
                    if self.markup.len() + self.tag.len() > MAX_MARKUP_BYTES {
                        return Err(context.limit_error(
                            "markup",
                            "its markup takes more than 1 MiB",
                            "write it again with fewer arrays",
                        ));
                    }
                }
                MarkupState::Comment(last) => {
                    if *last == *b"--" && byte == b'>' {
                        self.state = MarkupState::Text(None);
                    } else {
                        *last = [last[1], byte];
                    }
                }
                MarkupState::Appended => {
                    if byte == b'_' {
                        self.appended = Some(here + 1);
                        return Ok(());
                    }
                    if !byte.is_ascii_whitespace() {
                        return Err(context.bad_input_error(
                            "AppendedData",
                            "the underscore before the appended data is missing",
                            "write the file again",
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    fn end_tag(&mut self, context: LoadContext<'_>) -> Result<(), LoadError> {
        let is_opening = !self.tag.starts_with(b"</")
            && !self.tag.starts_with(b"<?")
            && !self.tag.starts_with(b"<!")
            && !self.tag.ends_with(b"/>");
        if is_opening {
            self.depth += 1;
        } else if self.tag.starts_with(b"</") {
            self.depth = self.depth.saturating_sub(1);
        }
        if self.depth > MAX_DEPTH {
            return Err(context.bad_input_error(
                "markup",
                format!("its elements are nested more than {MAX_DEPTH} deep"),
                "check that it is a VTK file",
            ));
        }
        self.add_tag();
        let is_appended = is_opening && self.tag.starts_with(b"<AppendedData");
        self.state = if is_appended { MarkupState::Appended } else { MarkupState::Text(None) };
        Ok(())
    }

    /// Appends the tag, and escapes an `&` that begins no reference, which VTK fails to do in names.
    fn add_tag(&mut self) {
        // Longer references do not occur.
        const MAX_REFERENCE: usize = 10;
        for (at, &byte) in self.tag.iter().enumerate() {
            self.markup.push(byte);
            if byte != b'&' {
                continue;
            }
            let mut rest = self.tag[at + 1..].iter().take(MAX_REFERENCE);
            let length = rest.position(|&c| !c.is_ascii_alphanumeric() && c != b'#');
            let is_reference = length.is_some_and(|length| length > 0 && self.tag[at + 1 + length] == b';');
            if !is_reference {
                self.markup.extend(b"amp;");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn read(text: &[u8]) -> Result<VtkMarkup, LoadError> {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        // A small buffer, so that every token is split somewhere.
        let mut reader = io::BufReader::with_capacity(5, text);
        VtkMarkup::read(context, &mut reader, &LoadControl::new())
    }

    #[test]
    fn text_gives_way_to_its_place() {
        let text = br#"<?xml version="1.0"?> <a b=">" c='"<'> 1 2 3 <!-- <x> -- --> <d/></a>"#;
        let found = read(text).unwrap();
        assert_eq!(found.markup, r#"<?xml version="1.0"?><a b=">" c='"<'>39 6<d/></a>"#);
        assert_eq!((&text[39..45], found.appended), (&b"1 2 3 "[..], None));
        assert_eq!(read(b"<a b='x & y&#32;&lt; &;'/>").unwrap().markup, "<a b='x &amp; y&#32;&lt; &amp;;'/>");
    }

    #[test]
    fn nothing_behind_the_underscore_is_looked_at() {
        let text = b"<VTKFile><AppendedData encoding=\"raw\">\n  _<<\xff</VTKFile>";
        let found = read(text).unwrap();
        let markup = "<VTKFile><AppendedData encoding=\"raw\"></AppendedData></VTKFile>";
        assert_eq!(found.markup, markup);
        assert_eq!(found.appended.map(|at| &text[at as usize..][..3]), Some(&b"<<\xff"[..]));
        assert!(read(b"<AppendedData> x_").is_err());
        assert_eq!(read(b"<VTKFile><AppendedData/></VTKFile>").unwrap().appended, None);
    }

    #[test]
    fn markup_is_bounded() {
        assert!(read("<a>".repeat(100).as_bytes()).unwrap_err().to_string().contains("deep"));
        let long = format!("<a b=\"{}\"/>", "x".repeat(2 << 20));
        assert!(read(long.as_bytes()).unwrap_err().to_string().contains("1 MiB"));
    }
}
